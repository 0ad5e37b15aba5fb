// SPDX-License-Identifier: GPL-3.0-or-later
// Operations on two decomposition trees. Expected values: the values at every unit cell of the
// grid, found one by one (test::value_at), or the definition of zip by hand.
#include "exactcsg/gdt/zip.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "exactcsg/gdt/overlay.hpp"
#include "gdt/random_divisions.hpp"

namespace exactcsg::gdt {
namespace {

using skeleton::ParallelExecutor;
using test::below;
using test::cube;
using test::for_each_point;
using test::random_cuts;
using test::random_orthants;
using test::value_at;

// The least that a state and a result may be: movable, nothing else.
using MoveOnly = std::unique_ptr<int>;
using TextTree = Tree<std::string>;
using TextPair = Pair<TextTree, TextTree, MoveOnly>;
static_assert(std::movable<TextPair>);
static_assert(
    CombinesPairs<decltype([](std::span<MoveOnly>) { return MoveOnly(); }), MoveOnly, TextPair>);

TextTree text(const char* value) { return TextTree::terminal(value); }

// LAW zip.1 and .2 by hand: the first is divided, then the second, then both; odd parts of the
// second are dropped.
TEST(Zip, DividesEitherOrBoth) {
  const TextTree first =
      TextTree::interior({TextTree::interior({text("a"), text("b")}), text("c")});
  const TextTree second =
      TextTree::interior({TextTree::interior({text("x"), text("y")}), text("dropped")});
  int sides = 0;
  int parts = 0;
  const auto result = zip(
      first, second, std::make_unique<int>(0),
      [&](const TextPair& pair) {
        ++sides;
        if (pair.first.is_terminal()) {
          return Split::Neither;  // an early out where the second is divided
        }
        constexpr Split order[] = {Split::First, Split::Second, Split::Both};
        return order[*pair.state];
      },
      [&](const TextPair& pair, Split split, std::size_t index) -> std::optional<MoveOnly> {
        ++parts;
        if (split == Split::Second && index == 1) return std::nullopt;
        return std::make_unique<int>(*pair.state + 1);
      },
      [](const TextPair& pair) {
        const std::string right =
            pair.second.is_terminal() ? pair.second.terminal() : std::string("?");
        return std::make_unique<std::string>(pair.first.terminal() + right);
      },
      [](std::span<std::unique_ptr<std::string>> results, const TextPair& pair) {
        std::string all = std::to_string(*pair.state) + "(";
        for (const auto& r : results) all += *r;
        return std::make_unique<std::string>(all + ")");
      });
  EXPECT_EQ(*result, "0(1(2(axby))c?)");
  EXPECT_EQ(sides, 6);  // as many as pairs
  EXPECT_EQ(parts, 6);
}

TEST(Zip, RefusesToDivideWhatCannotBeDivided) {
  const TextTree two = TextTree::interior({text("a"), text("b")});
  const TextTree one = TextTree::interior({text("a")});
  using P = Pair<TextTree, TextTree>;
  const auto run = [](const TextTree& a, const TextTree& b, Split split) {
    try {
      zip(
          a, b, [&](const P&) { return split; }, [](const P&) { return 0; },
          [](std::span<int>) { return 0; });
    } catch (const Error& error) {
      return error.id() == ErrorId::BadArgument;
    }
    return false;
  };
  EXPECT_TRUE(run(two, one, Split::Both));
  EXPECT_TRUE(run(text("t"), one, Split::First));
  EXPECT_TRUE(run(one, text("t"), Split::Second));
  EXPECT_TRUE(run(one, text("t"), Split::Both));
}

// The join of two hierarchies of boxes, as for strip trees: which terminals overlap? Intervals at
// every node; the longer of the two is divided. Against all pairs of terminals.
struct Range {
  int from, to;
};
using Ranges = Tree<Range, Range>;
Ranges random_ranges(std::mt19937& random, int from, int to) {
  if (to - from < 2 || below(random, 8) == 0) {
    const int a = from + below(random, to - from);
    return Ranges::terminal({a, a + below(random, to - a) + 1});
  }
  const int middle = from + 1 + below(random, to - from - 1);
  return Ranges::interior({random_ranges(random, from, middle), random_ranges(random, middle, to)},
                          {from, to});
}

TEST(Zip, JoinsTwoHierarchies) {
  std::mt19937 random(7);
  using P = Pair<Ranges, Ranges>;
  const auto overlap = [](const Range& a, const Range& b) {
    return a.from < b.to && b.from < a.to;
  };
  for (int round = 0; round < 100; ++round) {
    const Ranges first = random_ranges(random, 0, 60);
    const Ranges second = random_ranges(random, 20, 90);
    int expected = 0;
    for (const Range& a : first.terminals()) {
      for (const Range& b : second.terminals()) expected += overlap(a, b) ? 1 : 0;
    }
    const int found = zip(
        first, second,
        [&](const P& pair) {
          const Range a = pair.first.geometry();
          const Range b = pair.second.geometry();
          if (!overlap(a, b)) return Split::Neither;
          const bool longer = a.to - a.from > b.to - b.from;
          if (!pair.first.is_terminal() && (longer || pair.second.is_terminal())) {
            return Split::First;
          }
          return pair.second.is_terminal() ? Split::Neither : Split::Second;
        },
        [&](const P& pair) {
          return overlap(pair.first.geometry(), pair.second.geometry()) ? 1 : 0;
        },
        [](std::span<int> counts) { return std::accumulate(counts.begin(), counts.end(), 0); });
    EXPECT_EQ(found, expected);
  }
}

// LAW overlay.1 on trees that divide alike, from bintree to hyperoctree.
template <std::size_t dimension>
void expect_pointwise(std::mt19937& random, int depth) {
  const int size = 1 << depth;
  const auto a = random_orthants<dimension>(random, depth, 5);
  const auto b = random_orthants<dimension>(random, depth, 5);
  const auto sum = overlay(a, b, std::plus<int>());
  const auto difference = overlay(a, b, std::minus<int>(), NeverEarly{}, ParallelExecutor<>(2));
  for_each_point<dimension>(size, [&](const auto& point) {
    const int x = value_at(a, size, point);
    const int y = value_at(b, size, point);
    ASSERT_EQ(value_at(sum, size, point), x + y);
    ASSERT_EQ(value_at(difference, size, point), x - y);
  });
}

TEST(Overlay, AddsAndSubtractsTreesDividedAlike) {
  std::mt19937 random(11);
  for (int round = 0; round < 30; ++round) {
    expect_pointwise<1>(random, 5);
    expect_pointwise<2>(random, 4);
    expect_pointwise<3>(random, 3);
    expect_pointwise<4>(random, 2);
  }
}

// LAW overlay.2 and .3: Boolean operations of octrees, with the early outs of full and empty.
TEST(Overlay, UnitesOctreesWithoutVisitingWhatIsFull) {
  std::mt19937 random(13);
  for (int round = 0; round < 30; ++round) {
    const auto a = random_orthants<3>(random, 3, 2);
    const auto b = random_orthants<3>(random, 3, 2);
    const auto either = [](const int* x, const int* y) -> std::optional<int> {
      if ((x != nullptr && *x == 1) || (y != nullptr && *y == 1)) return 1;
      return std::nullopt;
    };
    const auto late = overlay(a, b, std::logical_or<int>());
    const auto united = overlay(
        a, b, [](int x, int y) { return x | y; }, either);
    EXPECT_LE(united.node_count(), late.node_count());
    const auto merged = merge_equal(united);
    EXPECT_EQ(merged, merge_equal(overlay(a, b, [](int x, int y) { return x | y; })));
    EXPECT_EQ(merge_equal(merged), merged);
    for_each_point<3>(8, [&](const auto& point) {
      const int expected = value_at(a, 8, point) | value_at(b, 8, point);
      ASSERT_EQ(value_at(united, 8, point), expected);
      ASSERT_EQ(value_at(merged, 8, point), expected);
    });
  }
}

TEST(Overlay, MergesEqualTerminalsUpwards) {
  const auto t = [](int i) { return Tree<int>::terminal(i); };
  const auto node = [](std::vector<Tree<int>> c) { return Tree<int>::interior(std::move(c)); };
  EXPECT_EQ(merge_equal(node({node({t(1), t(1)}), t(1)})), t(1));
  EXPECT_EQ(merge_equal(node({node({t(1), t(1)}), t(2)})), node({t(1), t(2)}));
  EXPECT_EQ(merge_equal(node({})), node({}));
}

// LAW overlay.4, then overlay.1 on a quadtree against a tree of unequal cuts.
TEST(Overlay, CombinesTreesDividedDifferently) {
  std::mt19937 random(17);
  const auto cell = cube<2>(16);
  for (int round = 0; round < 60; ++round) {
    const auto quadtree = random_orthants<2>(random, 4, 5);
    const auto as_cuts = to_cuts(quadtree, cell);
    const auto unequal = random_cuts(random, cell, 7, 5);
    const auto other = random_cuts(random, cell, 7, 5);
    const auto sum = overlay_cuts(as_cuts, unequal, cell, std::plus<int>());
    const auto product =
        overlay_cuts(unequal, other, cell, std::multiplies<int>(), [](const int* x, const int* y) {
          const bool zero = (x != nullptr && *x == 0) || (y != nullptr && *y == 0);
          return zero ? std::optional(0) : std::nullopt;
        });
    for_each_point<2>(16, [&](const auto& p) {
      ASSERT_EQ(value_at(as_cuts, 16, p), value_at(quadtree, 16, p));
      ASSERT_EQ(value_at(sum, 16, p), value_at(quadtree, 16, p) + value_at(unequal, 16, p));
      ASSERT_EQ(value_at(product, 16, p), value_at(unequal, 16, p) * value_at(other, 16, p));
    });
    // No cell of the result is empty: a product of all volumes counts each unit cell once.
    EXPECT_LE(sum.terminals().size(), 256U);
  }
}

TEST(Overlay, RefusesDifferentDegrees) {
  const auto t = Tree<int>::terminal(1);
  EXPECT_THROW(overlay(Tree<int>::interior({t}), Tree<int>::interior({t, t}), std::plus<int>()),
               Error);
  EXPECT_THROW(to_cuts(Tree<int>::interior({t, t, t}), cube<2>(4)), Error);
}

// A region as the state: the integral of the product of two densities over trees that are divided
// differently, without building a third. Against the sum over unit cells.
TEST(Zip, IntegratesOverTheCommonRefinement) {
  std::mt19937 random(19);
  using KdTree = Tree<int, Cut<int>>;
  using P = Pair<KdTree, KdTree, Cell<int, 3>>;
  const auto cell = cube<3>(8);
  for (int round = 0; round < 30; ++round) {
    const KdTree a = random_cuts(random, cell, 6, 4);
    const KdTree b = random_cuts(random, cell, 6, 4);
    int expected = 0;
    for_each_point<3>(8, [&](const auto& p) { expected += value_at(a, 8, p) * value_at(b, 8, p); });
    const int integral = zip(
        a, b, cell,
        [](const P& pair) {
          if (!pair.first.is_terminal()) return Split::First;
          return pair.second.is_terminal() ? Split::Neither : Split::Second;
        },
        [](const P& pair, Split split, std::size_t i) {
          const auto& label = split == Split::First ? pair.first.label() : pair.second.label();
          const auto part = Cuts{}(pair.state, label, i);
          return is_empty(part) ? std::nullopt : std::optional(part);
        },
        [](const P& pair) {
          int volume = 1;
          for (std::size_t axis = 0; axis < 3; ++axis) {
            volume *= pair.state.upper[axis] - pair.state.lower[axis];
          }
          return volume * pair.first.terminal() * pair.second.terminal();
        },
        [](std::span<int> sums) { return std::accumulate(sums.begin(), sums.end(), 0); },
        ParallelExecutor<>(2, 3));
    EXPECT_EQ(integral, expected);
  }
}

// LAW executor.3: chains of unit intervals cut off from the left, 300 000 deep, in step; and from
// the left against from the right, where the common refinement has as many cells.
Tree<int, Cut<int>> chain(int n, bool from_left) {
  struct Part {
    int from, to;
  };
  return create(
      Part{0, n}, [](const Part& p) { return p.to - p.from == 1; },
      [=](const Part& p) {
        const int cut = from_left ? p.from + 1 : p.to - 1;
        return std::array{Part{p.from, cut}, Part{cut, p.to}};
      },
      [](const Part& p) { return p.from; }, unlimited_depth, skeleton::SequentialExecutor{},
      [=](const Part& p) {
        return Cut<int>{0, from_left ? p.from + 1 : p.to - 1};
      });
}

TEST(Overlay, DeepTrees) {
  const auto deep = chain(300'000, true);
  const auto sum = overlay(deep, deep, std::plus<int>());
  EXPECT_EQ(sum.node_count(), deep.node_count());
  EXPECT_EQ(sum.terminals().back(), 2 * 299'999);
  EXPECT_EQ(map(deep, [](int i) { return 2 * i; }), sum);
  EXPECT_EQ(merge_equal(map(deep, [](int) { return 0; })).node_count(), 1U);
  const auto crossed = overlay_cuts(chain(1000, true), chain(1000, false),
                                    Cell<int, 1>{{0}, {1000}}, std::plus<int>());
  ASSERT_EQ(crossed.terminals().size(), 1000U);
  for (std::size_t i = 0; i < 1000; ++i) {
    EXPECT_EQ(crossed.terminals()[i], 2 * static_cast<int>(i));
  }
}

}  // namespace
}  // namespace exactcsg::gdt
