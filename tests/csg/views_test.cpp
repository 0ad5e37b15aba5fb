// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/csg/views.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <random>
#include <string>
#include <utility>

#include "csg/chains.hpp"
#include "csg/random_tree.hpp"
#include "exactcsg/csg/flat_tree.hpp"
#include "exactcsg/csg/prune.hpp"
#include "exactcsg/csg/text.hpp"
#include "exactcsg/csg/traverse.hpp"

namespace exactcsg::csg {
namespace {

using test::all_assignments;
using test::chain;
using test::chain_depth;
using test::combine_texts;
using test::constant_texts;
using test::leaf;
using test::meaning;
using test::name;
using test::random_tree;
using test::same;
using test::Side;
using test::TestTree;
using test::text;
using enum BooleanOperator;

static_assert(ReadableTree<BinaryView<int, BooleanOperator>>);

std::size_t most_operands(const TestTree& tree) {
  if (!tree.is_compose()) return 0;
  std::size_t most = tree.children().size();
  for (const TestTree& child : tree.children()) most = std::max(most, most_operands(child));
  return most;
}

TEST(BinaryView, FoldsFromTheLeft) {
  const TestTree tree = TestTree::compose(
      Difference, {leaf(1), leaf(2), TestTree::compose(Union, {leaf(3)}), TestTree::full()});
  EXPECT_EQ(to_text(BinaryView(tree), text), "(- (- (- 1 2) (+ 3)) full)");
  const TestTree single = leaf(5);
  EXPECT_EQ(to_text(BinaryView(single), text), "5");
}

// LAW view.1
TEST(BinaryView, HasTheSameTraversal) {
  std::mt19937 random(31);
  for (int round = 0; round < 300; ++round) {
    const TestTree tree = random_tree(random, 5, 6);
    const BinaryView view(tree);
    EXPECT_EQ(traverse(view, text, combine_texts, constant_texts),
              traverse(tree, text, combine_texts, constant_texts));
    const TestTree binary = to_tree(view);
    EXPECT_LE(most_operands(binary), 2U);
    EXPECT_EQ(binary.primitive_count(), tree.primitive_count());
    EXPECT_EQ(to_text(binary, text), to_text(view, text));
  }
}

// LAW view.2
TEST(ToTree, IsTheTree) {
  std::mt19937 random(32);
  for (int round = 0; round < 300; ++round) {
    const TestTree tree = random_tree(random, 5, 6);
    EXPECT_EQ(to_tree(tree), tree);
    EXPECT_EQ(to_tree(flatten(tree, same)), tree);
  }
  EXPECT_TRUE(to_tree(FlatTree<int, BooleanOperator>{}).is_empty());
}

TEST(MergeNested, ByHand) {
  const auto merged = [](const TestTree& tree) { return to_text(merge_nested(tree), text); };
  EXPECT_EQ(merged(unite(unite(leaf(1), leaf(2)), unite(leaf(3), leaf(4)))), "(+ 1 2 3 4)");
  EXPECT_EQ(merged(subtract(subtract(leaf(1), leaf(2)), unite(leaf(3), unite(leaf(4), leaf(5))))),
            "(- 1 2 3 4 5)");
  EXPECT_EQ(merged(subtract(leaf(1), subtract(leaf(2), leaf(3)))), "(- 1 (- 2 3))");
  EXPECT_EQ(merged(subtract(unite(leaf(1), leaf(2)), leaf(3))), "(- (+ 1 2) 3)");
}

// LAW view.3
TEST(MergeNested, KeepsTheTruthFunction) {
  std::mt19937 random(33);
  const auto primitives = all_assignments();
  for (int round = 0; round < 1000; ++round) {
    const TestTree tree = random_tree(random, 1 + round % 6, 6);
    const TestTree merged = merge_nested(tree);
    ASSERT_EQ(meaning(merged, primitives), meaning(tree, primitives));
    ASSERT_EQ(merged.primitive_count(), tree.primitive_count());
    ASSERT_LE(merged.node_count(), tree.node_count());
    // LAW view.4
    ASSERT_TRUE(same_handle(merge_nested(merged), merged));
    const TestTree apart = to_tree(tree);
    ASSERT_EQ(merge_nested(to_tree(BinaryView(apart))), merge_nested(apart));
  }
}

// 100 doublings stay 100 nodes.
TEST(MergeNested, LeavesSharedNodesAlone) {
  TestTree tree = leaf(1);
  for (int i = 0; i < 100; ++i) tree = unite(tree, tree);
  const TestTree merged = merge_nested(tree);
  EXPECT_TRUE(same_handle(merged, tree));
}

TEST(Views, AMillionDeep) {
  constexpr int n = chain_depth;
  for (const Side side : {Side::Left, Side::Right}) {
    const auto merged = merge_nested(chain(n, Union, side, 1));
    EXPECT_EQ(merged.children().size(), static_cast<std::size_t>(n + 1));
    const BinaryView view(merged);
    const auto sum = [](int a, BooleanOperator, int b) { return a + b; };
    EXPECT_EQ(traverse(view, same, sum), n + 1);
    EXPECT_TRUE(to_tree(view) == chain(n, Union, Side::Left, 1));
  }
}

// A user's own operators: difference alone, as in the source's section 6.1.
enum class Cut { Difference };
[[maybe_unused]] constexpr Reaction react(Cut, Position position, Constant operand) {
  return csg::react(Difference, position, operand);
}
[[maybe_unused]] constexpr Constant neutral(Cut) { return Constant::Empty; }
[[maybe_unused]] constexpr bool splices(Cut, Position position, Cut) {
  return position == Position::First;
}
static_assert(PrunableOperator<Cut>);

// a u b == Full - ((Full - a) - b) and a n b == a - (Full - b): difference alone makes them all.
using Cuts = Tree<int, Cut>;
Cuts cut(Cuts a, Cuts b) { return Cuts::compose(Cut::Difference, {std::move(a), std::move(b)}); }
Cuts by_cuts(const TestTree& tree) {
  if (tree.is_empty()) return Cuts::empty();
  if (tree.is_full()) return Cuts::full();
  if (tree.is_primitive()) return Cuts::primitive(tree.primitive());
  const auto intersected = [](const Cuts& a, const Cuts& b) {
    return cut(a, cut(Cuts::full(), b));
  };
  const auto united = [](const Cuts& a, const Cuts& b) {
    return cut(Cuts::full(), cut(cut(Cuts::full(), a), b));
  };
  Cuts result = by_cuts(tree.children()[0]);
  for (const TestTree& child : tree.children().subspan(1)) {
    const Cuts next = by_cuts(child);
    switch (tree.operation()) {
      case Union:
        result = united(result, next);
        break;
      case Intersection:
        result = intersected(result, next);
        break;
      case Difference:
        result = cut(result, next);
        break;
      case SymmetricDifference:
        result = united(cut(result, next), cut(next, result));
        break;
    }
  }
  return result;
}
TEST(OwnOperators, DifferenceAloneIsEnough) {
  std::mt19937 random(34);
  const auto primitives = all_assignments();
  const auto combine_bits = [](test::Bits a, Cut, test::Bits b) { return a & ~b; };
  const auto solve = [&](int i) { return primitives[static_cast<std::size_t>(i)]; };
  const FullEmptyResult constants{~test::Bits{0}, test::Bits{0}};
  for (int round = 0; round < 500; ++round) {
    const TestTree tree = random_tree(random, 1 + round % 4, 6);
    const Cuts cuts = by_cuts(tree);
    const auto expected = meaning(tree, primitives);
    ASSERT_EQ(traverse(cuts, solve, combine_bits, constants), expected);
    ASSERT_EQ(traverse(simplify(cuts), solve, combine_bits, constants), expected);
    ASSERT_EQ(traverse(merge_nested(cuts), solve, combine_bits, constants), expected);
    ASSERT_EQ(to_tree(flatten(cuts, same)), cuts);
  }
  EXPECT_EQ(to_text(merge_nested(by_cuts(unite(leaf(1), leaf(2)))), text, [](Cut) { return '-'; }),
            "(- full (- full 1 2))");
}

}  // namespace
}  // namespace exactcsg::csg
