// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/skeleton/divacon.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <numeric>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace exactcsg::skeleton {
namespace {

// More threads than a small machine has, so that tasks do run at the same time.
const tbb::global_control more_threads(tbb::global_control::max_allowed_parallelism, 8);

struct Range {
  int first;
  int last;
  int size() const { return last - first; }
};

bool single(const Range& range) { return range.size() <= 1; }
std::array<Range, 2> halves(const Range& range) {
  const int middle = range.first + range.size() / 2;
  return {Range{range.first, middle}, Range{middle, range.last}};
}

std::vector<int> mergesort(std::vector<int> numbers, const auto& executor) {
  using Numbers = std::vector<int>;
  return divacon(
      std::move(numbers), [](const Numbers& n) { return n.size() <= 1; },
      [](Numbers&& n) {
        const auto middle = n.begin() + static_cast<std::ptrdiff_t>(n.size() / 2);
        return std::array{Numbers(n.begin(), middle), Numbers(middle, n.end())};
      },
      [](Numbers&& n) { return std::move(n); },
      [](std::span<Numbers> sorted) {
        Numbers merged(sorted[0].size() + sorted[1].size());
        std::ranges::merge(sorted[0], sorted[1], merged.begin());
        return merged;
      },
      executor);
}

// LAW divacon.1, LAW executor.1: the source's own example, against std::sort.
TEST(Divacon, MergesortSortsOnEveryExecutor) {
  std::mt19937 random(7);
  for (const std::size_t size : {0U, 1U, 2U, 3U, 1000U, 4097U}) {
    std::vector<int> numbers(size);
    std::ranges::generate(numbers, [&] { return static_cast<int>(random() % 100); });
    std::vector<int> expected = numbers;
    std::ranges::sort(expected);
    EXPECT_EQ(mergesort(numbers, SequentialExecutor{}), expected);
    for (const unsigned threads : {0U, 1U, 2U, 7U}) {
      EXPECT_EQ(mergesort(numbers, ParallelExecutor<>(threads)), expected);
      EXPECT_EQ(mergesort(numbers, ParallelExecutor<>(threads, 0)), expected);
      EXPECT_EQ(mergesort(numbers, ParallelExecutor<>(threads, 100)), expected);
    }
  }
}

// LAW executor.1: concatenation is associative but not commutative, so an exchanged order shows.
TEST(Divacon, CombinesInTheOrderOfTheSubproblems) {
  const auto spell = [](const auto& executor) {
    return divacon(
        Range{0, 3000}, single,
        [](const Range& range) {
          std::vector<Range> parts;
          for (int part = 0; part < 3; ++part) {
            parts.push_back({range.first + range.size() * part / 3,
                             range.first + range.size() * (part + 1) / 3});
          }
          return parts;
        },
        [](const Range& range) {
          return range.size() == 0 ? std::string() : std::to_string(range.first) + ",";
        },
        [](std::span<std::string> texts) {
          return std::accumulate(texts.begin(), texts.end(), std::string());
        },
        executor);
  };
  std::string expected;
  for (int i = 0; i < 3000; ++i) expected += std::to_string(i) + ",";
  EXPECT_EQ(spell(SequentialExecutor{}), expected);
  for (int round = 0; round < 10; ++round) EXPECT_EQ(spell(ParallelExecutor<>(4, 5)), expected);
}

// LAW divacon.1, second form: the sum over all nodes of the range's size, n per level of a
// perfectly halved range of n = 2^k, hence n (k + 1).
TEST(Divacon, CombineMayUseTheOriginalData) {
  const auto weight = [](const auto& executor) {
    return divacon(
        Range{0, 1 << 10}, single, halves, [](const Range& range) { return range.size(); },
        [](std::span<int> sums, const Range& range) { return sums[0] + sums[1] + range.size(); },
        executor);
  };
  EXPECT_EQ(weight(SequentialExecutor{}), (1 << 10) * 11);
  EXPECT_EQ(weight(ParallelExecutor<>(3)), (1 << 10) * 11);
}

// LAW divacon.2: a halved range of n has n leaves and n - 1 inner problems.
TEST(Divacon, CallsEveryCallbackOnceForEveryProblem) {
  std::atomic<int> leaves = 0, divisions = 0, solved = 0, combined = 0;
  const auto count = [&](const auto& executor) {
    leaves = divisions = solved = combined = 0;
    divacon(
        Range{0, 500},
        [&](const Range& range) {
          ++leaves;
          return single(range);
        },
        [&](const Range& range) {
          ++divisions;
          return halves(range);
        },
        [&](const Range&) {
          ++solved;
          return 0;
        },
        [&](std::span<int>) {
          ++combined;
          return 0;
        },
        executor);
    EXPECT_EQ(leaves, 999);
    EXPECT_EQ(divisions, 499);
    EXPECT_EQ(solved, 500);
    EXPECT_EQ(combined, 499);
  };
  count(SequentialExecutor{});
  count(ParallelExecutor<>(4, 4));
}

// LAW divacon.3
TEST(Divacon, MoveOnlyDataAndResults) {
  using Box = std::unique_ptr<int>;
  const auto powers = [](const auto& executor) {
    return divacon(
        std::make_unique<int>(12), [](const Box& box) { return *box == 0; },
        [](Box&& box) {
          std::vector<Box> parts;
          parts.push_back(std::make_unique<int>(*box - 1));
          parts.push_back(std::move(box));
          --*parts.back();
          return parts;
        },
        [](Box&& box) {
          *box = 1;
          return std::move(box);
        },
        [](std::span<Box> boxes) {
          *boxes[0] += *boxes[1];
          return std::move(boxes[0]);
        },
        executor);
  };
  EXPECT_EQ(*powers(SequentialExecutor{}), 1 << 12);
  EXPECT_EQ(*powers(ParallelExecutor<>(2)), 1 << 12);
}

TEST(Divacon, MoveOnlyDataInTheSecondForm) {
  using Box = std::unique_ptr<int>;
  const Box result = divacon(
      std::make_unique<int>(5), [](const Box& box) { return *box == 0; },
      [](Box& box) {
        std::array<Box, 1> parts{std::make_unique<int>(*box - 1)};
        return parts;
      },
      [](Box&& box) { return std::move(box); },
      [](std::span<Box> boxes, Box&& box) {
        *box += *boxes[0];
        return std::move(box);
      });
  EXPECT_EQ(*result, 5 + 4 + 3 + 2 + 1);
}

// bool results: no std::vector<bool> may come in between.
TEST(Divacon, BooleanResults) {
  const auto any_above = [](int bound, const auto& executor) {
    return divacon(
        Range{0, 100}, single, halves, [=](const Range& r) { return r.first > bound; },
        [](std::span<bool> any) { return any[0] || any[1]; }, executor);
  };
  EXPECT_TRUE(any_above(98, SequentialExecutor{}));
  EXPECT_FALSE(any_above(99, ParallelExecutor<>(2)));
}

TEST(Divacon, ADivisionIntoNothingCombinesNothing) {
  const auto run = [](const auto& executor) {
    return divacon(
        3, [](int) { return false; }, [](int) { return std::vector<int>(); }, [](int) { return 1; },
        [](std::span<int> results) { return static_cast<int>(results.size()) + 40; }, executor);
  };
  EXPECT_EQ(run(SequentialExecutor{}), 40);
  EXPECT_EQ(run(ParallelExecutor<>(2)), 40);
}

// LAW executor.3: one element is split off at a time, at either end; a recursive divacon would
// need a million stack frames. The sum 0 + ... + (n-1) is n (n-1) / 2.
TEST(Divacon, DivisionsAMillionDeep) {
  constexpr int n = 1'000'000;
  const auto sum = [](bool at_front, const auto& executor) {
    return divacon(
        Range{0, n}, single,
        [=](const Range& r) {
          const int cut = at_front ? r.first + 1 : r.last - 1;
          return std::array{Range{r.first, cut}, Range{cut, r.last}};
        },
        [](const Range& r) { return std::int64_t{r.first}; },
        [](std::span<std::int64_t> sums) { return sums[0] + sums[1]; }, executor);
  };
  constexpr std::int64_t expected = std::int64_t{n} * (n - 1) / 2;
  for (const bool at_front : {false, true}) {
    EXPECT_EQ(sum(at_front, SequentialExecutor{}), expected);
    EXPECT_EQ(sum(at_front, ParallelExecutor<>(4)), expected);
  }
}

// LAW executor.2
TEST(Divacon, ExceptionsComeOutOfEveryCallback) {
  enum class Where { Leaf, Divide, Solve, Combine };
  const auto run = [](Where where, const auto& executor) {
    const auto fail = [where](Where here, const Range& range) {
      if (where == here && range.first <= 700 && 700 < range.last) {
        throw std::runtime_error("planted");
      }
    };
    divacon(
        Range{0, 1000},
        [&](const Range& r) {
          fail(Where::Leaf, r);
          return single(r);
        },
        [&](const Range& r) {
          if (r.size() < 20) fail(Where::Divide, r);
          return halves(r);
        },
        [&](const Range& r) {
          fail(Where::Solve, r);
          return std::make_unique<int>(r.first);
        },
        [&](std::span<std::unique_ptr<int>> results, const Range& r) {
          fail(Where::Combine, r);
          return std::move(results[0]);
        },
        executor);
  };
  for (const Where where : {Where::Leaf, Where::Divide, Where::Solve, Where::Combine}) {
    EXPECT_THROW(run(where, SequentialExecutor{}), std::runtime_error);
    for (int round = 0; round < 20; ++round) {
      EXPECT_THROW(run(where, ParallelExecutor<>(4)), std::runtime_error);
      EXPECT_THROW(run(where, ParallelExecutor<>(4, 3)), std::runtime_error);
    }
  }
}

// LAW executor.2: every leaf throws; still one std::runtime_error comes out, and a later
// computation is not disturbed.
TEST(Divacon, ManyExceptionsAreOne) {
  for (int round = 0; round < 50; ++round) {
    const ParallelExecutor<> executor(4);
    EXPECT_THROW(
        divacon(
            Range{0, 300}, single, halves,
            [](const Range& r) -> int { throw std::runtime_error(std::to_string(r.first)); },
            [](std::span<int>) { return 0; }, executor),
        std::runtime_error);
  }
  EXPECT_TRUE(std::ranges::is_sorted(mergesort({3, 1, 2}, ParallelExecutor<>(4))));
}

// A computation inside another's task.
TEST(Divacon, Nests) {
  const ParallelExecutor<> executor(3);
  const int total = divacon(
      Range{0, 50}, single, halves,
      [&](const Range& outer) {
        return divacon(
            Range{0, outer.first}, single, halves, [](const Range& r) { return r.size(); },
            [](std::span<int> n) { return n[0] + n[1]; }, executor);
      },
      [](std::span<int> n) { return n[0] + n[1]; }, executor);
  EXPECT_EQ(total, 49 * 50 / 2);
}

// A small archetype: what a third executor has to offer, and no more.
struct Archetype {
  template <DivideAndConquer A>
  typename A::Result run(typename A::Problem problem, A& algorithm) const {
    std::vector<typename A::Problem> parts;
    const auto receive = [&](typename A::Problem&& part) { parts.push_back(std::move(part)); };
    if (auto solved = expand(algorithm, problem, receive)) return std::move(*solved);
    detail::Array<typename A::Result> results;
    for (auto& part : parts) results.push_back(run(std::move(part), algorithm));
    return algorithm.combine(std::span(results.data(), results.size()), std::move(problem));
  }
};
TEST(Divacon, RunsOnAnyExecutor) {
  EXPECT_EQ(mergesort({3, 1, 2}, Archetype{}), (std::vector{1, 2, 3}));
}

TEST(ParallelExecutor, AsksWhatIsWorthATask) {
  const auto large = [](const Range& r) { return r.size() > 10; };
  const ParallelExecutor<decltype(large)> executor(2, 16, large);
  EXPECT_EQ(divacon(
                Range{0, 1000}, single, halves, [](const Range& r) { return r.size(); },
                [](std::span<int> n) { return n[0] + n[1]; }, executor),
            1000);
}

}  // namespace
}  // namespace exactcsg::skeleton
