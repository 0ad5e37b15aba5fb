// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "csg/chains.hpp"
#include "csg/random_tree.hpp"
#include "exactcsg/csg/flat_tree.hpp"
#include "exactcsg/csg/prune.hpp"
#include "exactcsg/csg/traverse.hpp"

namespace exactcsg::csg {
namespace {

using test::all_assignments;
using test::below;
using test::Bits;
using test::leaf;
using test::meaning;
using test::random_tree;
using test::TestTree;
using Flat = FlatTree<int, BooleanOperator>;
using enum BooleanOperator;
using enum Membership;

TestTree unflatten(Flat::Cursor node) {
  switch (node.kind()) {
    case NodeKind::Empty:
      return TestTree::empty();
    case NodeKind::Full:
      return TestTree::full();
    case NodeKind::Primitive:
      return TestTree::primitive(node.primitive());
    case NodeKind::Compose:
      break;
  }
  std::vector<TestTree> children;
  for (auto c = node.first_child(); !(c == node.children_end()); c = c.next_sibling()) {
    children.push_back(unflatten(c));
  }
  return TestTree::compose(node.operation(), std::move(children));
}

// LAW prune.3, told node by node.
void expect_normal(const TestTree& tree, bool is_root = true) {
  EXPECT_TRUE(is_root || !tree.is_empty());
  if (!tree.is_compose()) return;
  EXPECT_GE(tree.children().size(), 2U);
  for (std::size_t i = 0; i < tree.children().size(); ++i) {
    const TestTree& child = tree.children()[i];
    const bool allowed =
        (tree.operation() == Difference && i == 0) ||
        (tree.operation() == SymmetricDifference && i + 1 == tree.children().size());
    EXPECT_TRUE(allowed || !child.is_full());
    expect_normal(child, false);
  }
}

struct Classification {
  std::vector<Membership> of;
  Membership operator()(int primitive) const { return of[static_cast<std::size_t>(primitive)]; }
  // The assignments that agree with it.
  Bits consistent() const {
    const auto primitives = all_assignments();
    Bits bits = ~Bits{0};
    for (std::size_t i = 0; i < of.size(); ++i) {
      if (of[i] == In) bits &= primitives[i];
      if (of[i] == Out) bits &= ~primitives[i];
    }
    return bits;
  }
};

Classification random_classification(std::mt19937& random) {
  Classification result;
  for (int i = 0; i < 6; ++i) {
    const auto choice = below(random, 5);
    result.of.push_back(choice == 0 ? Out : choice == 1 ? In : Unknown);
  }
  return result;
}

// The meaning of a tree of six primitives is its column of 64 truth values, by bit operations.
TEST(Prune, AgreesWithTruthTablesOnRandomTrees) {
  std::mt19937 random(20240);
  const auto assignments = all_assignments();
  Flat flat_result;
  PruneScratch<Flat> scratch;
  for (int round = 0; round < 20000; ++round) {
    SCOPED_TRACE(round);
    const TestTree tree = random_tree(random, 1 + round % 6, 6);
    const Classification classify = random_classification(random);
    const Bits consistent = classify.consistent();
    const Bits expected = meaning(tree, assignments) & consistent;

    const TestTree pruned = prune(tree, classify);
    ASSERT_EQ(meaning(pruned, assignments) & consistent, expected) << "LAW prune.1";
    expect_normal(pruned);
    EXPECT_TRUE(same_handle(prune(pruned, classify), pruned)) << "LAW prune.2 and prune.4";

    const Flat flat = flatten(tree, [](int p) { return p; });
    ASSERT_EQ(unflatten(flat.root()), tree) << "LAW flat.1";
    prune_into(flat, classify, flat_result, scratch);
    const TestTree flat_pruned = unflatten(flat_result.root());
    ASSERT_EQ(meaning(flat_pruned, assignments) & consistent, expected) << "LAW prune.1, flat";
    expect_normal(flat_pruned);
    Flat again;
    prune_into(flat_result, classify, again);
    EXPECT_LE(again.node_count(), flat_result.node_count()) << "LAW prune.4, flat";
    for_each_primitive(flat_result, [&](int p) { EXPECT_EQ(classify(p), Unknown); });
    if (HasFailure()) return;
  }
}

Flat flat_of(const TestTree& tree) {
  return flatten(tree, [](int p) { return p; });
}
// What becomes of an operator with an operand 0 that is In or Out: set algebra, by hand.
TEST(Prune, SimplifiesByTheLawsOfSets) {
  const TestTree full = TestTree::full();
  const TestTree empty = TestTree::empty();
  const TestTree a = leaf(1);
  struct Row {
    BooleanOperator operation;
    bool constant_first;
    TestTree if_out;
    TestTree if_in;
  };
  const Row rows[] = {
      {Union, true, a, full},
      {Union, false, a, full},
      {Intersection, true, empty, a},
      {Intersection, false, empty, a},
      {Difference, true, empty, complement(a)},
      {Difference, false, a, empty},
      {SymmetricDifference, true, a, symmetric_difference(a, full)},
      {SymmetricDifference, false, a, symmetric_difference(a, full)},
  };
  for (const Row& row : rows) {
    const TestTree tree = TestTree::compose(
        row.operation, row.constant_first ? std::vector{leaf(0), a} : std::vector{a, leaf(0)});
    for (const Membership known : {Out, In}) {
      const TestTree& expected = known == In ? row.if_in : row.if_out;
      const auto classify = [known](int i) { return i == 0 ? known : Unknown; };
      EXPECT_EQ(prune(tree, classify), expected);
      Flat result;
      prune_into(flat_of(tree), classify, result);
      EXPECT_EQ(unflatten(result.root()), expected);
    }
  }
}

TEST(Prune, DoubleComplementsOfSymmetricDifferencesCancel) {
  const TestTree tree = TestTree::compose(SymmetricDifference, {leaf(0), leaf(1), leaf(0)});
  const auto classify = [](int i) { return i == 0 ? In : Unknown; };
  EXPECT_EQ(prune(tree, classify), leaf(1));
  const TestTree nothing = TestTree::compose(SymmetricDifference, {leaf(0), leaf(0), leaf(0)});
  EXPECT_TRUE(prune(nothing, classify).is_full());
}

// LAW prune.2
TEST(Prune, HandsBackTheSameHandle) {
  const TestTree kept = subtract(leaf(1), leaf(2));
  const TestTree tree = unite(kept, intersect(leaf(3), leaf(4)));
  const auto unknown = [](int) { return Unknown; };
  EXPECT_TRUE(same_handle(prune(tree, unknown), tree));
  const TestTree pruned = prune(tree, [](int i) { return i == 4 ? In : Unknown; });
  EXPECT_EQ(pruned, unite(kept, leaf(3)));
  EXPECT_TRUE(same_handle(pruned.children()[0], kept));
  for (const TestTree& one : {TestTree::empty(), TestTree::full(), leaf(1)}) {
    EXPECT_TRUE(same_handle(prune(one, unknown), one));
  }
}

// LAW prune.5: one Union and one Difference are left, by a u (b u c), (a - b) - c, a - (b u c).
TEST(PruneInto, MergesNestedOperators) {
  const auto unknown = [](int) { return Unknown; };
  Flat result;
  prune_into(flat_of(unite(leaf(1), unite(unite(leaf(2), leaf(3)), leaf(4)))), unknown, result);
  EXPECT_EQ(unflatten(result.root()),
            TestTree::compose(Union, {leaf(1), leaf(2), leaf(3), leaf(4)}));
  prune_into(flat_of(subtract(subtract(leaf(1), leaf(2)), unite(leaf(3), leaf(4)))), unknown,
             result);
  EXPECT_EQ(unflatten(result.root()),
            TestTree::compose(Difference, {leaf(1), leaf(2), leaf(3), leaf(4)}));
}

// "Operands that cannot matter any more are not classified."
TEST(Prune, DoesNotAskWhatIsDecided) {
  std::vector<int> asked;
  const auto classify = [&](int i) {
    asked.push_back(i);
    return i == 1 ? In : Unknown;
  };
  EXPECT_TRUE(prune(TestTree::compose(Union, {leaf(0), leaf(1), leaf(2)}), classify).is_full());
  EXPECT_EQ(asked, (std::vector{0, 1}));
}

// A tree of 2^100 occurrences and 101 nodes.
TEST(Prune, WorksOnceOnSharedNodes) {
  TestTree tree = unite(leaf(0), leaf(1));
  for (int i = 0; i < 100; ++i) tree = intersect(tree, tree);
  const TestTree pruned = prune(tree, [](int i) { return i == 0 ? Out : Unknown; });
  EXPECT_EQ(pruned.node_count(), ~std::uint64_t{0});
  EXPECT_TRUE(same_handle(pruned.children()[0], pruned.children()[1]));
  EXPECT_TRUE(prune(tree, [](int) { return In; }).is_full());
}

// REQUIRES of prune_into: capacity, not more.
TEST(PruneInto, AllocatesNothingWhenTheCapacitySuffices) {
  const Flat source = flat_of(test::chain(500, Union, test::Side::Left, 1));
  Flat result;
  result.reserve(source.node_count());
  const auto capacity = result.capacity();
  PruneScratch<Flat> scratch;
  prune_into(
      source, [](int) { return Unknown; }, result, scratch);
  const auto* frames = scratch.frames().data();
  const auto frames_capacity = scratch.frames().capacity();
  for (const Membership m : {In, Out, Unknown}) {
    prune_into(
        source, [m](int) { return m; }, result, scratch);
  }
  EXPECT_EQ(result.capacity(), capacity);
  EXPECT_EQ(scratch.frames().data(), frames);
  EXPECT_EQ(scratch.frames().capacity(), frames_capacity);
}

TEST(PruneInto, TakesATreeOfHandlesAsWell) {
  const TestTree tree = unite(leaf(0), subtract(leaf(1), leaf(2)));
  Flat result;
  prune_into(
      tree, [](int i) { return i == 0 ? Out : Unknown; }, result);
  EXPECT_EQ(unflatten(result.root()), subtract(leaf(1), leaf(2)));
}

TEST(Prune, AnExceptionOfClassifyComesOut) {
  Flat result;
  PruneScratch<Flat> scratch;
  const TestTree tree = unite(leaf(0), leaf(1));
  const auto classify = [](int i) -> Membership {
    if (i == 1) throw 7;
    return Unknown;
  };
  EXPECT_THROW(prune(tree, classify), int);
  EXPECT_THROW(prune_into(flat_of(tree), classify, result, scratch), int);
  prune_into(
      flat_of(tree), [](int) { return In; }, result, scratch);
  EXPECT_TRUE(result.is_full());
}

// No recursion and no quadratic step (tests/csg/slow has all operators).
TEST(Prune, AMillionDeep) {
  for (const test::Side side : {test::Side::Left, test::Side::Right}) {
    const TestTree tree = test::chain(test::chain_depth, Difference, side, 1);
    const auto unknown = [](int) { return Unknown; };
    EXPECT_TRUE(same_handle(prune(tree, unknown), tree));
    Flat result;
    prune_into(flat_of(tree), unknown, result);
    EXPECT_EQ(result.root().operation(), Difference);
    prune_into(
        flat_of(tree), [](int) { return Out; }, result);
    EXPECT_TRUE(result.is_empty());
  }
}

// A chain whose operators all vanish but the primitive at the bottom stays (collapse at each
// level).
TEST(Prune, AMillionCollapsingOperators) {
  TestTree tree = leaf(1);
  for (int i = 0; i < test::chain_depth; ++i) {
    tree = i % 2 == 0 ? intersect(leaf(0), std::move(tree)) : subtract(std::move(tree), leaf(2));
  }
  const auto classify = [](int i) { return i == 0 ? In : i == 1 ? Unknown : Out; };
  EXPECT_EQ(prune(tree, classify), leaf(1));
  Flat result;
  prune_into(flat_of(tree), classify, result);
  EXPECT_TRUE(result.is_primitive());
}

// Another operator type, with one operator "all but" that is Difference by another name.
enum class Cut { Minus };
constexpr Reaction react(Cut, Position position, Constant constant) {
  return react(Difference, position, constant);
}
constexpr Constant neutral(Cut) { return Constant::Empty; }
constexpr bool splices(Cut, Position position, Cut) { return position == Position::First; }
static_assert(PrunableOperator<Cut> && PrunableOperator<BooleanOperator>);
static_assert(!PrunableOperator<int>);

TEST(Prune, WorksForOtherOperators) {
  using T = Tree<int, Cut>;
  const T tree = T::compose(Cut::Minus, {T::primitive(1), T::primitive(0)});
  EXPECT_EQ(prune(tree, [](int i) { return i == 0 ? Out : Unknown; }), T::primitive(1));
  EXPECT_TRUE(prune(tree, [](int i) { return i == 0 ? In : Unknown; }).is_empty());
}

}  // namespace
}  // namespace exactcsg::csg
