// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/csg/attributed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "csg/chains.hpp"
#include "csg/random_tree.hpp"
#include "exactcsg/csg/flat_tree.hpp"
#include "exactcsg/csg/prune.hpp"
#include "exactcsg/csg/text.hpp"

namespace exactcsg::csg {
namespace {

using test::below;
using test::chain;
using test::chain_depth;
using test::combine_texts;
using test::constant_texts;
using test::constants;
using test::leaf;
using test::name;
using test::random_tree;
using test::Side;
using test::TestTree;
using test::text;
using enum BooleanOperator;

// The least that may have an attribute: copyable.
struct MinimalPrimitive {
  int* value;
};
enum class MinimalOperator { Only };
static_assert(ReadableTree<AttributedTree<MinimalPrimitive, MinimalOperator, std::string>>);
static_assert(PrunableOperator<Attributed<BooleanOperator, std::string>>);
static_assert(!PrunableOperator<Attributed<MinimalOperator, std::string>>);
static_assert(std::convertible_to<Attributed<int, std::string>, int>);

// LAW attribute.1: against traverse of every subtree.
void expect_attributes_of_subtrees(const AttributedTree<int, BooleanOperator, std::string>& tree) {
  if (tree.is_empty() || tree.is_full()) return;
  ASSERT_EQ(attribute_of(tree),
            traverse(without_attributes(tree), text, combine_texts, constant_texts));
  if (!tree.is_compose()) return;
  for (const auto& child : tree.children()) expect_attributes_of_subtrees(child);
}
TEST(Attributed, IsTheTraversalOfEverySubtree) {
  std::mt19937 random(11);
  for (int round = 0; round < 200; ++round) {
    const TestTree tree = random_tree(random, 5, 6);
    const auto attributed = attribute(tree, text, combine_texts, constant_texts);
    expect_attributes_of_subtrees(attributed);
    EXPECT_EQ(without_attributes(attributed), tree);
    EXPECT_EQ(attributed.node_count(), tree.node_count());
  }
}

TEST(Attributed, NeedsTheSpecialResultsThatOccur) {
  const auto attribute_with = [](const TestTree& tree, auto special) {
    return attribute(tree, text, combine_texts, special);
  };
  EXPECT_THROW(attribute_with(complement(leaf(1)), NoSpecial{}), Error);
  EXPECT_EQ(attribute_of(attribute_with(complement(leaf(1)), FullResult{std::string("all")})),
            "(all - 1)");
  EXPECT_TRUE(attribute_with(TestTree::full(), NoSpecial{}).is_full());
}

// LAW attribute.2: 100 doublings; the number of primitives is 2^100 modulo 2^64, which is 0.
TEST(Attributed, KeepsSharing) {
  TestTree tree = leaf(1);
  for (int i = 0; i < 100; ++i) tree = unite(tree, tree);
  int solved = 0;
  int combined = 0;
  const auto attributed = attribute(
      tree,
      [&](int) {
        ++solved;
        return std::uint64_t{1};
      },
      [&](std::uint64_t a, BooleanOperator, std::uint64_t b) {
        ++combined;
        return a + b;
      });
  EXPECT_EQ(solved, 1);
  EXPECT_EQ(combined, 100);
  EXPECT_EQ(attribute_of(attributed), 0U);
  EXPECT_TRUE(same_handle(attributed.children()[0], attributed.children()[1]));
  EXPECT_EQ(without_attributes(attributed), tree);
  try {
    inherit(attributed, std::uint64_t{0}, [](auto&&...) { return std::uint64_t{0}; });
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.id(), ErrorId::TooLarge);
  }
}

// LAW attribute.3, and functions of P and O serve as they are.
TEST(Attributed, IsUsedLikeTheTreeWithout) {
  std::mt19937 random(12);
  const auto parity = [](int i) { return i % 2 == 0 ? Membership::In : Membership::Out; };
  const auto half_known = [](int i) { return i < 3 ? Membership::Unknown : Membership::In; };
  for (int round = 0; round < 300; ++round) {
    const TestTree tree = random_tree(random, 5, 6);
    const auto attributed = attribute(tree, text, combine_texts, constant_texts);
    EXPECT_EQ(traverse(attributed, parity, combine, constants, absorbs),
              traverse(tree, parity, combine, constants, absorbs));
    EXPECT_EQ(to_text(attributed, text), to_text(tree, text));
    EXPECT_EQ(without_attributes(prune(attributed, half_known)), prune(tree, half_known));
    EXPECT_EQ(without_attributes(simplify(attributed)), simplify(tree));
    const auto flat = flatten(attributed, [](int i) { return i; });
    EXPECT_EQ(traverse(flat, parity, combine, constants),
              traverse(tree, parity, combine, constants));
  }
}

TEST(Attributed, EqualityLooksAtTheAttributes) {
  using T = AttributedTree<int, BooleanOperator, std::string>;
  const T hole = T::primitive({1, "hole"});
  EXPECT_EQ(hole, T::primitive({1, "hole"}));
  EXPECT_NE(hole, T::primitive({1, "boss"}));
  EXPECT_NE(T::compose({Union, "a"}, {hole, hole}), T::compose({Union, "b"}, {hole, hole}));
}

// Closed intervals [from, to] of integers; empty if from > to.
struct Interval {
  int from, to;
  bool contains(int x) const { return from <= x && x <= to; }
  friend bool operator==(const Interval&, const Interval&) = default;
};
constexpr Interval nothing{1, 0};
constexpr Interval everything{-1000, 1000};
Interval hull(const Interval& a, const Interval& b) {
  if (a.from > a.to) return b;
  if (b.from > b.to) return a;
  return {std::min(a.from, b.from), std::max(a.to, b.to)};
}
Interval meet(const Interval& a, const Interval& b) {
  return {std::max(a.from, b.from), std::min(a.to, b.to)};
}
Interval bound(const Interval& a, BooleanOperator op, const Interval& b) {
  switch (op) {
    case Union:
    case SymmetricDifference:
      return hull(a, b);
    case Intersection:
      return meet(a, b);
    case Difference:
      break;
  }
  return a;
}
using Solid = Tree<Interval, BooleanOperator>;
using BoxedSolid = AttributedTree<Interval, BooleanOperator, Interval>;
Solid random_solid(std::mt19937& random) {
  return map(random_tree(random, 5, 40), [&](int i) { return Interval{i, i + i % 7}; });
}
BoxedSolid boxed(const Solid& solid) {
  return attribute(
      solid, [](const Interval& i) { return i; }, bound, FullEmptyResult{everything, nothing});
}
constexpr auto inside = [](const Interval& i, int x) {
  return i.contains(x) ? Membership::In : Membership::Out;
};
constexpr auto outside_box = [](const Interval& box, int x) {
  return box.contains(x) ? std::nullopt : std::optional(Membership::Out);
};

// LAW traverse.4: bounding boxes.
TEST(CutOff, DoesNotChangeTheClassOfAPoint) {
  std::mt19937 random(13);
  for (int round = 0; round < 300; ++round) {
    const Solid solid = random_solid(random);
    const BoxedSolid boxes = boxed(solid);
    for (int x = -1; x < 48; ++x) {
      const Membership expected = traverse(solid, x, inside, combine, constants);
      ASSERT_EQ(traverse(boxes, x, CutOff{inside, outside_box}, combine, constants), expected);
      ASSERT_EQ(traverse(boxes, x, CutOff{inside, outside_box}, combine, constants, absorbs),
                expected);
    }
  }
}

// In a balanced union of 2^10 disjoint intervals one path leads to a point: one primitive is asked,
// and the boxes of two children at each of ten levels and of the root.
TEST(CutOff, SparesWhatIsElsewhere) {
  std::vector<Solid> level;
  for (int i = 0; i < 1024; ++i) level.push_back(Solid::primitive({2 * i, 2 * i}));
  while (level.size() > 1) {
    std::vector<Solid> above;
    for (std::size_t i = 0; i < level.size(); i += 2)
      above.push_back(unite(level[i], level[i + 1]));
    level = std::move(above);
  }
  const BoxedSolid boxes = boxed(level[0]);
  for (const int x : {0, 2 * 700, 2 * 1023}) {
    int primitives = 0;
    int attributes = 0;
    const auto solve = [&](const Interval& i, int query) {
      ++primitives;
      return inside(i, query);
    };
    const auto decide = [&](const Interval& box, int query) {
      ++attributes;
      return outside_box(box, query);
    };
    EXPECT_EQ(traverse(boxes, x, CutOff{solve, decide}, combine), Membership::In);
    EXPECT_EQ(primitives, 1);
    EXPECT_EQ(attributes, 21);
  }
}

// LAW prune.6 by LAW prune.1: in the region the pruned solid has the same points.
TEST(CutOff, PrunesBySubtrees) {
  std::mt19937 random(14);
  int spared = 0;
  for (int round = 0; round < 500; ++round) {
    const Solid solid = random_solid(random);
    const int from = static_cast<int>(below(random, 40));
    const Interval region{from, from + static_cast<int>(below(random, 8))};
    int asked = 0;
    const auto classify = [&](const Interval& i) {
      ++asked;
      const Interval common = meet(i, region);
      if (common.from > common.to) return Membership::Out;
      return common == region ? Membership::In : Membership::Unknown;
    };
    const auto disjoint = [&](const Interval& box) {
      const Interval common = meet(box, region);
      return common.from > common.to ? Membership::Out : Membership::Unknown;
    };
    const auto plain = prune(solid, classify);
    const int asked_without = std::exchange(asked, 0);
    const BoxedSolid pruned = prune(boxed(solid), CutOff{classify, disjoint});
    spared += asked_without - asked;
    EXPECT_LE(pruned.node_count(), plain.node_count());
    for (int x = region.from; x <= region.to; ++x) {
      ASSERT_EQ(traverse(pruned, x, inside, combine, constants),
                traverse(solid, x, inside, combine, constants));
    }
  }
  EXPECT_GT(spared, 1000);
}

// LAW inherit.1: levels, children and operators by hand.
TEST(Inherit, GivesChildrenWhatTheirParentHas) {
  const auto tree = attribute(
      TestTree::compose(Difference, {leaf(1), TestTree::full(), unite(leaf(2), leaf(3))}),
      [](int) { return std::string(); },
      [](std::string a, BooleanOperator, const std::string&) { return a; },
      FullEmptyResult{std::string(), std::string()});
  struct Descend {
    std::string operator()(const std::string& root, const std::string&) const { return root; }
    std::string operator()(const std::string& parent, BooleanOperator op, std::size_t index,
                           const std::string&) const {
      return parent + "/" + name(op) + std::to_string(index);
    }
  };
  const auto inherited = inherit(tree, std::string("root"), Descend{});
  EXPECT_EQ(attribute_of(inherited), "root");
  EXPECT_EQ(attribute_of(inherited.children()[0]), "root/-0");
  EXPECT_TRUE(inherited.children()[1].is_full());
  EXPECT_EQ(attribute_of(inherited.children()[2]), "root/-2");
  EXPECT_EQ(attribute_of(inherited.children()[2].children()[1]), "root/-2/+1");
  EXPECT_EQ(without_attributes(inherited), without_attributes(tree));
}

// Cameron: a child of an intersection matters only within the boxes of all of them.
TEST(Inherit, NarrowsBoxesDownwards) {
  struct Narrow {
    Interval operator()(const Interval& root, const Interval& own) const { return meet(root, own); }
    Interval operator()(const Interval& parent, BooleanOperator, std::size_t,
                        const Interval& own) const {
      return meet(parent, own);
    }
  };
  std::mt19937 random(15);
  for (int round = 0; round < 300; ++round) {
    const Solid solid = random_solid(random);
    const BoxedSolid narrowed = inherit(boxed(solid), everything, Narrow{});
    for (int x = -1; x < 48; ++x) {
      ASSERT_EQ(traverse(narrowed, x, CutOff{inside, outside_box}, combine, constants),
                traverse(solid, x, inside, combine, constants));
    }
  }
}

// LAW tree.1 for attributed trees.
TEST(Attributed, AMillionDeep) {
  constexpr int n = chain_depth;
  const auto size = [](int) { return std::uint64_t{1}; };
  const auto sum = [](std::uint64_t a, BooleanOperator, std::uint64_t b) { return a + b; };
  const auto level = [](std::uint64_t above, auto&&...) { return above + 1; };
  for (const Side side : {Side::Left, Side::Right}) {
    const auto tree = chain(n, Union, side, 1);
    const auto attributed = attribute(tree, size, sum);
    EXPECT_EQ(attribute_of(attributed), tree.primitive_count());
    EXPECT_EQ(traverse(attributed, size, sum), tree.primitive_count());
    EXPECT_EQ(map(attributed, [](int i) { return i; }).node_count(), tree.node_count());
    EXPECT_EQ(without_attributes(simplify(attributed)), simplify(tree));
    EXPECT_TRUE(attributed == attribute(tree, size, sum));
    EXPECT_TRUE(without_attributes(attributed) == tree);
    std::uint64_t deepest = 0;
    for_each_primitive(inherit(attributed, std::uint64_t{0}, level), [&](const auto& primitive) {
      deepest = std::max(deepest, primitive.attribute);
    });
    EXPECT_EQ(deepest, static_cast<std::uint64_t>(n + 1));
  }
}

}  // namespace
}  // namespace exactcsg::csg
