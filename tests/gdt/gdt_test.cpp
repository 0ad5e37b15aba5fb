// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <numeric>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "exactcsg/csg/flat_tree.hpp"
#include "exactcsg/csg/prune.hpp"
#include "exactcsg/csg/traverse.hpp"
#include "exactcsg/gdt/create.hpp"
#include "exactcsg/gdt/traverse.hpp"

namespace exactcsg::gdt {
namespace {

using skeleton::ParallelExecutor;
using skeleton::SequentialExecutor;

// More threads than a small machine has, so that tasks do run at the same time.
const tbb::global_control more_threads(tbb::global_control::max_allowed_parallelism, 8);

struct Interval {
  int first;
  int last;
  int size() const { return last - first; }
};
bool single(const Interval& i) { return i.size() <= 1; }
std::array<Interval, 2> halves(const Interval& i) {
  const int middle = i.first + i.size() / 2;
  return {Interval{i.first, middle}, Interval{middle, i.last}};
}
int first(const Interval& i) { return i.first; }
int sum(std::span<int> numbers) { return std::accumulate(numbers.begin(), numbers.end(), 0); }

// LAW create.1 and gdt.1: a halved range of n has n terminals and n - 1 interior nodes.
TEST(Gdt, CreateDividesDownToTheLeaves) {
  const auto tree = create(Interval{0, 37}, single, halves, first);
  std::vector<int> expected(37);
  std::iota(expected.begin(), expected.end(), 0);
  EXPECT_EQ(std::vector(tree.terminals().begin(), tree.terminals().end()), expected);
  EXPECT_EQ(tree.node_count(), 37U + 36U);
  EXPECT_EQ(traverse(
                tree, [](int i) { return i; }, sum),
            37 * 36 / 2);
}

// LAW create.1 and .2: the root is at depth 0, so depth d has 2^d terminals.
TEST(Gdt, CreateStopsAtTheGreatestDepth) {
  for (const std::size_t depth : {0U, 1U, 5U}) {
    const auto tree = create(
        Interval{0, 1 << 10}, [](const Interval&) { return false; }, halves,
        [](const Interval& i) { return i.size(); }, depth);
    EXPECT_EQ(tree.terminals().size(), std::size_t{1} << depth);
    for (const int size : tree.terminals()) EXPECT_EQ(size, (1 << 10) >> depth);
  }
}

using Ternary = Tree<std::string, int>;
Ternary sample() {
  return Ternary::interior(
      {Ternary::terminal("a"),
       Ternary::interior({Ternary::terminal("b"), Ternary::interior({}, 3), Ternary::terminal("c")},
                         2),
       Ternary::interior({Ternary::terminal("d")}, 4), Ternary::terminal("e")},
      1);
}
std::string label_and_join(std::span<std::string> texts, int label) {
  std::string text = std::to_string(label) + "(";
  for (const std::string& t : texts) text += t;
  return text + ")";
}
std::string itself(const std::string& s) { return s; }

// LAW gdt.1 and gdt.traverse.1, by hand.
TEST(Gdt, NodesOfAnyDegreeWithLabels) {
  const Ternary tree = sample();
  EXPECT_EQ(tree.node_count(), 9U);
  EXPECT_EQ(traverse(tree, itself, label_and_join), "1(a2(b3()c)4(d)e)");
  const auto with_query = [](const std::string& s, int times) {
    std::string text;
    for (int i = 0; i < times; ++i) text += s;
    return text;
  };
  EXPECT_EQ(traverse(tree, 2, with_query, label_and_join), "1(aa2(bb3()cc)4(dd)ee)");
  EXPECT_EQ(traverse(tree, 2, with_query, label_and_join, ParallelExecutor<>(4)),
            "1(aa2(bb3()cc)4(dd)ee)");
  EXPECT_EQ(tree, sample());
  EXPECT_FALSE(tree == Ternary::terminal("a"));
  Ternary copy = tree;
  const Ternary moved = std::move(copy);
  EXPECT_EQ(moved, tree);
}

TEST(Gdt, NodesCanBeWalkedByHand) {
  const Ternary tree = sample();
  const auto root = tree.root();
  ASSERT_FALSE(root.is_terminal());
  EXPECT_EQ(root.label(), 1);
  ASSERT_EQ(root.degree(), 4U);
  EXPECT_EQ(root.child(0).terminal(), "a");
  EXPECT_EQ(root.child(1).label(), 2);
  EXPECT_EQ(root.child(1).child(2).terminal(), "c");
  EXPECT_EQ(root.child(1).child(1).degree(), 0U);
  EXPECT_EQ(root.child(2).child(0).terminal(), "d");
  int children = 0;
  for (const auto child : root.children()) children += child.is_terminal() ? 1 : 10;
  EXPECT_EQ(children, 22);
}

// A division that is found once: divide stores the cut, label takes it out.
struct Cell {
  Interval interval;
  int cut = 0;
};
Tree<Interval, int> search_tree(int n, const auto& executor) {
  return create(
      Cell{{0, n}}, [](const Cell& c) { return single(c.interval); },
      [](Cell& c) {
        c.cut = c.interval.first + (c.interval.size() + 2) / 3;
        return std::array{Cell{{c.interval.first, c.cut}}, Cell{{c.cut, c.interval.last}}};
      },
      [](const Cell& c) { return c.interval; }, unlimited_depth, executor,
      [](const Cell& c) { return c.cut; });
}

// LAW gdt.descend.1: the terminal that holds the number.
TEST(Gdt, DescendLocates) {
  const auto tree = search_tree(100, SequentialExecutor{});
  for (int x = 0; x < 100; ++x) {
    const Interval& found = descend(tree, [x](int cut) { return x < cut ? 0 : 1; });
    EXPECT_EQ(found.first, x);
    EXPECT_EQ(found.last, x + 1);
  }
  try {
    descend(tree, [](int) { return 2; });
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.id(), ErrorId::BadArgument);
  }
}

// LAW gdt.descend.2, held against the numbers themselves: a terminal holds one number each.
template <class E>
void expect_batch_locates(const E& executor) {
  constexpr int n = 300;
  const auto tree = search_tree(n, SequentialExecutor{});
  std::mt19937 random(5);
  std::vector<int> queries(20'000);
  std::vector<std::size_t> expected(n, 0);
  for (int& x : queries) {
    x = static_cast<int>(random() % n) / 2 * 2;  // nobody goes to the odd ones
    ++expected[static_cast<std::size_t>(x)];
  }
  std::vector<std::size_t> found(n, 0);
  descend_batch(
      tree, std::span(queries), [](int cut, int x) { return x < cut ? 0 : 1; },
      [&](const Interval& interval, std::span<int> here) {
        std::size_t& count = found[static_cast<std::size_t>(interval.first)];
        ASSERT_EQ(count, 0U) << "visited twice: " << interval.first;
        count = here.size();
        for (const int x : here) ASSERT_EQ(x, interval.first);
      },
      executor);
  EXPECT_EQ(found, expected);
  EXPECT_TRUE(std::is_sorted(queries.begin(), queries.end()));
}
TEST(Gdt, DescendBatchLocates) {
  expect_batch_locates(SequentialExecutor{});
  expect_batch_locates(ParallelExecutor<>(2));
}

// LAW gdt.descend.2: queries that cannot be told apart by where they go keep an order that does not
// depend on the executor.
TEST(Gdt, DescendBatchOrdersAlikeOnEveryExecutor) {
  const auto tree = search_tree(64, SequentialExecutor{});
  using Query = std::pair<int, int>;
  std::vector<Query> one;
  std::mt19937 random(6);
  for (int i = 0; i < 50'000; ++i) one.emplace_back(static_cast<int>(random() % 64), i);
  std::vector<Query> two = one;
  const auto choose = [](int cut, const Query& query) { return query.first < cut ? 0 : 1; };
  const auto nothing = [](const Interval&, std::span<Query>) {};
  descend_batch(tree, std::span(one), choose, nothing);
  descend_batch(tree, std::span(two), choose, nothing, ParallelExecutor<>(2));
  EXPECT_EQ(one, two);
}

TEST(Gdt, DescendBatchOfNobodyVisitsNothing) {
  std::vector<int> queries;
  descend_batch(
      search_tree(10, SequentialExecutor{}), std::span(queries), [](int, int) { return 0; },
      [](const Interval&, std::span<int>) { FAIL(); });
}

TEST(Gdt, DescendBatchToAChildThatIsNotThere) {
  std::vector<int> queries{1, 2};
  try {
    descend_batch(
        search_tree(10, SequentialExecutor{}), std::span(queries), [](int, int) { return 2; },
        [](const Interval&, std::span<int>) {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.id(), ErrorId::BadArgument);
  }
}

// LAW executor.1
TEST(Gdt, ExecutorsBuildEqualTrees) {
  const auto numbers = [](const auto& executor) {
    return create(Interval{0, 5000}, single, halves, first, 9, executor);
  };
  const auto expected = numbers(SequentialExecutor{});
  EXPECT_EQ(numbers(ParallelExecutor<>(4)), expected);
  EXPECT_EQ(numbers(ParallelExecutor<>(4, 3)), expected);
  EXPECT_EQ(traverse(
                expected, [](int i) { return i; }, sum, ParallelExecutor<>(3)),
            traverse(
                expected, [](int i) { return i; }, sum));
}

// LAW gdt.traverse.2
TEST(Gdt, CreateAndTraverseAreDivacon) {
  for (const int n : {0, 1, 2, 100, 1023}) {
    const Interval all{0, n};
    const auto square = [](int i) { return i * i; };
    EXPECT_EQ(traverse(create(all, single, halves, first), square, sum),
              skeleton::divacon(
                  all, single, halves, [&](const Interval& i) { return square(i.first); }, sum));
  }
}

TEST(Gdt, MoveOnlyTerminals) {
  using Box = std::unique_ptr<int>;
  const auto tree = create(Interval{0, 10}, single, halves,
                           [](const Interval& i) { return std::make_unique<int>(i.first); });
  static_assert(std::same_as<std::remove_cvref_t<decltype(tree)>, Tree<Box, NoLabel>>);
  EXPECT_EQ(traverse(
                tree, [](const Box& b) { return *b; }, sum),
            45);
}

TEST(Gdt, MoveOnlyData) {
  using Box = std::unique_ptr<int>;
  const auto tree = create(
      std::make_unique<int>(3), [](const Box& b) { return *b == 0; },
      [](Box& b) {
        std::vector<Box> parts;
        for (int i = 0; i < *b; ++i) parts.push_back(std::make_unique<int>(*b - 1));
        return parts;
      },
      [](Box&& b) { return *b; });
  EXPECT_EQ(tree.terminals().size(), 6U);  // 3!
}

// LAW gdt.2: sum of 0 .. n-1, an element split off at a time at either end.
TEST(Gdt, AMillionDeep) {
  constexpr int n = 1'000'000;
  for (const bool at_front : {false, true}) {
    const auto tree = create(
        Interval{0, n}, single,
        [=](const Interval& i) {
          const int cut = at_front ? i.first + 1 : i.last - 1;
          return std::array{Interval{i.first, cut}, Interval{cut, i.last}};
        },
        first, unlimited_depth, ParallelExecutor<>(2));
    EXPECT_EQ(tree.node_count(), 2U * n - 1U);
    const auto copy = tree;
    EXPECT_EQ(traverse(
                  copy, [](int i) { return std::int64_t{i}; },
                  [](std::span<std::int64_t> s) { return s[0] + s[1]; }),
              std::int64_t{n} * (n - 1) / 2);
  }
}

// LAW executor.2, with a deep half-built tree that has to be destroyed.
TEST(Gdt, AnExceptionDestroysTheHalfBuiltTree) {
  const auto run = [](const auto& executor) {
    create(
        Interval{0, 300'000}, single,
        [](const Interval& i) {
          return std::array{Interval{i.first, i.first + 1}, Interval{i.first + 1, i.last}};
        },
        [](const Interval& i) { return std::make_shared<int>(i.first); }, unlimited_depth, executor,
        [](const Interval& i) {
          if (i.first == 3) throw std::runtime_error("planted");
          return i.first;
        });
  };
  EXPECT_THROW(run(SequentialExecutor{}), std::runtime_error);
  EXPECT_THROW(run(ParallelExecutor<>(4)), std::runtime_error);
}

// The example of the source, section 3.4, in two dimensions with exact integers: the area of a CSG
// solid by quadtree. Boxes with corners on the grid of 2^5 cells, so that the area is the sum of
// full cells, and the expected value a count of unit cells one by one.
struct Box {
  int x0, y0, x1, y1;
};
struct Task {
  Box cell;
  csg::Tree<Box, csg::BooleanOperator> solid;
};

TEST(Gdt, AreaOfATwoDimensionalSolid) {
  using Solid = csg::Tree<Box, csg::BooleanOperator>;
  using csg::Membership;
  const auto box = [](int x0, int y0, int x1, int y1) {
    return Solid::primitive({x0, y0, x1, y1});
  };
  const Solid solid = csg::symmetric_difference(
      csg::subtract(csg::unite(box(1, 2, 20, 17), box(5, 5, 30, 31)), box(7, 3, 12, 25)),
      csg::complement(csg::intersect(box(0, 0, 16, 16), box(9, 9, 25, 25))));
  const auto classify = [](const Box& cell) {
    return [cell](const Box& b) {
      if (cell.x1 <= b.x0 || b.x1 <= cell.x0 || cell.y1 <= b.y0 || b.y1 <= cell.y0) {
        return Membership::Out;
      }
      const bool inside = b.x0 <= cell.x0 && cell.x1 <= b.x1 && b.y0 <= cell.y0 && cell.y1 <= b.y1;
      return inside ? Membership::In : Membership::Unknown;
    };
  };
  const auto leaf = [](const Task& t) { return t.solid.is_empty() || t.solid.is_full(); };
  const auto divide = [&](const Task& t) {
    const auto [x0, y0, x1, y1] = t.cell;
    const int x = (x0 + x1) / 2;
    const int y = (y0 + y1) / 2;
    std::vector<Task> quadrants;
    for (const Box& cell :
         {Box{x0, y0, x, y}, Box{x, y0, x1, y}, Box{x0, y, x, y1}, Box{x, y, x1, y1}}) {
      quadrants.push_back({cell, csg::prune(t.solid, classify(cell))});
    }
    return quadrants;
  };
  const auto area = [](const Task& t) {
    return t.solid.is_full() ? (t.cell.x1 - t.cell.x0) * (t.cell.y1 - t.cell.y0) : 0;
  };
  int expected = 0;
  for (int x = 0; x < 32; ++x) {
    for (int y = 0; y < 32; ++y) {
      const auto inside = csg::traverse(
          solid, [&](const Box& b) { return b.x0 <= x && x < b.x1 && b.y0 <= y && y < b.y1; },
          [](bool a, csg::BooleanOperator op, bool b) {
            switch (op) {
              case csg::BooleanOperator::Union:
                return a || b;
              case csg::BooleanOperator::Intersection:
                return a && b;
              case csg::BooleanOperator::Difference:
                return a && !b;
              default:
                return a != b;
            }
          },
          csg::FullEmptyResult{true, false});
      expected += inside ? 1 : 0;
    }
  }
  const Task universe{{0, 0, 32, 32}, solid};
  EXPECT_EQ(skeleton::divacon(universe, leaf, divide, area, sum), expected);
  EXPECT_EQ(skeleton::divacon(universe, leaf, divide, area, sum, ParallelExecutor<>(4)), expected);
  const auto keep = [](Task&& t) { return std::move(t); };
  EXPECT_EQ(traverse(create(universe, leaf, divide, keep), area, sum), expected);
  EXPECT_EQ(traverse(create(universe, leaf, divide, keep, 5), area, sum), expected);
}

}  // namespace
}  // namespace exactcsg::gdt
