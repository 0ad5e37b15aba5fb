// SPDX-License-Identifier: GPL-3.0-or-later
// What one predicate costs in each tier, on the facets of a round solid.

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "exactcsg/number/geometry.hpp"

namespace {

using namespace exactcsg;

constexpr std::uint32_t sides = 32;
constexpr std::uint32_t rings = 16;

// The quadrilaterals between neighbouring rings of a sphere; facet j * sides + i is between rings j
// and j + 1.
Geometry sphere() {
  const double pi = std::acos(-1.0);
  Geometry::Builder builder;
  std::vector<PointId> points;
  for (std::uint32_t j = 0; j < rings; ++j) {
    const Rational radius = rational_of(std::sin(pi * (j + 0.5) / rings));
    const Rational height = rational_of(std::cos(pi * (j + 0.5) / rings));
    for (std::uint32_t i = 0; i < sides; ++i) {
      points.push_back(
          builder.add_point({radius * rational_of(std::cos(2 * pi * i / sides)),
                             radius * rational_of(std::sin(2 * pi * i / sides)), height}));
    }
  }
  for (std::uint32_t j = 0; j + 1 < rings; ++j) {
    for (std::uint32_t i = 0; i < sides; ++i) {
      builder.add_plane(points[j * sides + i], points[(j + 1) * sides + i],
                        points[(j + 1) * sides + (i + 1) % sides]);
    }
  }
  return std::move(builder).build();
}

const Geometry& geometry() {
  static const Geometry instance = sphere();
  return instance;
}

PlaneRef facet(std::uint32_t j, std::uint32_t i) { return geometry().plane(j * sides + i).plane; }

void meet(benchmark::State& state) {
  const PlaneRef p = facet(5, 5);
  const PlaneRef q = facet(5, 6);
  const PlaneRef r = facet(6, 5);
  for (auto _ : state) benchmark::DoNotOptimize(geometry().meet(p, q, r));
}
BENCHMARK(meet);

void side(benchmark::State& state, const Vertex& v, PlaneRef plane) {
  TierStatistics statistics;
  for (auto _ : state) benchmark::DoNotOptimize(geometry().side(v, plane, statistics));
}

void side_symbolic(benchmark::State& state) {
  side(state, geometry().meet(facet(5, 5), facet(5, 6), facet(6, 5)), facet(5, 5));
}
BENCHMARK(side_symbolic);

void side_double(benchmark::State& state) {
  side(state, geometry().meet(facet(5, 5), facet(5, 6), facet(6, 5)), facet(9, 9));
}
BENCHMARK(side_double);

// Facets opposite one another meet on the axis: a zero that no incidence tells.
void side_fixed(benchmark::State& state) {
  side(state, geometry().meet(facet(3, 0), facet(3, 8), facet(3, 16)), facet(3, 24));
}
BENCHMARK(side_fixed);

}  // namespace

BENCHMARK_MAIN();
