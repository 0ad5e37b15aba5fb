// SPDX-License-Identifier: GPL-3.0-or-later
// The planar evaluator beside one CGAL arrangement of all edges, on the same trees. Before anything
// is timed, the outlines are compared; a program whose engines differ fails.

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

#include "planar/arrangement_outline.hpp"
#include "planar/normal_outline.hpp"

namespace {

using namespace exactcsg;
using csg::BooleanOperator;
using io::test::circle;
using io::test::figure;
using test::arrangement_outline;

// Of 1000 convex polygons of 3 to 32 corners in a square ten to thirty times as wide.
PlanarTree union_of_polygons() {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(0, 1000);
  std::uniform_real_distribution<double> radius(15, 50);
  std::uniform_int_distribution<int> corners(3, 32);
  std::vector<PlanarTree> members;
  for (int i = 0; i < 1000; ++i) {
    const double x = place(random);
    const double y = place(random);
    const double r = radius(random);
    members.push_back(
        figure({circle(rational_of(x), rational_of(y), rational_of(r), corners(random))}));
  }
  return PlanarTree::compose(BooleanOperator::Union, std::move(members));
}

PlanarTree block_less_grid() {
  std::vector<PlanarTree> members{io::test::box(-2, -2, 89, 89)};
  for (int i = 0; i < 30; ++i) {
    for (int j = 0; j < 30; ++j) members.push_back(figure({circle(3 * i, 3 * j, 1, 32)}));
  }
  return PlanarTree::compose(BooleanOperator::Difference, std::move(members));
}

// What an offset unites: the outline, a rectangle along every edge, a disc at every corner. The
// outline is a row of round letters with holes.
PlanarTree offset_of_letters() {
  const Rational distance(3, 10);
  std::vector<PlanarTree> members;
  for (int letter = 0; letter < 40; ++letter) {
    const Rational x = Rational(6 * (letter % 10));
    const Rational y = Rational(8 * (letter / 10));
    std::vector<io::test::Path> paths{circle(x, y, 2, 24 + letter), circle(x, y, 1, 16 + letter)};
    for (const auto& path : paths) {
      for (std::size_t i = 0; i < path.size(); ++i) {
        const Point2& a = path[i];
        const Point2& b = path[(i + 1) % path.size()];
        const double dx = Rational(b.x - a.x).get_d();
        const double dy = Rational(b.y - a.y).get_d();
        const double length = std::hypot(dx, dy);
        const Rational nx = distance * rational_of(dy / length);
        const Rational ny = distance * rational_of(-dx / length);
        for (const int side : {1, -1}) {
          members.push_back(figure(
              {{a, b, {b.x + side * nx, b.y + side * ny}, {a.x + side * nx, a.y + side * ny}}}));
        }
        members.push_back(figure({circle(a.x, a.y, distance, 24)}));
      }
    }
    members.push_back(figure(std::move(paths)));
  }
  return PlanarTree::compose(BooleanOperator::Union, std::move(members));
}

using MakeTree = PlanarTree (*)();

void require_equal(const PlanarTree& tree) {
  if (test::normal(outline_of(tree)) == test::normal(arrangement_outline(tree))) return;
  std::fputs("the engines differ\n", stderr);
  std::exit(1);
}

void cells(benchmark::State& state, MakeTree make) {
  const PlanarTree tree = make();
  require_equal(tree);
  for (auto _ : state) benchmark::DoNotOptimize(outline_of(tree));
}
void arrangement(benchmark::State& state, MakeTree make) {
  const PlanarTree tree = make();
  for (auto _ : state) benchmark::DoNotOptimize(arrangement_outline(tree));
}
BENCHMARK_CAPTURE(cells, union_of_1000_polygons, union_of_polygons)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(arrangement, union_of_1000_polygons, union_of_polygons)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(cells, block_less_900_polygons, block_less_grid)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(arrangement, block_less_900_polygons, block_less_grid)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(cells, offset_of_letters, offset_of_letters)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(arrangement, offset_of_letters, offset_of_letters)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
