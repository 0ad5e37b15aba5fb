// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/csg/maintained_traverse.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <vector>

#include "csg/random_tree.hpp"

namespace exactcsg::csg {
namespace {

using test::absorbing;
using test::constants;

constexpr std::uint32_t primitives = 7;
constexpr auto combining = [](Membership a, BooleanOperator op, Membership b) {
  return combine(a, op, b);
};

using Number = std::uint32_t;

template <class Absorbs>
auto maintained(Absorbs absorbs) {
  return MaintainedTraverse<Number, BooleanOperator, Membership, decltype(combining), Absorbs>(
      primitives, combining, absorbs, constants);
}

// LAW maintained.1, the traverse being the independent way: with primitives that occur several
// times, Empty and Full leaves, and one object for many trees.
TEST(MaintainedTraverse, EqualsTraverseAfterEveryChange) {
  std::mt19937 random(20);
  auto maintained_value = maintained(absorbing);
  for (int round = 0; round < 300; ++round) {
    const auto tree = flatten(test::random_tree(random, 5, primitives),
                              [](int i) { return static_cast<Number>(i); });
    std::vector<Membership> result(primitives, Membership::Unknown);
    maintained_value.assign(tree, Membership::Unknown);
    for (int change = 0; change < 40; ++change) {
      const auto expected = traverse(
          tree, [&](Number i) { return result[i]; }, combining, constants);
      ASSERT_EQ(maintained_value.value(), expected);
      const Number primitive = test::below(random, primitives);
      result[primitive] = static_cast<Membership>(test::below(random, 3));
      maintained_value.change(primitive, result[primitive]);
    }
  }
}

// A result that does not change is not handed on: in a chain of differences whose innermost operand
// changes without effect, one node is combined, not all.
TEST(MaintainedTraverse, StopsWhereNothingChanges) {
  int combined = 0;
  const auto counting = [&](Membership a, BooleanOperator op, Membership b) {
    ++combined;
    return combine(a, op, b);
  };
  const auto never = [](Membership, BooleanOperator) { return false; };
  MaintainedTraverse<Number, BooleanOperator, Membership, decltype(counting), decltype(never)>
      value(3, counting, never, constants);
  auto tree = Tree<Number, BooleanOperator>::primitive(0);
  tree = intersect(tree, Tree<Number, BooleanOperator>::primitive(1));
  for (int i = 0; i < 1000; ++i) {
    tree = subtract(Tree<Number, BooleanOperator>::primitive(2), tree);
  }
  value.assign(flatten(tree, [](Number i) { return i; }), Membership::Out);
  value.change(2, Membership::In);
  combined = 0;
  value.change(0, Membership::In);  // 0 and 1 is still Out
  EXPECT_EQ(combined, 1);
}

}  // namespace
}  // namespace exactcsg::csg
