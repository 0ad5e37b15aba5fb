// SPDX-License-Identifier: GPL-3.0-or-later
// The fused form of divacon, and early outs, against plain recursion.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <thread>
#include <utility>
#include <vector>

#include "exactcsg/skeleton/divacon.hpp"
#include "exactcsg/skeleton/progress_executor.hpp"
#include "exactcsg/skeleton/simulated_executor.hpp"

namespace exactcsg::skeleton {
namespace {

const tbb::global_control more_threads(tbb::global_control::max_allowed_parallelism, 8);

// The least that a problem and a result may be: movable.
struct MovableProblem {
  std::unique_ptr<int> size;
};
using MovableResult = std::unique_ptr<int>;
struct MinimalAlgorithm {
  using Problem = MovableProblem;
  using Result = MovableResult;
  std::optional<Result> expand(Problem&, void (*)(Problem&&)) { return std::nullopt; }
  Result combine(std::span<Result>, Problem&&) { return {}; }
};
struct MinimalInSteps {
  using Problem = MovableProblem;
  using Result = MovableResult;
  bool is_leaf(const Problem&) { return true; }
  void divide(Problem&, void (*)(Problem&&)) {}
  Result solve(Problem&& problem) { return std::move(problem.size); }
  Result combine(std::span<Result>, Problem&&) { return {}; }
};
struct MinimalEarlyOut : MinimalAlgorithm {
  bool enough(const Result&, const Problem&) { return false; }
};
static_assert(DivideAndConquer<MinimalAlgorithm> && !StopsEarly<MinimalAlgorithm>);
static_assert(DivideAndConquer<MinimalInSteps> && !StopsEarly<MinimalInSteps>);
static_assert(StopsEarly<MinimalEarlyOut>);
static_assert(CostClock<Nanoseconds> && CostClock<CallCount>);

// An irregular tree that its root determines.
struct Problem {
  std::uint64_t seed;
  int depth;
};
std::uint64_t mixed(std::uint64_t x) {  // the finaliser of splitmix64
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31);
}
bool is_leaf(const Problem& problem) { return problem.depth == 0 || mixed(problem.seed) % 8 == 0; }
std::vector<Problem> parts_of(const Problem& problem) {
  std::vector<Problem> parts(mixed(problem.seed + 1) % 5);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    parts[i] = {mixed(problem.seed * 31 + i), problem.depth - 1};
  }
  return parts;
}
std::uint64_t solved(const Problem& problem) { return mixed(problem.seed + 2); }
// Depends on the number and the order of the results.
std::uint64_t combined(std::span<const std::uint64_t> results) {
  std::uint64_t sum = 17;
  for (const std::uint64_t result : results) sum = mixed(sum ^ result);
  return sum;
}

// LAW divacon.4
TEST(Expand, IsLeafDivideAndSolve) {
  const auto expand = [](const Problem& p) -> Expansion<std::uint64_t, std::vector<Problem>> {
    if (is_leaf(p)) return Solved{solved(p)};
    return Divided{parts_of(p)};
  };
  const auto combine = [](std::span<std::uint64_t> r) { return combined(r); };
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const Problem root{seed, 8};
    const auto expected = divacon(root, is_leaf, parts_of, solved, combine);
    EXPECT_EQ(divacon(root, expand, combine), expected);
    EXPECT_EQ(divacon(root, expand, combine, ParallelExecutor<>(4, 5)), expected);
    const auto with_data = [](std::span<std::uint64_t> r, const Problem& p) {
      return combined(r) + p.seed;
    };
    EXPECT_EQ(divacon(root, expand, with_data),
              divacon(root, is_leaf, parts_of, solved, with_data));
  }
}

// LAW divacon.3: 2^4 leaves of size 1.
TEST(Expand, MovesProblemsAndResults) {
  const auto expand =
      [](MovableProblem p) -> Expansion<MovableResult, std::vector<MovableProblem>> {
    if (*p.size == 1) return Solved{std::move(p.size)};
    std::vector<MovableProblem> halves;
    for (int i = 0; i < 2; ++i) halves.push_back({std::make_unique<int>(*p.size / 2)});
    return Divided{std::move(halves)};
  };
  const auto sum = [](std::span<MovableResult> r) { return std::make_unique<int>(*r[0] + *r[1]); };
  EXPECT_EQ(*divacon(MovableProblem{std::make_unique<int>(16)}, expand, sum), 16);
  EXPECT_EQ(*divacon(MovableProblem{std::make_unique<int>(16)}, expand, sum, ParallelExecutor<>(3)),
            16);
}

// The source's leaf/solve problem: what decides a leaf is computed once for a problem. 64 leaves of
// one number each have 127 problems; the numbers 0 .. 63 add up to 64 * 63 / 2.
TEST(Expand, ComputesOnceWhatDecidesALeaf) {
  struct Range {
    int from, to;
  };
  int computed = 0;
  const int sum = divacon(
      Range{0, 64},
      [&](const Range& r) -> Expansion<int, std::vector<Range>> {
        ++computed;
        const int middle = (r.from + r.to) / 2;
        if (middle == r.from) return Solved{middle};
        return Divided{std::vector{Range{r.from, middle}, Range{middle, r.to}}};
      },
      [](std::span<int> halves) { return halves[0] + halves[1]; });
  EXPECT_EQ(sum, 64 * 63 / 2);
  EXPECT_EQ(computed, 127);
}

bool is_enough(std::uint64_t result) { return result % 6 == 0; }
bool is_planted(const Problem& problem) { return mixed(problem.seed + 3) % 40 == 0; }

// Plain recursion from left to right: the value, or the seed of the problem that throws.
struct Outcome {
  std::uint64_t value;
  bool is_failure;
  friend bool operator==(const Outcome&, const Outcome&) = default;
};
Outcome expected_outcome(const Problem& problem, bool throws) {
  if (is_leaf(problem)) {
    if (throws && is_planted(problem)) return {problem.seed, true};
    return {solved(problem), false};
  }
  std::vector<std::uint64_t> results;
  for (const Problem& part : parts_of(problem)) {
    const Outcome outcome = expected_outcome(part, throws);
    if (outcome.is_failure) return outcome;
    results.push_back(outcome.value);
    if (is_enough(outcome.value)) break;
  }
  return {combined(results), false};
}

struct Planted {
  std::uint64_t seed;
};
Outcome outcome_on(const auto& executor, const Problem& root, bool throws) {
  const auto solve = [throws](const Problem& p) {
    if (throws && is_planted(p)) throw Planted{p.seed};
    return solved(p);
  };
  const auto combine = [](std::span<std::uint64_t> r) { return combined(r); };
  try {
    return {divacon(root, is_leaf, parts_of, solve, EarlyOut{combine, is_enough}, executor), false};
  } catch (const Planted& planted) {
    return {planted.seed, true};
  }
}

// LAW divacon.5, LAW executor.4: the value, and the exception, of a left-to-right recursion.
TEST(EarlyOut, IsTheSameOnEveryExecutor) {
  int failures = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const Problem root{mixed(seed), 9};
    for (const bool throws : {false, true}) {
      const Outcome expected = expected_outcome(root, throws);
      failures += expected.is_failure ? 1 : 0;
      ASSERT_EQ(outcome_on(SequentialExecutor{}, root, throws), expected);
      ASSERT_EQ(outcome_on(ParallelExecutor<>(4), root, throws), expected);
      ASSERT_EQ(outcome_on(ParallelExecutor<>(4, 3), root, throws), expected);
      TaskGraph graph;
      ASSERT_EQ(outcome_on(SimulatedExecutor(graph), root, throws), expected);
      Progress progress;
      ASSERT_EQ(outcome_on(ProgressExecutor(ParallelExecutor<>(2), progress), root, throws),
                expected);
    }
  }
  EXPECT_GT(failures, 10);
  EXPECT_LT(failures, 290);
}

struct Interval {
  int first, last;
};
std::vector<Interval> halves_of(const Interval& i) {
  const int middle = (i.first + i.last) / 2;
  return {{i.first, middle}, {middle, i.last}};
}

// LAW executor.4: looking for 0 in 0 .. 1023 from the left asks one leaf alone.
TEST(EarlyOut, DoesNotBeginWhatDoesNotMatter) {
  const auto leaves_asked = [](int wanted) {
    int asked = 0;
    const bool found = divacon(
        Interval{0, 1024}, [](const Interval& i) { return i.last - i.first == 1; }, halves_of,
        [&](const Interval& i) {
          ++asked;
          return i.first == wanted;
        },
        EarlyOut{[](std::span<bool> r) { return r.back(); }, [](bool found) { return found; }});
    EXPECT_TRUE(found);
    return asked;
  };
  for (const int wanted : {0, 1, 511, 512, 1023}) EXPECT_EQ(leaves_asked(wanted), wanted + 1);
}

// enough may ask the parent: minimax with cut-offs at the value range's ends, which depend on whose
// turn it is. The value of a perfect tree whose leaves are all 0 but one is known.
TEST(EarlyOut, MayAskTheOriginalData) {
  struct Node {
    int depth;
    bool maximises;
  };
  int leaves = 0;
  const int value = divacon(
      Node{12, true}, [](const Node& n) { return n.depth == 0; },
      [](const Node& n) {
        return std::vector<Node>(2, Node{n.depth - 1, !n.maximises});
      },
      [&](const Node&) {
        ++leaves;
        return 1;
      },
      EarlyOut{[](std::span<int> r, const Node& n) {
                 return n.maximises ? *std::max_element(r.begin(), r.end())
                                    : *std::min_element(r.begin(), r.end());
               },
               [](int r, const Node& parent) { return r == (parent.maximises ? 1 : 0); }});
  EXPECT_EQ(value, 1);
  EXPECT_EQ(leaves, 1 << 6);  // one child of every maximiser, both of every minimiser
}

// The tasks that an early out drops do stop: here they would never end by themselves.
TEST(EarlyOut, StopsWhatHasBegun) {
  std::atomic<bool> endless_has_begun = false;
  const bool found = divacon(
      Interval{0, 2}, [](const Interval& i) { return i.first == 0 && i.last == 1; },
      [&](const Interval& i) -> std::vector<Interval> {
        if (i.first == 0) return {{0, 1}, {1, 2}};
        endless_has_begun = true;
        return {{1, 2}};  // itself
      },
      [&](const Interval&) {
        const auto begin = std::chrono::steady_clock::now();
        while (!endless_has_begun &&
               std::chrono::steady_clock::now() - begin < std::chrono::seconds(5)) {
          std::this_thread::yield();
        }
        return true;
      },
      EarlyOut{[](std::span<bool> r) { return r.back(); }, [](bool r) { return r; }},
      ParallelExecutor<>(4));
  EXPECT_TRUE(found);
}

}  // namespace
}  // namespace exactcsg::skeleton
