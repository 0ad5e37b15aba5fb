// SPDX-License-Identifier: GPL-3.0-or-later
// Reductions of the whole tree: reduce, traverse_batch, set_skeleton; against traverse, which is
// held against truth tables.

#include "exactcsg/csg/reduce.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "csg/chains.hpp"
#include "csg/random_tree.hpp"
#include "exactcsg/csg/attributed.hpp"
#include "exactcsg/csg/batch.hpp"
#include "exactcsg/csg/flat_tree.hpp"
#include "exactcsg/csg/set_skeleton.hpp"
#include "exactcsg/csg/text.hpp"
#include "exactcsg/skeleton/progress_executor.hpp"
#include "exactcsg/skeleton/simulated_executor.hpp"

namespace exactcsg::csg {
namespace {

const tbb::global_control more_threads(tbb::global_control::max_allowed_parallelism, 8);

using test::absorbing;
using test::all_assignments;
using test::below;
using test::Bits;
using test::chain;
using test::chain_depth;
using test::combine_texts;
using test::constant_texts;
using test::constants;
using test::leaf;
using test::meaning;
using test::random_tree;
using test::same;
using test::Side;
using test::TestTree;
using test::text;
using enum BooleanOperator;

// LAW reduce.1, .2
TEST(Reduce, IsTheFoldOfTraverse) {
  std::mt19937 random(21);
  for (int round = 0; round < 200; ++round) {
    const TestTree tree = random_tree(random, 5, 6);
    const auto fold = [](BooleanOperator op, std::span<std::string> texts) {
      std::string all = texts[0];
      for (const std::string& next : texts.subspan(1)) all = combine_texts(all, op, next);
      return all;
    };
    const std::string expected = traverse(tree, text, combine_texts, constant_texts);
    EXPECT_EQ(reduce(tree, text, fold, constant_texts), expected);
    EXPECT_EQ(reduce(flatten(tree, same), text, fold, constant_texts), expected);
  }
}

// Operators of one operand, which traverse passes through.
TEST(Reduce, KnowsOperatorsOfAnyNumberOfOperands) {
  enum class Logic { Not, Majority };
  using Formula = Tree<bool, Logic>;
  const auto value_of = [](const Formula& formula) {
    return reduce(
        formula, [](bool b) { return b; },
        [](Logic op, std::span<bool> operands) {
          if (op == Logic::Not) return !operands[0];
          return 2 * std::count(operands.begin(), operands.end(), true) >
                 static_cast<std::ptrdiff_t>(operands.size());
        });
  };
  const Formula yes = Formula::primitive(true);
  const Formula no = Formula::compose(Logic::Not, {yes});
  EXPECT_FALSE(value_of(no));
  EXPECT_TRUE(value_of(Formula::compose(Logic::Not, {no})));
  EXPECT_TRUE(value_of(Formula::compose(Logic::Majority, {yes, no, yes})));
  EXPECT_FALSE(value_of(Formula::compose(Logic::Majority, {yes, no, no, yes})));
}

TEST(Reduce, MovesResultsAndMissesSpecialOnes) {
  using Box = std::unique_ptr<int>;
  const auto solve = [](int i) { return std::make_unique<int>(i); };
  const auto sum = [](BooleanOperator, std::span<Box> boxes) {
    for (Box& box : boxes.subspan(1)) *boxes[0] += *box;
    return std::move(boxes[0]);
  };
  EXPECT_EQ(*reduce(unite(leaf(1), subtract(leaf(2), leaf(3))), solve, sum), 6);
  EXPECT_THROW(reduce(complement(leaf(1)), solve, sum), Error);
}

TEST(Reduce, AMillionDeep) {
  for (const Side side : {Side::Left, Side::Right, Side::Single}) {
    const auto tree = chain(chain_depth, Union, side, 1);
    const auto levels = [](BooleanOperator, std::span<int> below) {
      return 1 + *std::max_element(below.begin(), below.end());
    };
    EXPECT_EQ(reduce(tree, same, levels), chain_depth + 1);
  }
}

// LAW batch.1, .2
TEST(Batch, IsOneTraversalForEveryQuery) {
  std::mt19937 random(22);
  std::vector<unsigned> assignments(64);
  for (unsigned i = 0; i < 64; ++i) assignments[i] = i;
  using Asked = std::vector<std::pair<int, unsigned>>;
  for (int round = 0; round < 500; ++round) {
    const TestTree tree = random_tree(random, 5, 6);
    Asked asked;
    const auto solve = [&](int primitive, unsigned assignment) {
      asked.push_back({primitive, assignment});
      return (assignment >> primitive) & 1U ? Membership::In : Membership::Out;
    };
    const auto check = [&](auto absorbs_or_not) {
      asked.clear();
      std::vector<Membership> expected;
      for (const unsigned a : assignments) {
        expected.push_back(traverse(tree, a, solve, combine, constants, absorbs_or_not));
      }
      Asked asked_singly = std::exchange(asked, {});
      ASSERT_EQ(traverse_batch(tree, assignments, solve, combine, constants, absorbs_or_not),
                expected);
      std::sort(asked.begin(), asked.end());
      std::sort(asked_singly.begin(), asked_singly.end());
      ASSERT_EQ(asked, asked_singly);
      ASSERT_EQ(traverse_batch(flatten(tree, same), assignments, solve, combine, constants,
                               absorbs_or_not),
                expected);
    };
    check(absorbing);
    check(NeverAbsorbs{});
  }
}

// LAW batch.3: a primitive that no query needs is not asked about; an empty batch asks nothing.
TEST(Batch, VisitsWhatSomeQueryNeeds) {
  const TestTree tree = TestTree::compose(Union, {leaf(0), leaf(1), leaf(2)});
  std::vector<std::pair<int, int>> asked;
  const auto solve = [&](int primitive, int query) {
    asked.push_back({primitive, query});
    return primitive == query ? Membership::In : Membership::Out;
  };
  const std::vector<int> queries{1, 0, 1};
  EXPECT_EQ(traverse_batch(tree, queries, solve, combine, NoSpecial{}, absorbing),
            (std::vector<Membership>(3, Membership::In)));
  EXPECT_EQ(asked, (std::vector<std::pair<int, int>>{{0, 1}, {0, 0}, {0, 1}, {1, 1}, {1, 1}}));
  asked.clear();
  EXPECT_TRUE(traverse_batch(tree, std::vector<int>{}, solve, combine).empty());
  EXPECT_TRUE(asked.empty());
}

TEST(Batch, AMillionDeep) {
  const std::vector<int> queries{1, 2, 3};
  const auto times = [](int primitive, int query) { return std::int64_t{primitive} * query; };
  const auto sum = [](std::int64_t a, BooleanOperator, std::int64_t b) { return a + b; };
  for (const Side side : {Side::Left, Side::Right}) {
    const auto results = traverse_batch(chain(chain_depth, Union, side, 1), queries, times, sum);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(results[i], (chain_depth + 1) * std::int64_t{queries[i]});
    }
  }
}

// Bit sets: every bit is the truth of one assignment.
const SetAlgebra bits{[](Bits a, Bits b) { return a & b; }, [](Bits a, Bits b) { return a | b; },
                      ~Bits{0}, Bits{0}, [](Bits a) { return ~a; }};

// LAW skeleton.1: against set operations written out, on every executor and for every grain.
TEST(SetSkeleton, IsTheSetOnEveryExecutor) {
  std::mt19937 random(23);
  const auto primitives = all_assignments();
  const auto solve = [&](int i) { return primitives[static_cast<std::size_t>(i)]; };
  for (int round = 0; round < 1000; ++round) {
    const TestTree tree = random_tree(random, 1 + round % 8, 6);
    const Bits expected = meaning(tree, primitives);
    ASSERT_EQ(set_skeleton(tree, solve, bits), expected);
    for (const std::uint64_t grain : {1U, 3U, 20U}) {
      ASSERT_EQ(set_skeleton(tree, solve, bits, skeleton::ParallelExecutor<>(2, 4), grain),
                expected);
      skeleton::TaskGraph graph;
      ASSERT_EQ(set_skeleton(tree, solve, bits, skeleton::SimulatedExecutor(graph), grain),
                expected);
    }
  }
}

// In, On and Out as 2, 1, 0: a lattice by minimum and maximum, whose complement is 2 - x. Chains
// whose operators alternate at random, against a loop.
TEST(SetSkeleton, ThreeValuesAlongAChain) {
  std::mt19937 random(24);
  const SetAlgebra in_on_out{[](int a, int b) { return std::min(a, b); },
                             [](int a, int b) { return std::max(a, b); }, 2, 0,
                             [](int a) { return 2 - a; }};
  for (int round = 0; round < 100; ++round) {
    int expected = static_cast<int>(below(random, 3));
    TestTree tree = leaf(expected);
    for (int i = 0; i < 200; ++i) {
      const int next = static_cast<int>(below(random, 3));
      switch (below(random, 4)) {
        case 0:
          tree = unite(tree, leaf(next));
          expected = std::max(expected, next);
          break;
        case 1:
          tree = intersect(leaf(next), tree);
          expected = std::min(expected, next);
          break;
        case 2:
          tree = subtract(tree, leaf(next));
          expected = std::min(expected, 2 - next);
          break;
        default:
          tree = subtract(leaf(next), tree);
          expected = std::min(next, 2 - expected);
      }
    }
    skeleton::TaskGraph graph;
    EXPECT_EQ(set_skeleton(tree, same, in_on_out), expected);
    EXPECT_EQ(set_skeleton(tree, same, in_on_out, skeleton::SimulatedExecutor(graph), 4), expected);
  }
}

TEST(SetSkeleton, TakesAQueryAndAttributes) {
  const TestTree tree = unite(leaf(1), subtract(leaf(2), leaf(4)));
  const auto shifted = [](int i, int by) { return Bits{1} << (i + by); };
  EXPECT_EQ(set_skeleton(tree, 1, shifted, bits), Bits{4 + 8});
  const auto named = attribute(
      tree, [](int) { return std::string("a"); },
      [](std::string a, BooleanOperator, const std::string& b) { return a + b; });
  EXPECT_EQ(set_skeleton(named, 1, shifted, bits, skeleton::ParallelExecutor<>(2), 1), Bits{4 + 8});
}

// The skeleton of the source has intersection and union alone.
TEST(SetSkeleton, NeedsAComplementForDifferencesOnly) {
  const SetAlgebra lattice{[](Bits a, Bits b) { return a & b; },
                           [](Bits a, Bits b) { return a | b; }, ~Bits{0}, Bits{0}};
  const auto solve = [](int i) { return Bits{1} << i; };
  EXPECT_EQ(set_skeleton(unite(leaf(1), leaf(2)), solve, lattice), Bits{6});
  EXPECT_EQ(set_skeleton(TestTree::full(), solve, lattice), ~Bits{0});
  EXPECT_EQ(set_skeleton(TestTree::empty(), solve, lattice), Bits{0});
  try {
    set_skeleton(subtract(leaf(1), leaf(2)), solve, lattice);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.id(), ErrorId::BadArgument);
  }
}

// A chain has no parallelism by subtrees. Every primitive costs one unit here, and nothing else
// does: 64 workers classify a point against a chain of a million at least 50 times as fast as one.
TEST(SetSkeleton, SpeedsUpAChain) {
  constexpr int n = 1'000'000;  // with sanitizers too: shorter chains have less to share out
  const SetAlgebra lattice{[](bool a, bool b) { return a && b; },
                           [](bool a, bool b) { return a || b; }, true, false,
                           [](bool a) { return !a; }};
  for (const Side side : {Side::Left, Side::Right}) {
    std::uint64_t time = 0;
    const auto solve = [&](int) {
      ++time;
      return true;
    };
    const auto clock = [&time] { return time; };
    const auto tree = chain(n, Intersection, side, 1);
    skeleton::TaskGraph graph;
    EXPECT_TRUE(set_skeleton(tree, solve, lattice, skeleton::SimulatedExecutor(graph, clock)));
    EXPECT_EQ(graph.work(), static_cast<std::uint64_t>(n + 1));
    EXPECT_GT(skeleton::schedule(graph, 64).speed_up(), 50.0);
    EXPECT_TRUE(set_skeleton(
        tree, same,
        SetAlgebra{std::logical_and<>{}, std::logical_or<>{}, true, false, std::logical_not<>{}},
        skeleton::ParallelExecutor<>(2)));
  }
}

}  // namespace
}  // namespace exactcsg::csg
