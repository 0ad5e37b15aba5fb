// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "csg/chains.hpp"
#include "csg/random_tree.hpp"
#include "exactcsg/csg/prune.hpp"

namespace exactcsg::csg {
namespace {

using test::TestTree;
using Flat = FlatTree<int, BooleanOperator>;
using enum BooleanOperator;
using enum Membership;

// No recursion and no quadratic step, whatever the chain's side and operator. The meaning is that
// of the chain of one primitive with itself: union and intersection give p, difference nothing but
// for the right-hand chain p - (p - (p - ...)), which alternates.
TEST(DeepPrune, AMillionDeepWithEveryOperator) {
  constexpr int n = 1'000'000;
  for (const test::Side side : {test::Side::Left, test::Side::Right, test::Side::Single}) {
    for (const BooleanOperator op : test::all_operators) {
      const TestTree tree = test::chain(n, op, side, 1);
      const Flat flat = flatten(tree, [](int p) { return p; });
      const bool single = side == test::Side::Single;
      for (const Membership known : {In, Out, Unknown}) {
        const auto classify = [known](int) { return known; };
        const TestTree pruned = prune(tree, classify);
        Flat result;
        prune_into(flat, classify, result);
        if (known == Unknown) {
          EXPECT_EQ(pruned.node_count(), single ? 1U : 2U * n + 1U);
          EXPECT_EQ(result.is_primitive(), single);
          continue;
        }
        // n operators on n + 1 operands that are all In.
        const bool in = known == In &&
                        (single || op == Union || op == Intersection ||
                         (n % 2 == 0 && (op == SymmetricDifference || side == test::Side::Right)));
        EXPECT_EQ(pruned.is_full(), in);
        EXPECT_EQ(pruned.is_empty(), !in);
        EXPECT_EQ(result.is_full(), in);
        EXPECT_EQ(result.is_empty(), !in);
      }
    }
  }
}

}  // namespace
}  // namespace exactcsg::csg
