// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "csg/random_tree.hpp"
#include "exactcsg/csg/flat_tree.hpp"
#include "exactcsg/csg/prune.hpp"
#include "exactcsg/csg/traverse.hpp"

namespace exactcsg::csg {
namespace {

using test::all_assignments;
using test::below;
using test::Bits;
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

}  // namespace
}  // namespace exactcsg::csg
