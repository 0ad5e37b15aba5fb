// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/skeleton/progress_executor.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "exactcsg/skeleton/divacon.hpp"
#include "exactcsg/skeleton/simulated_executor.hpp"

namespace exactcsg::skeleton {
namespace {

const tbb::global_control more_threads(tbb::global_control::max_allowed_parallelism, 8);

struct Range {
  int first, last;
  int size() const { return last - first; }
};
int sum_of(Range range, const auto& executor, auto&& at_leaf) {
  return divacon(
      range, [](const Range& r) { return r.size() <= 1; },
      [](const Range& r) {
        const int third = (r.size() + 2) / 3;
        return std::vector<Range>{{r.first, r.first + third}, {r.first + third, r.last}};
      },
      [&](const Range& r) {
        at_leaf();
        return r.size() == 0 ? 0 : r.first;
      },
      [](std::span<int> n) { return n[0] + n[1]; }, executor);
}
constexpr int sum_below_500 = 499 * 500 / 2;
constexpr auto nothing = [] {};

// LAW progress.1, .2
TEST(ProgressExecutor, ReachesItsTotal) {
  const auto large = [](const Range& r) { return r.size() > 10; };
  const auto check = [](const auto& inner) {
    Progress progress;
    EXPECT_EQ(sum_of({0, 500}, ProgressExecutor(inner, progress, "sum"), nothing), sum_below_500);
    EXPECT_EQ(std::string(progress.stage()), "sum");
    EXPECT_GT(progress.total(), 0U);
    EXPECT_EQ(progress.done(), progress.total());
  };
  check(SequentialExecutor{});
  check(ParallelExecutor<>(4));
  check(ParallelExecutor<decltype(large)>(4, 16, large));
  TaskGraph graph;
  check(SimulatedExecutor(graph));
}

TEST(ProgressExecutor, NeverDecreases) {
  Progress progress;
  std::uint64_t before = 0;
  int leaves = 0;
  sum_of({0, 500}, ProgressExecutor(SequentialExecutor{}, progress), [&] {
    ++leaves;
    EXPECT_GE(progress.done(), before);
    EXPECT_LE(progress.done(), progress.total());
    before = progress.done();
  });
  EXPECT_GE(leaves, 500);
  EXPECT_GT(before, progress.total() / 2);
}

// LAW progress.3
TEST(ProgressExecutor, IsCancelled) {
  const auto error_of = [](const auto& executor, Progress& progress) {
    std::atomic<int> leaves = 0;
    try {
      sum_of({0, 1'000'000}, executor, [&] {
        if (++leaves == 100) progress.cancel(ErrorId::TimeLimit);
      });
    } catch (const Error& error) {
      EXPECT_LT(leaves, 200);
      return error.id();
    }
    return ErrorId::InternalError;
  };
  Progress first;
  EXPECT_EQ(error_of(ProgressExecutor(SequentialExecutor{}, first), first), ErrorId::TimeLimit);
  Progress second;
  EXPECT_EQ(error_of(ProgressExecutor(ParallelExecutor<>(4), second), second), ErrorId::TimeLimit);
}

TEST(ProgressExecutor, ThatIsCancelledBeforehandBeginsNothing) {
  Progress progress;
  progress.cancel();
  int leaves = 0;
  EXPECT_THROW(sum_of({0, 10}, ProgressExecutor(SequentialExecutor{}, progress), [&] { ++leaves; }),
               Error);
  EXPECT_EQ(leaves, 0);
}

// An early out leaves shares undone; the whole is done all the same.
TEST(ProgressExecutor, CountsWhatAnEarlyOutDrops) {
  Progress progress;
  const int first = divacon(
      0, [](int i) { return i > 0; },
      [](int) {
        return std::vector{1, 2, 3};
      },
      [](int i) { return i; },
      EarlyOut{[](std::span<int> r) { return r.back(); }, [](int) { return true; }},
      ProgressExecutor(SequentialExecutor{}, progress));
  EXPECT_EQ(first, 1);
  EXPECT_EQ(progress.done(), progress.total());
}

}  // namespace
}  // namespace exactcsg::skeleton
