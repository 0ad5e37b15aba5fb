// SPDX-License-Identifier: GPL-3.0-or-later
// Divide and conquer without geometry: merge sort, on one thread and on all of them.

#include <algorithm>
#include <array>
#include <cstdint>
#include <iostream>
#include <random>
#include <span>
#include <vector>

#include "exactcsg/skeleton/divacon.hpp"

namespace {

using Numbers = std::vector<std::uint64_t>;

template <class Executor>
Numbers merge_sorted(Numbers numbers, const Executor& executor) {
  return exactcsg::skeleton::divacon(
      std::move(numbers), [](const Numbers& n) { return n.size() <= 1; },
      [](const Numbers& n) {
        const auto middle = n.begin() + static_cast<std::ptrdiff_t>(n.size() / 2);
        return std::array{Numbers(n.begin(), middle), Numbers(middle, n.end())};
      },
      [](Numbers&& n) { return std::move(n); },
      [](std::span<Numbers> halves) {
        Numbers all(halves[0].size() + halves[1].size());
        std::ranges::merge(halves[0], halves[1], all.begin());
        return all;
      },
      executor);
}

}  // namespace

int main() {
  std::mt19937_64 random(1);
  Numbers numbers(100'000);
  std::ranges::generate(numbers, random);
  const Numbers sorted = merge_sorted(numbers, exactcsg::skeleton::SequentialExecutor());
  const Numbers in_parallel = merge_sorted(numbers, exactcsg::skeleton::ParallelExecutor<>());
  std::ranges::sort(numbers);
  std::cout << (sorted == numbers ? "sorted" : "not sorted") << '\n'
            << (sorted == in_parallel ? "the same in parallel" : "differs in parallel") << '\n';
}
