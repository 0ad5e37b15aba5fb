// SPDX-License-Identifier: GPL-3.0-or-later
// Points a second that io::openmc::PointLocator locates (items_per_second): random points of a grid
// of 22^3 balls with their background, and of models of data/openmc. One thread.

#include <benchmark/benchmark.h>

#include <random>
#include <string>
#include <vector>

#include "exactcsg/io/openmc/point_location.hpp"
#include "exactcsg/io/openmc/region_bounds.hpp"

namespace {

using namespace exactcsg;
using namespace exactcsg::io::openmc;

Model grid_of_balls(int n) {
  std::string body = "<geometry>";
  std::string outside;
  int count = 0;
  for (int x = 0; x < n; ++x) {
    for (int y = 0; y < n; ++y) {
      for (int z = 0; z < n; ++z) {
        const std::string id = std::to_string(++count);
        body += "<surface id='" + id + "' type='sphere' coeffs='" + std::to_string(x) + " " +
                std::to_string(y) + " " + std::to_string(z) + " 0.4'/><cell id='" + id +
                "' material='1' region='-" + id + "'/>";
        outside += " " + id;
      }
    }
  }
  const std::string id = std::to_string(count + 1);
  body += "<surface id='" + id + "' type='sphere' boundary='vacuum' coeffs='0 0 0 " +
          std::to_string(2 * n) + "'/><cell id='" + id + "' material='2' region='-" + id + outside +
          "'/></geometry>";
  return read_geometry(body, "balls");
}

std::vector<Point> random_points(const domain::Box<3>& box) {
  constexpr std::size_t count = 100'000;
  std::mt19937_64 random(1);
  std::uniform_int_distribution<long> part(1, 999'999);
  std::vector<Point> points;
  for (std::size_t k = 0; k < count; ++k) {
    domain::Coordinates<3> x;
    for (std::size_t i = 0; i < 3; ++i) {
      const Rational length = box.upper()[i] - box.lower()[i];
      x[i] = box.lower()[i] + length * Rational(part(random), 1'000'000);
    }
    points.emplace_back(x);
  }
  return points;
}

void locate_points(benchmark::State& state, const Model& model, const domain::Box<3>& box) {
  const PointLocator locate_point(model);
  const std::vector<Point> points = random_points(box);
  std::size_t next = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(locate_point(points[next]));
    next = next + 1 == points.size() ? 0 : next + 1;
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()));
}

void balls(benchmark::State& state) {
  constexpr int n = 22;
  locate_points(state, grid_of_balls(n), {Point(-1, -1, -1), Point(n, n, n)});
}
BENCHMARK(balls);

void model(benchmark::State& state, const char* name) {
  const Model model =
      read_geometry_file(std::string(EXACTCSG_SOURCE_DIR) + "/data/openmc/" + name + ".xml");
  locate_points(state, model, box_of_root(model));
}
BENCHMARK_CAPTURE(model, assembly_17x17, "assembly_17x17");
BENCHMARK_CAPTURE(model, assembly_17x17_flat, "assembly_17x17_flat");
BENCHMARK_CAPTURE(model, hexagonal_core, "hexagonal_core");
BENCHMARK_CAPTURE(model, turned_units, "turned_units");

}  // namespace

BENCHMARK_MAIN();
