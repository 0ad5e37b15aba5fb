// SPDX-License-Identifier: GPL-3.0-or-later
// The same workloads by CGAL, from the same exact primitives, one line of JSON:
//   boundary_cgal nef|corefinement NAME SIZE
// nef: Nef_polyhedron_3, planar facets as they are. corefinement: Polygon_mesh_processing on
// triangle meshes with exact coordinates. Operators of many operands are balanced trees of two. The
// clock runs from the primitives in CGAL's form to the result; making them is "load".

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Nef_polyhedron_3.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Surface_mesh.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bench/boundary/process_figures.hpp"
#include "bench/boundary/workloads.hpp"

namespace exactcsg::bench {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Nef = CGAL::Nef_polyhedron_3<Kernel>;
using Vector = std::array<double, 3>;
using Json = nlohmann::ordered_json;

// What the peer itself says it cannot do.
class Declined : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

Kernel::FT number(const Rational& value) {
  return Kernel::FT(Kernel::Exact_kernel::FT(value.get_mpq_t()));
}

Mesh mesh_of(const Polyhedron& polyhedron, bool triangles) {
  Mesh mesh;
  std::vector<Mesh::Vertex_index> vertices;
  for (const Point3& p : polyhedron.vertices) {
    vertices.push_back(mesh.add_vertex({number(p.x), number(p.y), number(p.z)}));
  }
  for (const Facet& facet : polyhedron.facets) {
    std::vector<Mesh::Vertex_index> corners;
    for (const std::uint32_t v : facet) corners.push_back(vertices[v]);
    if (!triangles) {
      mesh.add_face(corners);
      continue;
    }
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
      mesh.add_face(corners[0], corners[i], corners[i + 1]);
    }
  }
  return mesh;
}

// Volume and area of a closed surface, summed up in doubles: each cycle of a facet is a fan from
// its own first point, and the signs make holes holes.
class Figures {
 public:
  void add_cycle(const std::vector<Vector>& points, Vector& facet_normal) {
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
      const Vector normal = cross(minus(points[i], points[0]), minus(points[i + 1], points[0]));
      for (std::size_t k = 0; k < 3; ++k) facet_normal[k] += normal[k];
      six_volume_ += dot(points[0], normal);
    }
  }
  void add_facet(const Vector& normal) { area_ += std::sqrt(dot(normal, normal)) / 2; }

  void write(Json& result) const {
    result["volume"] = six_volume_ / 6;
    result["area"] = area_;
  }
  double volume() const { return six_volume_ / 6; }
  double area() const { return area_; }

 private:
  static Vector minus(const Vector& a, const Vector& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  }
  static Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  }
  static double dot(const Vector& a, const Vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }
  double six_volume_ = 0;
  double area_ = 0;
};

Vector nearest(const Kernel::Point_3& p) {
  return {CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z())};
}

struct NefPeer {
  using Value = Nef;
  static Nef make(const Polyhedron& polyhedron) { return Nef(mesh_of(polyhedron, false)); }
  static Nef empty() { return Nef(Nef::EMPTY); }
  static Nef unite(Nef& a, Nef& b) { return a + b; }
  static Nef subtract(Nef& a, Nef& b) { return (a - b).regularization(); }

  static Figures figures(const Nef& nef) {
    Figures figures;
    for (auto f = nef.halffacets_begin(); f != nef.halffacets_end(); ++f) {
      if (f->incident_volume()->mark() || !f->twin()->incident_volume()->mark()) continue;
      Vector normal{};
      for (auto c = f->facet_cycles_begin(); c != f->facet_cycles_end(); ++c) {
        if (!c.is_shalfedge()) continue;
        std::vector<Vector> points;
        Nef::SHalfedge_around_facet_const_circulator edge{Nef::SHalfedge_const_handle(c)};
        const auto end = edge;
        do points.push_back(nearest(edge->source()->center_vertex()->point()));
        while (++edge != end);
        figures.add_cycle(points, normal);
      }
      figures.add_facet(normal);
    }
    return figures;
  }
};

struct CorefinementPeer {
  using Value = Mesh;
  static Mesh make(const Polyhedron& polyhedron) { return mesh_of(polyhedron, true); }
  static Mesh empty() { return {}; }
  static Mesh unite(Mesh& a, Mesh& b) {
    Mesh result;
    if (!CGAL::Polygon_mesh_processing::corefine_and_compute_union(a, b, result)) {
      throw Declined("a union that is no manifold");
    }
    return result;
  }
  static Mesh subtract(Mesh& a, Mesh& b) {
    Mesh result;
    if (!CGAL::Polygon_mesh_processing::corefine_and_compute_difference(a, b, result)) {
      throw Declined("a difference that is no manifold");
    }
    return result;
  }

  static Figures figures(const Mesh& mesh) {
    Figures figures;
    for (const auto face : mesh.faces()) {
      std::vector<Vector> points;
      for (const auto v : mesh.vertices_around_face(mesh.halfedge(face))) {
        points.push_back(nearest(mesh.point(v)));
      }
      Vector normal{};
      figures.add_cycle(points, normal);
      figures.add_facet(normal);
    }
    return figures;
  }
};

template <class Peer>
typename Peer::Value united(std::vector<typename Peer::Value> operands) {
  if (operands.empty()) return Peer::empty();
  while (operands.size() > 1) {
    std::vector<typename Peer::Value> pairs;
    for (std::size_t i = 0; i + 1 < operands.size(); i += 2) {
      pairs.push_back(Peer::unite(operands[i], operands[i + 1]));
    }
    if (operands.size() % 2 != 0) pairs.push_back(std::move(operands.back()));
    operands = std::move(pairs);
  }
  return std::move(operands.front());
}

template <class Peer>
std::vector<typename Peer::Value> leaves_of(const Solid& solid) {
  std::vector<typename Peer::Value> leaves;
  csg::for_each_primitive(solid, [&](const Primitive& primitive) {
    leaves.push_back(Peer::make(to_polyhedron(*polyhedron_of(primitive))));
  });
  return leaves;
}

template <class Peer>
typename Peer::Value solve(const Solid& solid, std::vector<typename Peer::Value> leaves) {
  using Cursor = Solid::Cursor;
  using Value = typename Peer::Value;
  std::vector<Value> values;
  std::size_t next = 0;
  csg::walk(
      solid.root(), [](Cursor) { return true; },
      [&](Cursor) { values.push_back(std::move(leaves[next++])); },
      [&](Cursor node) {
        const auto count = static_cast<std::ptrdiff_t>(node.tree().children().size());
        std::vector<Value> operands(std::make_move_iterator(values.end() - count),
                                    std::make_move_iterator(values.end()));
        values.erase(values.end() - count, values.end());
        if (node.operation() == csg::BooleanOperator::Union) {
          values.push_back(united<Peer>(std::move(operands)));
          return;
        }
        Value body = std::move(operands.front());
        operands.erase(operands.begin());
        Value tool = united<Peer>(std::move(operands));
        values.push_back(Peer::subtract(body, tool));
      });
  return std::move(values.back());
}

template <class Peer>
void solve_tree(const std::string& name, std::size_t size, Json& result) {
  const Solid solid = solid_of(make_workload(name, size).model);
  const Stopwatch loading;
  const auto leaves = leaves_of<Peer>(solid);
  result["load"] = loading.seconds();
  typename Peer::Value value;
  // Corefinement changes its operands.
  double seconds = 0;
  for (int run = 0; run == 0 || run < runs_if_one_takes(seconds); ++run) {
    auto operands = leaves;
    const Stopwatch clock;
    value = solve<Peer>(solid, std::move(operands));
    const double taken = clock.seconds();
    seconds = run == 0 ? taken : std::min(seconds, taken);
    if (run == 0) result["peak_kilobytes"] = peak_kilobytes();
  }
  result["seconds"] = seconds;
  Peer::figures(value).write(result);
}

// Every intermediate result is measured, as ours are.
template <class Peer>
void solve_sequence(const std::string& name, std::size_t side, Json& result) {
  const CubeSequence sequence = cube_sequence(name, side);
  const std::vector<GridFigures> expected = expected_figures(sequence, side);
  PrimitiveMaker primitive_of;
  const Stopwatch clock;
  auto value = Peer::empty();
  double error = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const bool unites = i < sequence.united.size();
    const auto& place =
        unites ? sequence.united[i] : sequence.subtracted[i - sequence.united.size()];
    auto cube = Peer::make(to_polyhedron(*polyhedron_of(primitive_of(cube_at(place).primitive()))));
    try {
      value = i == 0   ? std::move(cube)
              : unites ? Peer::unite(value, cube)
                       : Peer::subtract(value, cube);
    } catch (const Declined& declined) {
      throw Declined(fmt::format("{} at operation {}", declined.what(), i));
    }
    const Figures figures = Peer::figures(value);
    const auto volume = static_cast<double>(expected[i].volume);
    const auto area = static_cast<double>(expected[i].area);
    error = std::max({error, std::abs(figures.volume() - volume) / std::max(1.0, volume),
                      std::abs(figures.area() - area) / std::max(1.0, area)});
    if (error > 1e-3) throw std::runtime_error(fmt::format("wrong after operation {}", i));
  }
  result["load"] = 0;
  result["seconds"] = clock.seconds();
  result["peak_kilobytes"] = peak_kilobytes();
  result["error"] = error;
}

template <class Peer>
Json run(const std::string& name, std::size_t size) {
  Json result;
  try {
    if (is_cube_sequence(name)) {
      solve_sequence<Peer>(name, size, result);
    } else {
      solve_tree<Peer>(name, size, result);
    }
  } catch (const Declined& declined) {
    result["declined"] = declined.what();
  } catch (const std::exception& error) {
    result["failed"] = error.what();
  }
  return result;
}

}  // namespace
}  // namespace exactcsg::bench

int main(int count, char** values) {
  const std::vector<std::string> arguments(values + 1, values + count);
  if (arguments.size() != 3 || (arguments[0] != "nef" && arguments[0] != "corefinement")) {
    fmt::print(stderr, "boundary_cgal nef|corefinement NAME SIZE\n");
    return 2;
  }
  using namespace exactcsg::bench;
  const std::size_t size = std::stoul(arguments[2]);
  const Json result = arguments[0] == "nef" ? run<NefPeer>(arguments[1], size)
                                            : run<CorefinementPeer>(arguments[1], size);
  std::cout << result.dump() << std::endl;
}
