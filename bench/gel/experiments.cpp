// SPDX-License-Identifier: GPL-3.0-or-later
// The experiments of the paper on the generic operators, one line of JSON for each measurement:
//   gel_experiments membership N     reading a tree of N half-planes and classifying a point
//   gel_experiments area             the area of the plate, on the fly and by a tree, to depth 13
//   gel_experiments points           a million points: by the tree, by a decomposition, by CGAL
//   gel_experiments alone TASK S     TASK (area or points) on one thread, over and over for S
//   seconds:
//                                    two such processes at once show what the machine has to give
// Every answer is checked before it is timed; bench/gel_experiments makes tables of the lines.

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bench/gel/planar_model.hpp"
#include "exactcsg/csg/traverse.hpp"
#include "exactcsg/gdt/create.hpp"
#include "exactcsg/gdt/traverse.hpp"
#include "exactcsg/skeleton/divacon.hpp"
#include "exactcsg/skeleton/simulated_executor.hpp"

namespace exactcsg::bench {
namespace {

[[noreturn]] void wrong(const std::string& what) {
  fmt::print(stderr, "wrong answer: {}\n", what);
  std::exit(1);
}

// The least of some runs, in seconds.
template <class Work>
double seconds_of(Work work, int runs = 5) {
  double best = 1e300;
  for (int i = 0; i < runs; ++i) {
    const auto start = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    best = std::min(best, elapsed.count());
  }
  return best;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct OneAndTwo {
  double one;  // the best
  double two;
  double speed_up;  // the median over the turns
};

// The same of two ways to do something, taken by turns: what else the machine does meets both. A
// clock that changes between turns spoils the ratio of the best, not that within a turn.
template <class One, class Two>
OneAndTwo seconds_by_turns(One one, Two two, int turns) {
  OneAndTwo best{1e300, 1e300, 0};
  std::vector<double> ratios;
  for (int i = 0; i < turns; ++i) {
    const double by_one = seconds_of(one, 1);
    const double by_two = seconds_of(two, 1);
    ratios.push_back(by_one / by_two);
    best.one = std::min(best.one, by_one);
    best.two = std::min(best.two, by_two);
  }
  best.speed_up = median(std::move(ratios));
  return best;
}

// The median: while another process does the same, but for the beginning and the end.
template <class Work>
void repeat(Work work, double seconds) {
  std::vector<double> runs;
  for (double all = 0; all < seconds; all += runs.back()) runs.push_back(seconds_of(work, 1));
  fmt::print("{{\"seconds\": {}}}\n", median(runs));
}

long peak_kilobytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

void membership_experiment(std::size_t count) {
  const std::string text = text_of(squares(count));
  Planar solid;
  const double input = seconds_of([&] { solid = tree_of(text); }, count > 1'000'000 ? 1 : 5);
  if (solid.primitive_count() != count) wrong("number of half-planes");
  // The squares are at multiples of 1/32 and have the side 1/64.
  if (membership(solid, {1.0 / 128, 1.0 / 128}) != PointClass::In) wrong("inside of a square");
  if (membership(solid, {3.0 / 128, 1.0 / 128}) != PointClass::Out) wrong("between squares");
  if (membership(solid, {1.0 / 64, 1.0 / 128}) != PointClass::On) wrong("side of a square");
  const double computation = seconds_of([&] {
    if (membership(solid, {3.0 / 128, 1.0 / 128}) != PointClass::Out) wrong("classification");
  });
  fmt::print(
      "{{\"half_planes\": {}, \"bytes\": {}, \"input\": {}, \"computation\": {}, "
      "\"peak_kilobytes\": {}}}\n",
      count, text.size(), input, computation, peak_kilobytes());
}

constexpr int deepest = 13;

Local whole_plate() { return {{{0, 0}, {1, 1}}, plate()}; }

template <class E>
double area_on_the_fly(const Local& root, int depth, const E& executor) {
  return skeleton::divacon(
      root, [&](const Local& local) { return local.depth == depth || is_decided(local); },
      quadrants, area_of_leaf, sum, executor);
}

// Of the tasks of a run, what p workers would make.
double simulated_speed_up(const Local& root, int depth, std::size_t workers) {
  skeleton::TaskGraph graph;
  area_on_the_fly(root, depth, skeleton::SimulatedExecutor(graph));
  return skeleton::schedule(graph, workers).speed_up();
}

void area_experiment() {
  const Local root = whole_plate();
  for (int depth = 2; depth <= deepest; ++depth) {
    const skeleton::SequentialExecutor one;
    const skeleton::ParallelExecutor<> two(2, 5);
    const double area = area_on_the_fly(root, depth, one);
    if (area_on_the_fly(root, depth, two) != area) wrong("area in parallel");
    // The circles, of length 25 (2 pi / 16 + 2 pi / 32) < 15, and the corners' sides cross fewer
    // than 64 cells a unit of length and depth step.
    if (std::abs(area - area_of_plate()) > 64 / std::exp2(depth)) wrong("area");
    using AreaTree = gdt::Tree<double>;
    std::optional<AreaTree> tree;
    const int runs = depth < 11 ? 5 : 3;
    const double creation = seconds_of(
        [&] {
          tree = gdt::create(root, is_decided, quadrants, area_of_leaf,
                             static_cast<std::size_t>(depth));
        },
        runs);
    const auto traversal = [&] {
      if (gdt::traverse(*tree, std::identity(), sum) != area) wrong("area by a tree");
    };
    const OneAndTwo times =
        seconds_by_turns([&] { area_on_the_fly(root, depth, one); },
                         [&] { area_on_the_fly(root, depth, two); }, depth == deepest ? 41 : 7);
    fmt::print(
        "{{\"depth\": {}, \"area\": {:.9f}, \"error\": {:.3e}, \"on_the_fly\": {}, "
        "\"two_threads\": {}, \"speed_up\": {}, \"simulated\": {}, \"creation\": {}, "
        "\"traversal\": {}, "
        "\"nodes\": {}}}\n",
        depth, area, std::abs(area - area_of_plate()), times.one, times.two, times.speed_up,
        simulated_speed_up(root, depth, 2), creation, seconds_of(traversal, runs),
        tree->node_count());
  }
}

// ---- a million points against 100 000 half-spaces
// ------------------------------------------------

using Vector = std::array<double, 3>;
using SpaceCell = gdt::Cell<double, 3>;

// s . p <= d for signs s: a face of an octahedron. Coordinates are multiples of 2^-20 below 64, so
// that the sums are exact.
struct OctahedronFace {
  Vector signs;
  double offset;
};
using Space = csg::Tree<OctahedronFace, csg::BooleanOperator>;

PointClass classify(const OctahedronFace& h, const Vector& p) {
  const double value = h.signs[0] * p[0] + h.signs[1] * p[1] + h.signs[2] * p[2] - h.offset;
  return value < 0 ? PointClass::In : value > 0 ? PointClass::Out : PointClass::On;
}
csg::Membership classify(const OctahedronFace& h, const SpaceCell& cell) {
  Vector nearest{}, farthest{};
  for (std::size_t i = 0; i < 3; ++i) {
    nearest[i] = h.signs[i] > 0 ? cell.lower[i] : cell.upper[i];
    farthest[i] = h.signs[i] > 0 ? cell.upper[i] : cell.lower[i];
  }
  if (classify(h, nearest) != PointClass::In) return csg::Membership::Out;
  return classify(h, farthest) == PointClass::Out ? csg::Membership::Unknown : csg::Membership::In;
}

constexpr int per_axis = 24;         // 13 824 octahedra of 8 faces: 110 592 half-spaces
constexpr double radius = 7.0 / 16;  // of octahedra whose centres are 1 apart

Space octahedra() {
  std::vector<Space> parts;
  for (int i = 0; i < per_axis * per_axis * per_axis; ++i) {
    const Vector centre{static_cast<double>(i % per_axis),
                        static_cast<double>(i / per_axis % per_axis),
                        static_cast<double>(i / per_axis / per_axis)};
    std::vector<Space> faces;
    for (unsigned pattern = 0; pattern < 8; ++pattern) {
      OctahedronFace face{{}, radius};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        face.signs[axis] = (pattern >> axis & 1U) != 0 ? 1 : -1;
        face.offset += face.signs[axis] * centre[axis];
      }
      faces.push_back(Space::primitive(face));
    }
    parts.push_back(Space::compose(csg::BooleanOperator::Intersection, std::move(faces)));
  }
  return Space::compose(csg::BooleanOperator::Union, std::move(parts));
}

PointClass membership(const Space& solid, const Vector& point) {
  return csg::traverse(
      solid, [&](const OctahedronFace& h) { return classify(h, point); },
      [](PointClass a, csg::BooleanOperator op, PointClass b) { return combine(a, op, b); },
      csg::FullEmptyResult{PointClass::In, PointClass::Out},
      [](PointClass a, csg::BooleanOperator op) {
        return a == (op == csg::BooleanOperator::Union ? PointClass::In : PointClass::Out);
      });
}

// What is known without the solid: at most one octahedron is near.
PointClass expected(const Vector& p) {
  double distance = 0;
  for (const double x : p) {
    const double nearest = std::clamp(std::round(x), 0.0, per_axis - 1.0);
    distance += std::abs(x - nearest);
  }
  return distance < radius ? PointClass::In : distance > radius ? PointClass::Out : PointClass::On;
}

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

Mesh mesh_of_octahedra() {
  Mesh mesh;
  for (int i = 0; i < per_axis * per_axis * per_axis; ++i) {
    const Kernel::Point_3 centre(i % per_axis, i / per_axis % per_axis, i / per_axis / per_axis);
    std::array<std::array<Mesh::Vertex_index, 2>, 3> tips;
    for (int axis = 0; axis < 3; ++axis) {
      for (int side = 0; side < 2; ++side) {
        const double step = side == 0 ? -radius : radius;
        tips[static_cast<std::size_t>(axis)][static_cast<std::size_t>(side)] =
            mesh.add_vertex(centre + Kernel::Vector_3(axis == 0 ? step : 0, axis == 1 ? step : 0,
                                                      axis == 2 ? step : 0));
      }
    }
    for (std::size_t x = 0; x < 2; ++x) {
      for (std::size_t y = 0; y < 2; ++y) {
        for (std::size_t z = 0; z < 2; ++z) {
          const bool positive = (x + y + z) % 2 != 0;
          mesh.add_face(tips[0][x], tips[positive ? 1 : 2][positive ? y : z],
                        tips[positive ? 2 : 1][positive ? z : y]);
        }
      }
    }
  }
  return mesh;
}

struct SpaceTask {
  SpaceCell cell;
  Space solid;
};

template <class E = skeleton::ParallelExecutor<>>
auto decomposition_of(const Space& solid, const E& executor = E(0, 3)) {
  constexpr std::uint64_t few = 8;
  const auto centre_of = [](const SpaceTask& task) {
    Vector centre{};
    for (std::size_t i = 0; i < 3; ++i) centre[i] = (task.cell.lower[i] + task.cell.upper[i]) / 2;
    return centre;
  };
  return gdt::create(
      SpaceTask{{{-1, -1, -1}, {31, 31, 31}}, solid},
      [](const SpaceTask& task) { return task.solid.primitive_count() <= few; },
      [&](const SpaceTask& task) {
        std::vector<SpaceTask> octants;
        for (std::size_t i = 0; i < 8; ++i) {
          const SpaceCell cell = gdt::Orthants()(task.cell, centre_of(task), i);
          octants.push_back({cell, csg::prune(task.solid, [&](const OctahedronFace& h) {
                               return classify(h, cell);
                             })});
        }
        return octants;
      },
      [](const SpaceTask& task) { return task.solid; }, 9, executor, centre_of);
}

std::vector<Vector> million_points() {
  std::mt19937_64 random(7);
  std::vector<Vector> points(1'000'000);
  for (Vector& p : points) {
    for (double& x : p) x = static_cast<double>(random() % (24U << 20U)) / (1U << 20U) - 1;
  }
  return points;
}

using Decomposition = decltype(decomposition_of(Space()));

std::size_t octant_of(const Vector& centre, const Vector& p) {
  return (p[0] < centre[0] ? 0U : 1U) + (p[1] < centre[1] ? 0U : 2U) + (p[2] < centre[2] ? 0U : 4U);
}

PointClass membership(const Decomposition& tree, const Vector& p) {
  return membership(gdt::descend(tree, [&](const Vector& centre) { return octant_of(centre, p); }),
                    p);
}

struct PointQuery {
  Vector point;
  std::size_t number;
};

// Groups of points that any thread may take, each in one descent that fetches every node once.
template <class E>
void classify_all(const Decomposition& tree, std::span<const Vector> points,
                  std::span<PointClass> classes, const E& executor) {
  using Group = std::pair<std::size_t, std::size_t>;
  struct Nothing {};
  constexpr std::size_t largest_group = 1U << 17U;
  skeleton::divacon(
      Group(0, points.size()), [](const Group& g) { return g.second - g.first <= largest_group; },
      [](const Group& g) {
        const std::size_t middle = g.first + (g.second - g.first) / 2;
        return std::array{Group(g.first, middle), Group(middle, g.second)};
      },
      [&](const Group& g) {
        std::vector<PointQuery> queries;
        queries.reserve(g.second - g.first);
        for (std::size_t i = g.first; i < g.second; ++i) queries.push_back({points[i], i});
        gdt::descend_batch(
            tree, std::span(queries),
            [](const Vector& centre, const PointQuery& q) { return octant_of(centre, q.point); },
            [&](const Space& solid, std::span<const PointQuery> here) {
              for (const PointQuery& q : here) classes[q.number] = membership(solid, q.point);
            });
        return Nothing();
      },
      [](std::span<Nothing>) { return Nothing(); }, executor);
}

void points_experiment() {
  const std::vector<Vector> points = million_points();
  const Space solid = octahedra();
  for (std::size_t i = 0; i < 100; ++i) {
    if (membership(solid, points[i]) != expected(points[i])) wrong("a point by the tree");
  }
  constexpr std::size_t sample = 200;
  const double by_tree = seconds_of([&] {
                           for (std::size_t i = 0; i < sample; ++i) membership(solid, points[i]);
                         }) /
                         sample;
  std::optional<Decomposition> tree;
  const double creation = seconds_of([&] { tree = decomposition_of(solid); }, 1);
  std::vector<PointClass> classes(points.size());
  const skeleton::SequentialExecutor one;
  const skeleton::ParallelExecutor<> two(2);
  classify_all(*tree, points, classes, one);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (classes[i] != expected(points[i])) wrong("a point by the decomposition");
    if (membership(*tree, points[i]) != classes[i]) wrong("a point by itself");
  }
  const double each = seconds_of([&] {
    for (std::size_t i = 0; i < points.size(); ++i) classes[i] = membership(*tree, points[i]);
  });
  std::vector<PointClass> in_parallel(points.size());
  classify_all(*tree, points, in_parallel, two);
  if (in_parallel != classes) wrong("points in parallel");
  const OneAndTwo times = seconds_by_turns([&] { classify_all(*tree, points, classes, one); },
                                           [&] { classify_all(*tree, points, classes, two); }, 31);
  const Mesh mesh = mesh_of_octahedra();
  const CGAL::Side_of_triangle_mesh<Mesh, Kernel> side(mesh);
  const auto by_mesh = [&](const Vector& p) {
    switch (side(Kernel::Point_3(p[0], p[1], p[2]))) {
      case CGAL::ON_BOUNDED_SIDE:
        return PointClass::In;
      case CGAL::ON_BOUNDARY:
        return PointClass::On;
      default:
        return PointClass::Out;
    }
  };
  for (std::size_t i = 0; i < 100'000; ++i) {
    if (by_mesh(points[i]) != expected(points[i])) wrong("a point by CGAL");
  }
  constexpr std::size_t mesh_sample = 100'000;
  const double by_cgal = seconds_of([&] {
                           for (std::size_t i = 0; i < mesh_sample; ++i) by_mesh(points[i]);
                         }) /
                         mesh_sample;
  const auto count = static_cast<double>(points.size());
  fmt::print(
      "{{\"half_spaces\": {}, \"nodes\": {}, \"creation\": {}, \"tree\": {}, "
      "\"each\": {}, \"decomposition\": {}, \"two_threads\": {}, \"speed_up\": {}, \"cgal\": "
      "{}}}\n",
      solid.primitive_count(), tree->node_count(), creation, by_tree, each / count,
      times.one / count, times.two / count, times.speed_up, by_cgal);
}

void alone(const std::string& task, double seconds) {
  const skeleton::SequentialExecutor one;
  if (task == "area") {
    const Local root = whole_plate();
    return repeat([&] { area_on_the_fly(root, deepest, one); }, seconds);
  }
  const std::vector<Vector> points = million_points();
  const Decomposition tree = decomposition_of(octahedra(), one);
  std::vector<PointClass> classes(points.size());
  repeat([&] { classify_all(tree, points, classes, one); }, seconds);
}

}  // namespace
}  // namespace exactcsg::bench

int main(int argc, char** argv) {
  using namespace exactcsg::bench;
  const std::string task = argc > 1 ? argv[1] : "";
  if (task == "membership" && argc > 2) {
    membership_experiment(std::stoul(argv[2]));
  } else if (task == "area") {
    area_experiment();
  } else if (task == "points") {
    points_experiment();
  } else if (task == "alone" && argc > 3) {
    alone(argv[2], std::stod(argv[3]));
  } else {
    fmt::print(stderr,
               "gel_experiments membership N | area | points | alone area|points SECONDS\n");
    return 2;
  }
}
