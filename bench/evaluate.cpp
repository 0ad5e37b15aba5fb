// SPDX-License-Identifier: GPL-3.0-or-later
// How long the stages of an evaluation take, inside the process. Each benchmark first holds its
// answer against a closed form and refuses to time a wrong one.

#include <benchmark/benchmark.h>

#include <string>

#include "exactcsg/io/model.hpp"
#include "exactcsg/solid/classify.hpp"
#include "exactcsg/solid/evaluate.hpp"
#include "exactcsg/solid/measures.hpp"

namespace {

using namespace exactcsg;

io::Model model(const std::string& name) {
  return io::read_model(std::string(EXACTCSG_SOURCE_DIR "/data/openscad/") + name + ".csg");
}

// Menger sponge of level n with side 3^n: 20^n unit cubes.
void evaluate_menger_sponge(benchmark::State& state) {
  const io::Model sponge = model("menger_" + std::to_string(state.range(0)));
  Rational expected = 1;
  for (int i = 0; i < state.range(0); ++i) expected *= 20;
  if (exact_volume(evaluate(sponge.solid)) != expected) {
    state.SkipWithError("wrong volume");
    return;
  }
  for (auto _ : state) benchmark::DoNotOptimize(evaluate(sponge.solid));
  state.counters["primitives"] = static_cast<double>(sponge.primitives);
}
BENCHMARK(evaluate_menger_sponge)->DenseRange(1, 3)->Unit(benchmark::kMillisecond);

// LAW boundary.1 stands in for a closed form: the union of spheres from half of the threads.
void evaluate_spheres(benchmark::State& state) {
  const io::Model spheres = model("spheres_" + std::to_string(state.range(0)));
  EvaluateOptions parallel;
  parallel.threads = 2;
  if (digest(evaluate(spheres.solid)) != digest(evaluate(spheres.solid, parallel))) {
    state.SkipWithError("the answer depends on the threads");
    return;
  }
  for (auto _ : state) benchmark::DoNotOptimize(evaluate(spheres.solid));
}
BENCHMARK(evaluate_spheres)->Arg(100)->Unit(benchmark::kMillisecond);

// The retained decomposition against the plain traversal of the tree, which it must equal.
void classify_points(benchmark::State& state) {
  const io::Model sponge = model("menger_3");
  const PointClassifier classifier(sponge.solid);
  std::vector<Point3> points;
  for (int i = 0; i < 64; ++i) {
    points.push_back({Rational(27 * i, 64), Rational(27 * (i * 7 % 64), 64), Rational(i * 5 % 27)});
  }
  for (const Point3& point : points) {
    if (classifier(point) != classify(sponge.solid, point)) {
      state.SkipWithError("the classifier and the tree disagree");
      return;
    }
  }
  for (auto _ : state) {
    for (const Point3& point : points) benchmark::DoNotOptimize(classifier(point));
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(points.size()));
}
BENCHMARK(classify_points);

}  // namespace

BENCHMARK_MAIN();
