// SPDX-License-Identifier: GPL-3.0-or-later
// Expected: the smallest number of each component, found by walking the graph from every number in
// ascending order.
#include "exactcsg/solid/disjoint_sets.hpp"

#include <gtest/gtest.h>

#include <random>

#include "exactcsg/support/in_parallel.hpp"

namespace exactcsg {
namespace {

using Pairs = std::vector<std::array<std::uint32_t, 2>>;

std::vector<std::uint32_t> smallest_reached(std::size_t count, const Pairs& pairs) {
  std::vector<std::vector<std::uint32_t>> neighbours(count);
  for (const auto& [a, b] : pairs) {
    neighbours[a].push_back(b);
    neighbours[b].push_back(a);
  }
  std::vector<std::uint32_t> result(count, static_cast<std::uint32_t>(count));
  for (std::uint32_t start = 0; start < count; ++start) {
    std::vector<std::uint32_t> waiting{start};
    while (!waiting.empty()) {
      const std::uint32_t item = waiting.back();
      waiting.pop_back();
      if (result[item] != count) continue;
      result[item] = start;
      waiting.insert(waiting.end(), neighbours[item].begin(), neighbours[item].end());
    }
  }
  return result;
}

// LAW disjoint_sets.1
TEST(DisjointSets, FindTheSmallestNumberWhateverTheThreads) {
  std::mt19937 random(11);
  constexpr std::uint32_t count = 20000;
  for (const std::size_t size : {0U, 1000U, 9000U, 11000U, 40000U}) {
    Pairs pairs;
    for (std::size_t i = 0; i < size; ++i) {
      pairs.push_back({static_cast<std::uint32_t>(random() % count),
                       static_cast<std::uint32_t>(random() % count)});
    }
    // A long chain, united from its end.
    for (std::uint32_t i = 3000; i > 0; --i) pairs.push_back({i, i - 1});
    const std::vector<std::uint32_t> expected = smallest_reached(count, pairs);
    for (const unsigned threads : {1U, 2U, 0U}) {
      DisjointSets sets(count);
      in_parallel(threads, pairs.size(),
                  [&](std::size_t i) { sets.unite(pairs[i][0], pairs[i][1]); });
      std::vector<std::uint32_t> found(count);
      in_parallel(threads, count,
                  [&](std::size_t i) { found[i] = sets.find(static_cast<std::uint32_t>(i)); });
      EXPECT_EQ(found, expected) << size << ' ' << threads;
    }
  }
}

}  // namespace
}  // namespace exactcsg
