// SPDX-License-Identifier: GPL-3.0-or-later
// How fast trees are built from text and written. Each benchmark first checks that what it read is
// what was written.
#include <benchmark/benchmark.h>

#include <array>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include "exactcsg/csg/text.hpp"
#include "exactcsg/csg/tree.hpp"
#include "exactcsg/gdt/text.hpp"
#include "exactcsg/gdt/tree.hpp"

namespace exactcsg {
namespace {

// ax + by + cz <= d with small integer coefficients, as in the files of models with rational
// planes.
using HalfSpace = std::array<int, 4>;
using Solid = csg::BooleanTree<HalfSpace>;

const auto put_half_space = [](TextWriter& out, const HalfSpace& h) {
  for (const int coefficient : h) {
    out.separate();
    out.write(coefficient);
  }
};
const auto get_half_space = [](TextReader& in) {
  HalfSpace h;
  for (int& coefficient : h) coefficient = in.number<int>("a coefficient");
  return h;
};

Solid balanced(std::size_t primitives, std::mt19937& random) {
  if (primitives == 1) {
    const auto coefficient = [&] { return static_cast<int>(random() % 20'001) - 10'000; };
    return Solid::primitive({coefficient(), coefficient(), coefficient(), coefficient()});
  }
  Solid left = balanced(primitives / 2, random);
  return Solid::compose(static_cast<csg::BooleanOperator>(random() % 4),
                        {std::move(left), balanced(primitives - primitives / 2, random)});
}

gdt::Tree<int> octree(int depth) {
  if (depth == 0) return gdt::Tree<int>::terminal(7);
  return gdt::Tree<int>::interior(std::vector<gdt::Tree<int>>(8, octree(depth - 1)));
}

void set_bytes(benchmark::State& state, const std::string& text) {
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations()) *
                          static_cast<std::int64_t>(text.size()));
}

void read_csg(benchmark::State& state) {
  std::mt19937 random(1);
  const Solid solid = balanced(static_cast<std::size_t>(state.range(0)), random);
  const std::string text = csg::to_text(solid, put_half_space);
  if (!(csg::from_text(text, get_half_space) == solid)) state.SkipWithError("not what was written");
  for (auto unused : state) benchmark::DoNotOptimize(csg::from_text(text, get_half_space));
  set_bytes(state, text);
}
BENCHMARK(read_csg)->RangeMultiplier(10)->Range(10'000, 1'000'000)->Unit(benchmark::kMillisecond);

void write_csg(benchmark::State& state) {
  std::mt19937 random(1);
  const Solid solid = balanced(static_cast<std::size_t>(state.range(0)), random);
  std::string text;
  for (auto unused : state) text = csg::to_text(solid, put_half_space);
  if (!(csg::from_text(text, get_half_space) == solid)) state.SkipWithError("not what was written");
  set_bytes(state, text);
}
BENCHMARK(write_csg)->Arg(100'000)->Unit(benchmark::kMillisecond);

// One digit at a terminal: what is left is the reader itself.
void read_octree(benchmark::State& state) {
  const auto tree = octree(static_cast<int>(state.range(0)));
  const std::string text = gdt::to_text(tree, [](TextWriter& out, int value) { out.write(value); });
  const auto get = [](TextReader& in) { return in.number<int>(); };
  if (!(gdt::from_text(text, get) == tree)) state.SkipWithError("not what was written");
  for (auto unused : state) benchmark::DoNotOptimize(gdt::from_text(text, get));
  set_bytes(state, text);
}
BENCHMARK(read_octree)->DenseRange(5, 7)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace exactcsg

BENCHMARK_MAIN();
