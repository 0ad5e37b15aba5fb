// SPDX-License-Identifier: GPL-3.0-or-later
// Ways through a decomposition tree. Expected values: all terminals with their cells, listed
// without these operators, and tested one by one.
#include "exactcsg/gdt/path.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

#include "exactcsg/gdt/create.hpp"
#include "exactcsg/gdt/ray_walk.hpp"
#include "exactcsg/number/exact.hpp"
#include "gdt/random_divisions.hpp"

namespace exactcsg::gdt {
namespace {

using test::below;
using test::cube;
using test::for_each_point;
using test::random_cuts;
using test::random_orthants;

static_assert(BoxCell<Cell<int, 3>> && BoxCell<Cell<Rational, 2>>);
static_assert(Divides<Orthants, Cell<int, 3>, NoLabel>);
static_assert(Divides<Orthants, Cell<int, 2>, Coordinates<int, 2>>);
static_assert(Divides<Cuts, Cell<Rational, 4>, Cut<Rational>>);
static_assert(!Divides<Cuts, Cell<int, 2>, NoLabel>);

// The least that a cell may be: anything that can be copied.
struct NamedCell {
  std::string name;
};
struct ByName {
  NamedCell operator()(const NamedCell& cell, NoLabel, std::size_t index) const {
    return {cell.name + std::to_string(index)};
  }
};
static_assert(Divides<ByName, NamedCell, NoLabel> && !BoxCell<NamedCell>);

template <class T, class C>
using Cells = std::vector<std::pair<T, C>>;

template <class T, class N, class C, class Division>
void list_cells(typename Tree<T, N>::Node node, const C& cell, const Division& division,
                Cells<T, C>& all) {
  if (node.is_terminal()) {
    all.push_back({node.terminal(), cell});
    return;
  }
  for (std::size_t i = 0; i < node.degree(); ++i) {
    list_cells<T, N>(node.child(i), division(cell, node.label(), i), division, all);
  }
}
template <class T, class N, class C, class Division>
Cells<T, C> cells_of(const Tree<T, N>& tree, const C& cell, const Division& division) {
  Cells<T, C> all;
  list_cells<T, N>(tree.root(), cell, division, all);
  return all;
}

// A bintree that is halved along each axis in turn: the cell knows whose turn it is.
struct TurningCell : Cell<int, 3> {
  std::size_t axis = 0;
};
struct HalvesInTurn {
  TurningCell operator()(const TurningCell& cell, NoLabel, std::size_t index) const {
    TurningCell half = cell;
    const int middle = (cell.lower[cell.axis] + cell.upper[cell.axis]) / 2;
    (index == 0 ? half.upper : half.lower)[cell.axis] = middle;
    half.axis = (cell.axis + 1) % 3;
    return half;
  }
};
Tree<int> random_halves(std::mt19937& random, int depth) {
  if (depth == 0 || below(random, 6) == 0) return Tree<int>::terminal(below(random, 9));
  return Tree<int>::interior({random_halves(random, depth - 1), random_halves(random, depth - 1)});
}

// A quadtree whose nodes say where their quadrants meet.
Tree<int, Coordinates<int, 2>> random_unequal(std::mt19937& random, const Cell<int, 2>& cell,
                                              int depth) {
  using T = Tree<int, Coordinates<int, 2>>;
  const int width = cell.upper[0] - cell.lower[0];
  const int height = cell.upper[1] - cell.lower[1];
  if (depth == 0 || width < 2 || height < 2) return T::terminal(below(random, 9));
  const Coordinates<int, 2> meet{cell.lower[0] + 1 + below(random, width - 1),
                                 cell.lower[1] + 1 + below(random, height - 1)};
  std::vector<T> quadrants;
  for (std::size_t i = 0; i < 4; ++i) {
    quadrants.push_back(random_unequal(random, Orthants{}(cell, meet, i), depth - 1));
  }
  return T::interior(std::move(quadrants), meet);
}

// Every check of this file on every kind of division, with all its cells.
template <class Check>
void on_every_division(unsigned seed, Check&& check) {
  std::mt19937 random(seed);
  const auto check_on = [&](const auto& tree, const auto& cell, const auto& division) {
    check(random, tree, cell, division, cells_of(tree, cell, division));
  };
  for (int round = 0; round < 12; ++round) {
    check_on(random_orthants<2>(random, 4, 9), cube<2>(16), Orthants{});  // quadtree
    check_on(random_orthants<3>(random, 3, 9), cube<3>(8), Orthants{});   // octree
    const auto halves = random_halves(random, 9);                         // axes in turn
    check_on(halves, TurningCell{cube<3>(8)}, HalvesInTurn{});
    const auto chosen = random_cuts(random, cube<3>(8), 8, 9);  // axis and place chosen
    check_on(chosen, cube<3>(8), Cuts{});
    check_on(random_unequal(random, cube<2>(16), 4), cube<2>(16), Orthants{});
  }
}

// LAW path.1, path.2
TEST(Path, GoesDownAndUp) {
  const auto t = Tree<int>::terminal;
  const Tree<int> tree = Tree<int>::interior({t(1), Tree<int>::interior({t(2), t(3), t(4)})});
  Path path(tree, NamedCell{"r"}, ByName{});
  EXPECT_TRUE(path.is_root());
  path.down(1);
  path.down(2);
  EXPECT_EQ(path.cell().name, "r12");
  EXPECT_EQ(path.node().terminal(), 4);
  EXPECT_EQ(path.depth(), 2U);
  EXPECT_EQ(path.index(), 2U);
  EXPECT_THROW(path.down(0), Error);
  path.up();
  EXPECT_EQ(path.node(), tree.root().child(1));
  EXPECT_EQ(path.cell().name, "r1");
  EXPECT_THROW(path.down(3), Error);
  path.up();
  EXPECT_EQ(path.node(), tree.root());
  EXPECT_EQ(path.cell().name, "r");
  EXPECT_THROW(path.up(), Error);
}

// LAW cell.1 and locate.1
TEST(Path, LocatesPoints) {
  on_every_division(
      1, [](auto&, const auto& tree, const auto& cell, const auto& division, const auto& all) {
        constexpr std::size_t dimension = std::tuple_size_v<decltype(cell.lower)>;
        for_each_point<dimension>(cell.upper[0], [&](const auto& point) {
          const auto path = locate(tree, cell, division, point);
          ASSERT_TRUE(contains(path.cell(), point));
          const auto holds = [&](const auto& entry) { return contains(entry.second, point); };
          ASSERT_EQ(std::ranges::count_if(all, holds), 1);
          ASSERT_EQ(path.node().terminal(), std::ranges::find_if(all, holds)->first);
        });
      });
  const auto tree = Tree<int>::terminal(1);
  EXPECT_THROW(locate(tree, cube<1>(4), Orthants{}, std::array{4}), Error);
}

// LAW neighbours.1
TEST(Path, FindsNeighboursAcrossEveryFace) {
  on_every_division(2, [](auto& random, const auto& tree, const auto& cell, const auto& division,
                          const auto& all) {
    using C = std::remove_cvref_t<decltype(cell)>;
    constexpr std::size_t dimension = std::tuple_size_v<decltype(cell.lower)>;
    for (int query = 0; query < 20; ++query) {
      Coordinates<int, dimension> point;
      for (int& x : point) x = below(random, cell.upper[0]);
      const auto path = locate(tree, cell, division, point);
      const C& own = path.cell();
      for (std::size_t axis = 0; axis < dimension; ++axis) {
        for (const Side side : {Side::Lower, Side::Upper}) {
          std::vector<Coordinates<int, dimension>> found;
          neighbours(path, axis, side, [&](int, const C& c) { found.push_back(c.lower); });
          std::vector<Coordinates<int, dimension>> expected;
          for (const auto& entry : all) {
            const C& c = entry.second;
            bool next = side == Side::Lower ? c.upper[axis] == own.lower[axis]
                                            : c.lower[axis] == own.upper[axis];
            for (std::size_t a = 0; a < dimension; ++a) {
              const int from = std::max(c.lower[a], own.lower[a]);
              next = next && (a == axis || from < std::min(c.upper[a], own.upper[a]));
            }
            // Cells without extent, where the grid ends, touch nothing.
            if (next && !is_empty(c)) expected.push_back(c.lower);
          }
          std::ranges::sort(found);
          std::ranges::sort(expected);
          ASSERT_EQ(found, expected);
        }
      }
    }
  });
}

// LAW ray.1: the parts found are those of all cells, clipped one by one and sorted; they follow
// each other without gap and overlap.
TEST(RayWalk, PassesEveryCellOnceInOrder) {
  on_every_division(3, [](auto& random, const auto& tree, const auto& cell, const auto& division,
                          const auto& all) {
    using C = std::remove_cvref_t<decltype(cell)>;
    constexpr std::size_t dimension = std::tuple_size_v<decltype(cell.lower)>;
    for (int query = 0; query < 12; ++query) {
      Ray<Rational, dimension> ray;
      for (std::size_t axis = 0; axis < dimension; ++axis) {
        // Often in the faces and through the corners of cells, and against the axes.
        ray.origin[axis] = Rational(below(random, 50) - 10, 1 + below(random, 3));
        ray.origin[axis].canonicalize();
        ray.direction[axis] = below(random, 5) - 2;
      }
      if (std::ranges::all_of(ray.direction, [](const Rational& d) { return d == 0; })) continue;
      std::vector<std::pair<int, RayPart<Rational>>> found;
      walk_ray(tree, cell, division, ray,
               [&](int value, const C& c, const RayPart<Rational>& part) {
                 const Rational middle = (part.begin + part.end) / 2;
                 Coordinates<Rational, dimension> point;
                 for (std::size_t axis = 0; axis < dimension; ++axis) {
                   point[axis] = ray.origin[axis] + middle * ray.direction[axis];
                 }
                 EXPECT_TRUE(contains(c, point));
                 found.push_back({value, part});
               });
      const auto whole = clip(ray, cell);
      ASSERT_EQ(whole.has_value(), !found.empty());
      if (!whole) continue;
      ASSERT_EQ(found.front().second.begin, whole->begin);
      ASSERT_EQ(found.front().second.has_begin, whole->has_begin);
      ASSERT_EQ(found.back().second.end, whole->end);
      ASSERT_EQ(found.back().second.has_end, whole->has_end);
      for (std::size_t i = 1; i < found.size(); ++i) {
        ASSERT_EQ(found[i - 1].second.end, found[i].second.begin);
        ASSERT_NE(found[i - 1].second.has_end, found[i].second.has_begin);
      }
      std::size_t passed = 0;
      for (const auto& entry : all) passed += clip(ray, entry.second) ? 1U : 0U;
      ASSERT_EQ(found.size(), passed);
    }
  });
}

// A ray along the main diagonal of an octree meets cells in corners only; it ends at the first
// full.
TEST(RayWalk, EndsWhereTheVisitorSays) {
  const auto t = Tree<int>::terminal;
  std::vector<Tree<int>> octants(8, t(0));
  octants[7] = t(1);
  const Tree<int> tree = Tree<int>::interior(octants);
  const Ray<Rational, 3> diagonal{{-1, -1, -1}, {1, 1, 1}};
  int cells = 0;
  Rational entry = 0;
  const auto first_full = [&](int full, const auto&, const RayPart<Rational>& part) {
    ++cells;
    entry = part.begin;
    return full == 1;
  };
  EXPECT_TRUE(walk_ray(tree, cube<3>(4), Orthants{}, diagonal, first_full));
  EXPECT_EQ(cells, 2);
  EXPECT_EQ(entry, 3);
  const Ray<Rational, 3> away{{5, 5, 5}, {1, 0, 0}};
  EXPECT_FALSE(walk_ray(tree, cube<3>(4), Orthants{}, away, first_full));
  const Ray<Rational, 3> nowhere{{1, 1, 1}, {0, 0, 0}};
  EXPECT_THROW(walk_ray(tree, cube<3>(4), Orthants{}, nowhere, first_full), Error);
}

// LAW follow.1: the children in reverse, up to the third terminal.
TEST(Follow, TakesTheOrderOfChoose) {
  const auto t = Tree<int>::terminal;
  const Tree<int> tree =
      Tree<int>::interior({t(1), Tree<int>::interior({t(2), t(3)}), Tree<int>::interior({}), t(4)});
  std::vector<int> visited;
  const auto backwards = [](int depth, const Tree<int>::Node& node, auto&& receive) {
    for (std::size_t i = node.degree(); i-- > 0;) receive(i, depth + 1);
  };
  EXPECT_TRUE(follow(tree, 0, backwards, [&](int value, int depth) {
    EXPECT_EQ(depth, value == 2 || value == 3 ? 2 : 1);
    visited.push_back(value);
    return visited.size() == 3;
  }));
  EXPECT_EQ(visited, (std::vector{4, 3, 2}));
  EXPECT_FALSE(follow(tree, 0, backwards, [](int, int) {}));
}

// A tree of a thousand levels, and one of 300 000: located, walked through, neighbours found.
TEST(Path, DeepTrees) {
  for (const int n : {1000, 300'000}) {
    const auto tree = create(
        std::pair(0, n), [](const auto& p) { return p.second - p.first == 1; },
        [](const auto& p) {
          return std::array{std::pair(p.first, p.first + 1), std::pair(p.first + 1, p.second)};
        },
        [](const auto& p) { return p.first; }, unlimited_depth, skeleton::SequentialExecutor{},
        [](const auto& p) {
          return Cut<int>{0, p.first + 1};
        });
    const Cell<int, 1> cell{{0}, {n}};
    const auto last = locate(tree, cell, Cuts{}, std::array{n - 1});
    EXPECT_EQ(last.depth(), static_cast<std::size_t>(n - 1));
    int left = -1;
    neighbours(last, 0, Side::Lower, [&](int value, const Cell<int, 1>&) { left = value; });
    EXPECT_EQ(left, n - 2);
    int next = 0;
    walk_ray(
        tree, cell, Cuts{}, Ray<double, 1>{{0.0}, {1.0}},
        [&](int value, const Cell<int, 1>&, const RayPart<double>&) { EXPECT_EQ(value, next++); });
    EXPECT_EQ(next, n);
  }
}

}  // namespace
}  // namespace exactcsg::gdt
