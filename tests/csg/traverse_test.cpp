// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/csg/traverse.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "csg/chains.hpp"
#include "csg/random_tree.hpp"
#include "exactcsg/csg/flat_tree.hpp"
#include "exactcsg/csg/membership.hpp"
#include "exactcsg/csg/prune.hpp"
#include "exactcsg/csg/text.hpp"

namespace exactcsg::csg {
namespace {

using test::absorbing;
using test::all_assignments;
using test::Bits;
using test::chain;
using test::chain_depth;
using test::combine_texts;
using test::constants;
using test::leaf;
using test::meaning;
using test::random_tree;
using test::same;
using test::Side;
using test::TestTree;
using test::text;
using enum BooleanOperator;
using Flat = FlatTree<int, BooleanOperator>;

// LAW traverse.1, by hand: n-ary operators fold from the left.
TEST(Traverse, FoldsFromTheLeft) {
  const TestTree tree = TestTree::compose(Difference, {leaf(1), unite(leaf(2), leaf(3)), leaf(4)});
  const std::string expected = "((1 - (2 + 3)) - 4)";
  EXPECT_EQ(traverse(tree, text, combine_texts), expected);
  EXPECT_EQ(traverse(flatten(tree, same), text, combine_texts), expected);
  EXPECT_EQ(traverse(leaf(5), text, combine_texts), "5");
  EXPECT_EQ(traverse(TestTree::compose(Union, {leaf(5)}), text, combine_texts), "5");
}

TEST(Traverse, SpecialResults) {
  const TestTree tree = unite(TestTree::full(), TestTree::empty());
  EXPECT_EQ(traverse(tree, text, combine_texts, FullEmptyResult{"F", "E"}), "(F + E)");
  const auto make_full = [] { return std::string("made"); };
  EXPECT_EQ(traverse(complement(leaf(1)), text, combine_texts, FullResult{make_full}),
            "(made - 1)");
}

TEST(Traverse, AMissingSpecialResultIsAnError) {
  const auto id_of = [](auto&& run) {
    try {
      run();
    } catch (const Error& error) {
      return error.id();
    }
    return ErrorId::InternalError;
  };
  const auto traverse_with = [&](const TestTree& tree, auto special) {
    return id_of([&] { traverse(tree, text, combine_texts, special); });
  };
  EXPECT_EQ(traverse_with(TestTree::full(), NoSpecial{}), ErrorId::NoSpecialResult);
  EXPECT_EQ(traverse_with(TestTree::empty(), NoSpecial{}), ErrorId::NoSpecialResult);
  EXPECT_EQ(traverse_with(TestTree::empty(), FullResult{"F"}), ErrorId::NoSpecialResult);
}

TEST(Traverse, HandsTheQueryToSolve) {
  const TestTree tree = unite(leaf(1), leaf(2));
  const auto sum = [](int a, BooleanOperator, int b) { return a + b; };
  const auto times = [](int primitive, int query) { return primitive * query; };
  EXPECT_EQ(traverse(tree, 10, times, sum), 30);
  EXPECT_EQ(traverse(subtract(TestTree::full(), tree), 10, times, sum, FullResult{5}), 35);
}

// The source's trivial example without a query: the number of primitives.
TEST(Traverse, CountsPrimitives) {
  std::mt19937 random(1);
  for (int round = 0; round < 200; ++round) {
    const TestTree tree = random_tree(random, 6, 6);
    const auto count = [](std::uint64_t a, BooleanOperator, std::uint64_t b) { return a + b; };
    const auto one = [](int) { return std::uint64_t{1}; };
    const FullEmptyResult none{std::uint64_t{0}, std::uint64_t{0}};
    EXPECT_EQ(traverse(tree, one, count, none), tree.primitive_count());
  }
}

TEST(Traverse, MoveOnlyResults) {
  using Box = std::unique_ptr<int>;
  const Box sum = traverse(
      unite(leaf(1), subtract(leaf(2), TestTree::full())),
      [](int i) { return std::make_unique<int>(i); },
      [](Box a, BooleanOperator, Box b) {
        *a += *b;
        return a;
      },
      FullResult{[] { return std::make_unique<int>(100); }});
  EXPECT_EQ(*sum, 103);
}

// LAW traverse.1 and .2: truth values of all 64 assignments, tree layouts, with and without absorbs
// and pruning, against set operations on bit sets.
TEST(Traverse, ClassifiesAsTheTruthTableSays) {
  std::mt19937 random(4711);
  const auto primitives = all_assignments();
  TraverseScratch<Flat, Membership> scratch;
  for (int round = 0; round < 2000; ++round) {
    const TestTree tree = random_tree(random, 1 + round % 6, 6);
    const Flat flat = flatten(tree, same);
    Flat pruned;
    prune_into(
        flat, [](int) { return Membership::Unknown; }, pruned);
    const Bits expected = meaning(tree, primitives);
    for (unsigned assignment = 0; assignment < 64; ++assignment) {
      const auto solve = [&](int primitive) {
        return (assignment >> primitive) & 1U ? Membership::In : Membership::Out;
      };
      const Membership truth = (expected >> assignment) & 1U ? Membership::In : Membership::Out;
      ASSERT_EQ(traverse(tree, solve, combine, constants), truth);
      ASSERT_EQ(traverse(tree, solve, combine, constants, absorbing), truth);
      ASSERT_EQ(traverse(flat, solve, combine, constants, absorbing, scratch), truth);
      ASSERT_EQ(traverse(pruned, solve, combine, constants, absorbing, scratch), truth);
      ASSERT_EQ(membership_of(tree, solve), truth);  // LAW membership.1
      ASSERT_EQ(membership_of(flat, solve), truth);
    }
  }
}

// LAW traverse.2 and .3
TEST(Traverse, SkipsWhatIsAbsorbed) {
  const TestTree tree = TestTree::compose(
      Union, {intersect(leaf(0), leaf(1)), leaf(2), subtract(leaf(3), leaf(4)), leaf(5)});
  std::vector<int> asked;
  const auto solve = [&](int i) {
    asked.push_back(i);
    return i == 2 ? Membership::In : Membership::Out;
  };
  EXPECT_EQ(traverse(tree, solve, combine, NoSpecial{}, absorbing), Membership::In);
  EXPECT_EQ(asked, (std::vector{0, 2}));
  asked.clear();
  EXPECT_EQ(traverse(tree, solve, combine), Membership::In);
  EXPECT_EQ(asked, (std::vector{0, 1, 2, 3, 4, 5}));
}

// LAW traverse.4: the second run finds the stack it needs.
TEST(Traverse, ReusesItsStack) {
  const Flat flat = flatten(chain(1000, Union, Side::Left, 1), same);
  TraverseScratch<Flat, int> scratch;
  const auto solve = [](int i) { return i; };
  const auto sum = [](int a, BooleanOperator, int b) { return a + b; };
  EXPECT_EQ(traverse(flat, solve, sum, NoSpecial{}, NeverAbsorbs{}, scratch), 1001);
  const auto* memory = scratch.frames().data();
  const auto capacity = scratch.frames().capacity();
  EXPECT_EQ(traverse(flat, solve, sum, NoSpecial{}, NeverAbsorbs{}, scratch), 1001);
  EXPECT_EQ(scratch.frames().data(), memory);
  EXPECT_EQ(scratch.frames().capacity(), capacity);
}

TEST(Traverse, AnExceptionLeavesTheScratchUsable) {
  const Flat flat = flatten(chain(10, Union, Side::Left, 1), same);
  TraverseScratch<Flat, int> scratch;
  const auto sum = [](int a, BooleanOperator, int b) { return a + b; };
  EXPECT_THROW(traverse(
                   flat, [](int) -> int { throw 1; }, sum, NoSpecial{}, NeverAbsorbs{}, scratch),
               int);
  EXPECT_EQ(traverse(flat, same, sum, NoSpecial{}, NeverAbsorbs{}, scratch), 11);
}

// No recursion: n + 1 primitives of value 1 add up to n + 1.
TEST(Traverse, AMillionDeep) {
  constexpr int n = chain_depth;
  const auto sum = [](int a, BooleanOperator, int b) { return a + b; };
  for (const Side side : {Side::Left, Side::Right, Side::Single}) {
    const auto tree = chain(n, Difference, side, 1);
    const int expected = side == Side::Single ? 1 : n + 1;
    EXPECT_EQ(traverse(tree, same, sum), expected);
    EXPECT_EQ(traverse(flatten(tree, same), same, sum), expected);
  }
}

}  // namespace
}  // namespace exactcsg::csg
