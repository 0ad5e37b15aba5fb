// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/csg/tree.hpp"

#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "csg/chains.hpp"
#include "csg/random_tree.hpp"
#include "exactcsg/csg/flat_tree.hpp"
#include "exactcsg/csg/text.hpp"

namespace exactcsg::csg {
namespace {

using test::chain;
using test::chain_depth;
using test::leaf;
using test::Side;
using test::TestTree;
using enum BooleanOperator;

// Both memory layouts model the concept that the algorithms are written against.
static_assert(ReadableTree<TestTree>);
static_assert(ReadableTree<FlatTree<std::uint32_t, BooleanOperator>>);
static_assert(std::is_nothrow_move_constructible_v<TestTree>);
static_assert(sizeof(TestTree) == sizeof(void*));

// The least that may be a primitive and an operator of a tree: movable, nothing else.
struct MinimalPrimitive {
  explicit MinimalPrimitive(std::unique_ptr<int> v) : value(std::move(v)) {}
  std::unique_ptr<int> value;
};
enum class MinimalOperator { Only };
static_assert(ReadableTree<Tree<MinimalPrimitive, MinimalOperator>>);

TEST(Tree, KindsAreWhatTheFactoriesSay) {
  EXPECT_TRUE(TestTree().is_empty());
  EXPECT_TRUE(TestTree::empty().is_empty());
  EXPECT_TRUE(TestTree::full().is_full());
  EXPECT_EQ(leaf(3).primitive(), 3);
  const TestTree both = TestTree::compose(Difference, {leaf(1), leaf(2), TestTree::full()});
  ASSERT_TRUE(both.is_compose());
  EXPECT_EQ(both.operation(), Difference);
  ASSERT_EQ(both.children().size(), 3U);
  EXPECT_EQ(both.children()[1].primitive(), 2);
  EXPECT_TRUE(both.children()[2].is_full());
  EXPECT_EQ(both.node_count(), 4U);
  EXPECT_EQ(both.primitive_count(), 2U);
}

TEST(Tree, TheNamedOperatorsAreTheirOperators) {
  EXPECT_EQ(unite(leaf(1), leaf(2)), TestTree::compose(Union, {leaf(1), leaf(2)}));
  EXPECT_EQ(intersect(leaf(1), leaf(2)), TestTree::compose(Intersection, {leaf(1), leaf(2)}));
  EXPECT_EQ(subtract(leaf(1), leaf(2)), TestTree::compose(Difference, {leaf(1), leaf(2)}));
  EXPECT_EQ(symmetric_difference(leaf(1), leaf(2)),
            TestTree::compose(SymmetricDifference, {leaf(1), leaf(2)}));
  EXPECT_EQ(complement(leaf(1)), TestTree::compose(Difference, {TestTree::full(), leaf(1)}));
}

TEST(Tree, AnOperatorNeedsOperands) {
  try {
    TestTree::compose(Union, {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.id(), ErrorId::BadArgument);
  }
}

TEST(Tree, MoveOnlyPrimitives) {
  using T = Tree<MinimalPrimitive, MinimalOperator>;
  T tree = T::primitive(MinimalPrimitive(std::make_unique<int>(7)));
  tree = T::compose(MinimalOperator::Only, {tree, tree, T::full()});
  EXPECT_EQ(*tree.children()[1].primitive().value, 7);
  int sum = 0;
  for_each_primitive(tree, [&](const MinimalPrimitive& p) { sum += *p.value; });
  EXPECT_EQ(sum, 14);
}

// LAW tree.2
TEST(Tree, CopiesShareTheNode) {
  const TestTree a = leaf(1);
  const TestTree b = a;
  EXPECT_TRUE(same_handle(a, b));
  EXPECT_EQ(a.identity(), b.identity());
  EXPECT_FALSE(same_handle(a, leaf(1)));
  EXPECT_EQ(a, leaf(1));
  TestTree c = a;
  TestTree d = std::move(c);
  EXPECT_TRUE(same_handle(a, d));
  const TestTree& alias = d;
  d = alias;  // self-assignment keeps the node
  EXPECT_TRUE(same_handle(a, d));
}

TEST(Tree, EqualityLooksAtEverything) {
  const TestTree a = TestTree::compose(Union, {leaf(1), TestTree::full(), leaf(2)});
  EXPECT_EQ(a, TestTree::compose(Union, {leaf(1), TestTree::full(), leaf(2)}));
  EXPECT_NE(a, TestTree::compose(Intersection, {leaf(1), TestTree::full(), leaf(2)}));
  EXPECT_NE(a, TestTree::compose(Union, {leaf(1), TestTree::empty(), leaf(2)}));
  EXPECT_NE(a, TestTree::compose(Union, {leaf(1), TestTree::full(), leaf(3)}));
  EXPECT_NE(a, TestTree::compose(Union, {leaf(1), TestTree::full()}));
  EXPECT_NE(TestTree::full(), TestTree::empty());
}

// LAW tree.3: every primitive dies exactly once, with the last handle.
TEST(Tree, NodesDieWithTheirLastHandle) {
  const auto counter = std::make_shared<int>();
  using T = BooleanTree<std::shared_ptr<int>>;
  T inner = T::primitive(counter);
  EXPECT_EQ(counter.use_count(), 2);
  T outer = unite(inner, subtract(T::primitive(counter), inner));
  EXPECT_EQ(counter.use_count(), 3);
  outer = T::full();
  EXPECT_EQ(counter.use_count(), 2);
  inner = inner.is_primitive() ? T::empty() : inner;
  EXPECT_EQ(counter.use_count(), 1);
}

// LAW tree.1
TEST(Tree, AMillionDeepIsBuiltCopiedComparedMappedAndDestroyed) {
  constexpr int n = chain_depth;
  for (const Side side : {Side::Left, Side::Right, Side::Single}) {
    const auto counter = std::make_shared<int>();
    {
      const auto tree = chain(n, Union, side, counter);
      const auto primitives = side == Side::Single ? 1 : n + 1;
      EXPECT_EQ(tree.primitive_count(), static_cast<std::uint64_t>(primitives));
      EXPECT_EQ(counter.use_count(), primitives + 1);
      const auto copy = tree;
      EXPECT_TRUE(tree == copy);
      EXPECT_TRUE(tree == chain(n, Union, side, counter));
      EXPECT_FALSE(tree == chain(n - 1, Union, side, counter));
      int visited = 0;
      for_each_primitive(tree, [&](const auto&) { ++visited; });
      EXPECT_EQ(visited, primitives);
      EXPECT_EQ(map(tree, [](const auto&) { return 1; }).node_count(), tree.node_count());
      const auto flat = flatten(tree, [](const auto&) { return 1U; });
      EXPECT_EQ(flat.node_count(), tree.node_count());
      EXPECT_FALSE(to_text(tree, [](const auto&) { return "p"; }).empty());
    }
    EXPECT_EQ(counter.use_count(), 1);
  }
}

// LAW tree.1 for a node with a million children.
TEST(Tree, AMillionWide) {
  std::vector<TestTree> children(1'000'000, leaf(1));
  const TestTree tree = TestTree::compose(Union, std::move(children));
  EXPECT_EQ(tree.node_count(), 1'000'001U);
  EXPECT_EQ(flatten(tree, [](int i) { return i; }).node_count(), 1'000'001U);
}

// LAW map.1: 100 doublings stand for 2^100 leaves and are mapped in 101 calls at most.
TEST(Tree, MapKeepsSharing) {
  TestTree tree = leaf(1);
  for (int i = 0; i < 100; ++i) tree = unite(tree, tree);
  EXPECT_EQ(tree.primitive_count(), ~std::uint64_t{0});
  EXPECT_EQ(tree.node_count(), ~std::uint64_t{0});
  int calls = 0;
  const auto mapped = map(tree, [&](int i) {
    ++calls;
    return std::to_string(i);
  });
  EXPECT_EQ(calls, 1);
  EXPECT_TRUE(same_handle(mapped.children()[0], mapped.children()[1]));
  EXPECT_EQ(mapped.primitive_count(), ~std::uint64_t{0});
  EXPECT_THROW(flatten(tree, [](int i) { return i; }), Error);
  TestTree first = tree;
  TestTree second = tree;
  EXPECT_EQ(first, second);
}

// LAW map.2, and that the result is what plain recursion makes.
std::string spelled(const Tree<std::string, std::string>& tree) {
  if (tree.is_primitive()) return tree.primitive();
  if (!tree.is_compose()) return tree.is_full() ? "full" : "empty";
  std::string text = tree.operation() + "(";
  for (const auto& child : tree.children()) text += spelled(child) + ",";
  return text + ")";
}
TEST(Tree, MapChangesPrimitivesAndOperators) {
  std::mt19937 random(5);
  for (int round = 0; round < 100; ++round) {
    const TestTree tree = test::random_tree(random, 5, 6);
    const auto text = [](int i) { return std::to_string(i); };
    const auto name = [](BooleanOperator op) { return "o" + std::to_string(static_cast<int>(op)); };
    const auto longer = [](const std::string& s) { return s + "!"; };
    const auto twice = map(map(tree, text, name), longer, longer);
    EXPECT_EQ(twice, map(
                         tree, [&](int i) { return longer(text(i)); },
                         [&](BooleanOperator op) { return longer(name(op)); }));
    EXPECT_EQ(map(tree, std::identity{}), tree);
    const std::string spelling = spelled(twice);
    EXPECT_EQ(std::count(spelling.begin(), spelling.end(), '!'),
              static_cast<std::ptrdiff_t>(tree.primitive_count()) +
                  std::count(spelling.begin(), spelling.end(), '('));
  }
}

// Two equal towers of 100 doublings, made apart, stand for 2^100 pairs of leaves.
TEST(Tree, EqualityOfSharedNodesIsDecidedOnce) {
  TestTree first = leaf(1);
  TestTree second = leaf(1);
  TestTree third = leaf(2);
  for (int i = 0; i < 100; ++i) {
    first = unite(first, first);
    second = unite(second, second);
    third = unite(third, third);
  }
  EXPECT_TRUE(first == second);
  EXPECT_FALSE(first == third);
}

#if defined(__GLIBC__)
// LAW tree.5: what the allocator says it gave, and 8 bytes before each piece.
template <std::size_t size>
struct Sized {
  std::array<double, size / sizeof(double)> values{};
};
template <std::size_t size>
double bytes_per_node_beside_primitives(std::size_t primitives) {
  using T = BooleanTree<Sized<size>>;
  std::vector<T> level;
  for (std::size_t i = 0; i < primitives; ++i) level.push_back(T::primitive({}));
  std::size_t bytes = 0;
  const auto count = [&](const T& tree) {
    bytes += malloc_usable_size(const_cast<void*>(tree.identity())) + 8;
  };
  for (const T& tree : level) count(tree);
  while (level.size() > 1) {
    std::vector<T> above;
    for (std::size_t i = 0; i + 1 < level.size(); i += 2) {
      above.push_back(unite(level[i], level[i + 1]));
      count(above.back());
    }
    if (level.size() % 2 == 1) above.push_back(level.back());
    level = std::move(above);
  }
  return static_cast<double>(bytes - primitives * size) /
         static_cast<double>(level[0].node_count());
}
TEST(Tree, TakesLittleMemory) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  constexpr double most = 64;  // their allocators round otherwise
#else
  constexpr double most = 48;
#endif
  EXPECT_LE(bytes_per_node_beside_primitives<8>(1000), most);
  EXPECT_LE(bytes_per_node_beside_primitives<16>(1000), most);
  EXPECT_LE(bytes_per_node_beside_primitives<32>(1000), most);
  EXPECT_LE(bytes_per_node_beside_primitives<64>(1000), most);
}
#endif

TEST(Flatten, RefusesWhatIsTooLargeByName) {
  TestTree tree = leaf(1);
  for (int i = 0; i < 9; ++i) tree = unite(tree, tree);
  EXPECT_EQ(flatten(
                tree, [](int i) { return i; }, 1023)
                .node_count(),
            1023U);
  try {
    flatten(
        tree, [](int i) { return i; }, 1022);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.id(), ErrorId::TooLarge);
  }
}

// LAW flat.2
TEST(FlatTree, IsRebuiltInPlace) {
  FlatTree<std::uint32_t, BooleanOperator> tree;
  EXPECT_TRUE(tree.is_empty());
  const auto build = [&](std::uint32_t n) {
    tree.clear();
    const auto root = tree.open(Difference);
    tree.append_full();
    const auto inner = tree.open(Union);
    for (std::uint32_t i = 0; i < n; ++i) tree.append_primitive(i);
    tree.append_empty();
    tree.close(inner);
    tree.close(root);
  };
  build(100);
  EXPECT_EQ(tree.node_count(), 104U);
  const auto capacity = tree.capacity();
  for (std::uint32_t n = 1; n < 100; ++n) build(n);
  EXPECT_EQ(tree.capacity(), capacity);
  EXPECT_EQ(tree.root().kind(), NodeKind::Compose);
  EXPECT_EQ(tree.root().first_child().kind(), NodeKind::Full);
  const auto inner = tree.root().first_child().next_sibling();
  EXPECT_EQ(inner.operation(), Union);
  EXPECT_EQ(inner.next_sibling(), tree.root().children_end());
  tree.clear();
  EXPECT_TRUE(tree.is_empty());
  EXPECT_EQ(tree.node_count(), 1U);
}

TEST(FlatTree, EqualityLooksAtEverything) {
  const auto flat = [](const TestTree& tree) { return flatten(tree, [](int i) { return i; }); };
  const TestTree a = unite(subtract(leaf(1), leaf(2)), leaf(3));
  EXPECT_EQ(flat(a), flat(a));
  EXPECT_FALSE(flat(a) == flat(unite(subtract(leaf(1), leaf(2)), leaf(4))));
  EXPECT_FALSE(flat(a) == flat(unite(intersect(leaf(1), leaf(2)), leaf(3))));
  EXPECT_FALSE(flat(a) == flat(unite(leaf(1), subtract(leaf(2), leaf(3)))));
  EXPECT_FALSE(flat(a) == flat(TestTree::empty()));
  EXPECT_EQ(flat(TestTree::empty()), (FlatTree<int, BooleanOperator>()));
}

TEST(Print, WritesOperatorsAndOperands) {
  const TestTree tree =
      unite(subtract(TestTree::full(), leaf(1)), intersect(leaf(2), TestTree::empty()));
  EXPECT_EQ(to_text(tree, [](int i) { return std::to_string(i); }), "(+ (- full 1) (& 2 empty))");
  EXPECT_EQ(
      to_text(flatten(tree, [](int i) { return i; }), [](int i) { return std::to_string(i); }),
      "(+ (- full 1) (& 2 empty))");
}

// LAW tree.4; ThreadSanitizer is the judge.
TEST(Tree, ThreadsShareNodes) {
  TestTree tree = chain(2000, Union, Side::Left, 1);
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([copy = tree]() mutable {
      for (int i = 0; i < 20; ++i) {
        const TestTree larger = unite(copy, copy.children()[0]);
        copy = larger.children()[1].is_compose() ? larger.children()[1] : copy;
      }
      copy = TestTree::empty();
    });
  }
  tree = TestTree::empty();
  for (std::thread& thread : threads) thread.join();
}

}  // namespace
}  // namespace exactcsg::csg
