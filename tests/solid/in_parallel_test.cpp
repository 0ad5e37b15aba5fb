// SPDX-License-Identifier: GPL-3.0-or-later
// Expected: what the same loop does on one thread.
#include "exactcsg/support/in_parallel.hpp"
#include "exactcsg/solid/first_error.hpp"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <array>
#include <atomic>
#include <numeric>
#include <stdexcept>
#include <string>

namespace exactcsg {
namespace {

TEST(InParallel, EveryRoundIsRunOnce) {
  for (const unsigned threads : {1U, 2U, 0U}) {
    std::vector<std::atomic<int>> runs(5000);
    in_parallel(threads, runs.size(), [&](std::size_t i) { ++runs[i]; });
    for (const auto& count : runs) EXPECT_EQ(count, 1);
    in_parallel_parts(threads, runs.size(), [&](std::size_t i) { ++runs[i]; });
    for (const auto& count : runs) EXPECT_EQ(count, 2);
    in_parallel(threads, 0, [](std::size_t) { FAIL(); });
    in_parallel_parts(threads, 0, [](std::size_t) { FAIL(); });
  }
}

// Whatever arena the caller is in, and from within a round.
TEST(InParallel, EveryRoundIsRunOnceInsideOfOthers) {
  for (const int places : {1, 2, 4}) {
    tbb::task_arena(places).execute([] {
      std::vector<std::atomic<int>> runs(3000);
      in_parallel(2, 3, [&](std::size_t i) {
        in_parallel(0, 1000, [&](std::size_t j) { ++runs[1000 * i + j]; });
      });
      for (const auto& count : runs) EXPECT_EQ(count, 1);
    });
  }
}

TEST(InParallel, AnExceptionIsThrownOn) {
  for (const unsigned threads : {1U, 2U, 0U}) {
    EXPECT_THROW(in_parallel(threads, 100,
                             [](std::size_t i) {
                               if (i == 70) throw std::runtime_error("round 70");
                             }),
                 std::runtime_error);
  }
}

// As a loop in order: rounds before the first that fails are run, and its exception is the one.
TEST(InParallel, TheFirstErrorIsThrownOn) {
  for (const unsigned threads : {1U, 2U, 0U}) {
    for (int repetition = 0; repetition < 20; ++repetition) {
      std::vector<std::atomic<int>> runs(300);
      try {
        in_parallel_to_first_error(threads, runs.size(), [&](std::size_t i) {
          ++runs[i];
          if (i >= 130 && i % 2 == 1) throw std::runtime_error(std::to_string(i));
        });
        FAIL();
      } catch (const std::runtime_error& error) {
        EXPECT_STREQ(error.what(), "131");
      }
      for (std::size_t i = 0; i <= 131; ++i) EXPECT_EQ(runs[i], 1);
    }
    std::atomic<int> count = 0;
    in_parallel_to_first_error(threads, 100, [&](std::size_t) { ++count; });
    EXPECT_EQ(count, 100);
  }
}

TEST(Parts, CoverASequenceInOrder) {
  for (const std::size_t count : {0U, 1U, 2047U, 2048U, 2049U, 10000U, 1000003U}) {
    const Parts parts(count);
    std::size_t end = 0;
    for (std::size_t part = 0; part < parts.count(); ++part) {
      EXPECT_EQ(parts.begin(part), end);
      EXPECT_LT(end, parts.end(part));
      end = parts.end(part);
    }
    EXPECT_EQ(end, count);
  }
}

TEST(Parts, BeginOnlyWhereTheyMay) {
  for (const std::size_t run : {3U, 1000U, 60000U}) {
    const Parts parts(100000, [&](std::size_t i) { return i % run == 0; });
    for (std::size_t part = 0; part < parts.count(); ++part) {
      EXPECT_EQ(parts.begin(part) % run, 0U);
    }
    EXPECT_EQ(parts.end(parts.count() - 1), 100000U);
  }
}

// As std::vector::resize: what was there stays, and what is new is as its type begins.
TEST(Resize, KeepsItemsAndMakesNewOnes) {
  struct Item {
    std::array<std::uint64_t, 40> limbs{};
    int mark = 7;
  };
  for (const unsigned threads : {1U, 3U, 0U}) {
    for (const std::size_t size : {0U, 3U, 2000U, 20000U}) {
      std::vector<Item> items(3);
      items[2].limbs[39] = 5;
      items[2].mark = 6;
      resize(threads, items, size);
      ASSERT_EQ(items.size(), size);
      for (std::size_t i = 0; i < size; ++i) {
        EXPECT_EQ(items[i].mark, i == 2 ? 6 : 7);
        EXPECT_EQ(std::accumulate(items[i].limbs.begin(), items[i].limbs.end(), std::uint64_t{0}),
                  i == 2 ? 5U : 0U);
      }
    }
  }
}

TEST(Joined, KeepsTheOrder) {
  for (const unsigned threads : {1U, 2U, 0U}) {
    std::vector<std::vector<int>> lists(50);
    int next = 0;
    for (std::size_t i = 0; i < lists.size(); ++i) {
      for (std::size_t k = 0; k < i % 4 * 100; ++k) lists[i].push_back(next++);
    }
    std::vector<int> expected(static_cast<std::size_t>(next));
    std::iota(expected.begin(), expected.end(), 0);
    EXPECT_EQ(joined(threads, lists), expected);
    EXPECT_TRUE(joined(threads, std::vector<std::vector<int>>{}).empty());
  }
}

}  // namespace
}  // namespace exactcsg
