// SPDX-License-Identifier: GPL-3.0-or-later
// The planar evaluator against the arrangement, against closed forms, and at its limits.

#include "exactcsg/planar/outline.hpp"

#include <gtest/gtest.h>

#include "planar/arrangement_outline.hpp"
#include "planar/chain.hpp"
#include "planar/normal_outline.hpp"
#include "planar/random_figures.hpp"

namespace exactcsg::test {
namespace {

using csg::BooleanOperator;
using io::AffineMap2;
using io::test::box;
using io::test::circle;
using io::test::figure;
using io::test::rectangle;

const AffineMap2 identity{{{{{1, 0, 0}}, {{0, 1, 0}}}}};

void expect_as_arrangement(const PlanarTree& tree, const std::string& what) {
  std::vector<NormalComponent> expected;
  try {
    expected = normal(arrangement_outline(tree));
  } catch (const Error& error) {
    EXPECT_EQ(error.id(), ErrorId::UnboundedSolid);
    EXPECT_THROW(outline_of(tree), Error) << what;
    return;
  }
  for (const std::size_t edges_per_cell : {1, 3, 8, 1000}) {
    const Outline outline = outline_of(tree, {edges_per_cell});
    EXPECT_TRUE(normal(outline) == expected) << what << " with " << edges_per_cell;
    expect_simple_loops(outline);
  }
}

struct Lattice {
  const char* name;
  AffineMap2 map;
};

std::vector<Lattice> lattices() {
  const Rational third(1, 3);
  // Denominators too long for integers of 64 bits: certified doubles and rationals decide.
  Rational tiny(1, 7);
  for (int i = 0; i < 6; ++i) tiny *= Rational(1000003, 999983);
  return {
      {"integers", identity},
      {"doubles that walls fall on", {{{{{128, 0, 0}}, {{0, 128, 59}}}}}},
      {"turned by 3-4-5",
       {{{{{Rational(3, 5), Rational(-4, 5), third}},
          {{Rational(4, 5), Rational(3, 5), -third}}}}}},
      {"long denominators", {{{{{tiny, 0, third}}, {{0, tiny, tiny}}}}}},
      {"long denominators, sheared", {{{{{tiny, tiny * third, third}}, {{-third, tiny, 0}}}}}},
      {"far away",
       {{{{{1, 0, Rational("100000000000000000")}}, {{0, 1, Rational("-300000000000000000")}}}}}}};
}

TEST(PlanarOutline, EqualsTheArrangementOnRandomTreesOfFewPoints) {
  for (const Lattice& lattice : lattices()) {
    for (std::uint32_t seed = 0; seed < 60; ++seed) {
      RandomFigures random(seed, 2 + static_cast<int>(seed % 4), lattice.map);
      expect_as_arrangement(random.tree(2), lattice.name + (" " + std::to_string(seed)));
    }
  }
}

TEST(PlanarOutline, EqualsTheArrangementOnRandomTreesOfManyPoints) {
  for (const Lattice& lattice : lattices()) {
    for (std::uint32_t seed = 0; seed < 12; ++seed) {
      RandomFigures random(seed + 1000, 12 + 30 * static_cast<int>(seed % 2), lattice.map);
      expect_as_arrangement(random.tree(3), lattice.name + (" " + std::to_string(seed)));
    }
  }
}

TEST(PlanarOutline, EqualsTheArrangementOnSingleFiguresThatCrossThemselves) {
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    RandomFigures random(seed + 5000, 3 + static_cast<int>(seed % 10), identity);
    expect_as_arrangement(PlanarTree::primitive(random.figure()), std::to_string(seed));
  }
}

// Many components with holes, islands in them, and holes that touch: the tiles of a board, some of
// them rings, by symmetric difference.
TEST(PlanarOutline, EqualsTheArrangementOnBoardsOfRings) {
  for (std::uint32_t seed = 0; seed < 12; ++seed) {
    RandomFigures random(seed, 2, identity);
    std::vector<PlanarTree> members;
    for (int i = 0; i < 40; ++i) {
      const int x = random.below(12);
      const int y = random.below(12);
      const int size = 1 + random.below(6);
      members.push_back(random.below(3) != 0 ? box(x, y, x + size, y + size)
                                             : figure({{{x, y}, {x + size, y}, {x, y + size}}}));
    }
    expect_as_arrangement(
        PlanarTree::compose(BooleanOperator::SymmetricDifference, std::move(members)),
        std::to_string(seed));
  }
}

TEST(PlanarOutline, EqualsTheArrangementOnUnionsOfPolygons) {
  for (std::uint32_t seed = 0; seed < 4; ++seed) {
    RandomFigures random(seed, 2, identity);
    std::vector<PlanarTree> members;
    for (int i = 0; i < 150; ++i) {
      members.push_back(figure({circle(random.below(1000), random.below(1000),
                                       10 + random.below(90), 3 + random.below(20))}));
    }
    expect_as_arrangement(PlanarTree::compose(BooleanOperator::Union, members), "union");
    members.insert(members.begin(), box(-100, -100, 1100, 1100));
    expect_as_arrangement(PlanarTree::compose(BooleanOperator::Difference, members), "difference");
  }
}

// Closed form: the holes do not overlap.
TEST(PlanarOutline, ABlockLessAGridOfPolygons) {
  std::vector<PlanarTree> members{box(-2, -2, 62, 62)};
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 20; ++j) members.push_back(figure({circle(3 * i, 3 * j, 1, 16)}));
  }
  const Outline outline = outline_of(PlanarTree::compose(BooleanOperator::Difference, members));
  ASSERT_EQ(outline.components.size(), 1U);
  EXPECT_EQ(outline.components[0].loops.size(), 401U);
  EXPECT_EQ(area(outline), 64 * 64 - 400 * io::test::area(circle(0, 0, 1, 16)));
}

// Closed form: n triangles with a common corner and common sides are a polygon of n + 1 corners,
// the two ends of the fan and the common corner among them.
TEST(PlanarOutline, AFanOfTrianglesRoundOneCorner) {
  const int n = 500;
  std::vector<PlanarTree> members;
  const auto on_parabola = [](int i) { return Point2{i, 1'000'000 - i * i}; };
  std::vector<Point2> whole{{0, 0}};
  for (int i = 0; i <= n; ++i) whole.push_back(on_parabola(n - i));
  for (int i = 0; i < n; ++i) {
    members.push_back(figure({{{0, 0}, on_parabola(i + 1), on_parabola(i)}}));
  }
  const Outline outline = outline_of(PlanarTree::compose(BooleanOperator::Union, members));
  ASSERT_EQ(outline.components.size(), 1U);
  EXPECT_EQ(abs(area(outline)), abs(io::test::area(whole)));
  EXPECT_EQ(outline.points.size(), static_cast<std::size_t>(n) + 2);
}

// Closed form: of lines x = i and y = j as thin crosses nothing is left but the parity of the
// cells.
TEST(PlanarOutline, EvenOddOfABraid) {
  // One path of n teeth up and n teeth down, each pair of which crosses at half height.
  const int n = 50;
  std::vector<Point2> path;
  for (int i = 0; i <= 2 * n; ++i) path.push_back({i, i % 2 == 0 ? 0 : 2});
  for (int i = 2 * n; i >= 0; --i) path.push_back({i, i % 2 == 0 ? 2 : 0});
  const Outline outline = outline_of(figure({path}));
  // Between i and i + 1 the two strokes cross at (i + 1/2, 1): two triangles left and right of
  // height 1/2 and base 2 are between them.
  EXPECT_EQ(area(outline), Rational(2 * n));
  expect_as_arrangement(figure({path}), "braid");
}

// Closed form: one figure many times is that figure, or by parity nothing. No wall separates its
// edges, and evaluation is not to hold each against each.
TEST(PlanarOutline, TheSameCircleAThousandTimes) {
  std::vector<PlanarTree> members;
  for (int i = 0; i < 1000; ++i) members.push_back(figure({circle(0, 0, 10, 32)}));
  const Outline whole = outline_of(PlanarTree::compose(BooleanOperator::Union, members));
  EXPECT_EQ(whole.points.size(), 32U);
  EXPECT_EQ(area(whole), io::test::area(circle(0, 0, 10, 32)));
  EXPECT_TRUE(outline_of(PlanarTree::compose(BooleanOperator::SymmetricDifference, members))
                  .components.empty());
}

// Where a wall parts a cell in which (A * C) + B keeps A from one in which it does not, the common
// top of A and B is A's on one side, B's on the other.
TEST(PlanarOutline, ACommonEdgeOfAFigureThatIsPrunedBeyondAWall) {
  const Rational half(1, 2);
  std::vector<PlanarTree> members{csg::unite(
      csg::intersect(box(0, 0, 200, 10), box(-1, -1, 100 + half, 20)), box(0, 0, 200 + half, 10))};
  for (int i = 0; i < 99; ++i) members.push_back(box(2 * i + half, 9, 2 * i + 1 + half, 9 + half));
  const PlanarTree tree = PlanarTree::compose(BooleanOperator::Difference, members);
  const Outline outline = outline_of(tree);
  ASSERT_EQ(outline.components.size(), 1U);
  EXPECT_EQ(outline.components[0].loops.size(), 100U);
  EXPECT_EQ(outline.components[0].loops[0].size(), 4U);
  EXPECT_EQ(area(outline), (200 + half) * 10 - 99 * half);
  expect_as_arrangement(tree, "common edge");
}

TEST(PlanarOutline, CoordinatesBeyondDoubles) {
  Rational huge(Integer(1) << 5000U);
  const PlanarTree a = box(0, 0, 2 * huge, 2 * huge);
  const PlanarTree b = box(huge, huge, 3 * huge, 3 * huge);
  EXPECT_EQ(area(outline_of(csg::unite(a, b))), 7 * huge * huge);
  const Rational tiny = 1 / huge;
  const PlanarTree c = box(0, 0, 2 * tiny, 2 * tiny);
  const PlanarTree d = figure({{{tiny, tiny}, {3 * tiny, tiny}, {tiny, 3 * tiny}}});
  EXPECT_EQ(area(outline_of(csg::subtract(c, d))), 3 * tiny * tiny);
  // Both at once: the small one is a point beside the large one, but is not lost.
  EXPECT_EQ(area(outline_of(csg::symmetric_difference(a, c))), 4 * huge * huge - 4 * tiny * tiny);
}

TEST(PlanarOutline, NothingIsLeftOfFiguresWithoutArea) {
  EXPECT_TRUE(outline_of(PlanarTree::empty()).components.empty());
  EXPECT_TRUE(outline_of(figure({})).components.empty());
  EXPECT_TRUE(outline_of(figure({{{0, 0}, {1, 0}}})).components.empty());
  EXPECT_TRUE(outline_of(figure({{{0, 0}, {1, 0}, {2, 0}}})).components.empty());
  EXPECT_TRUE(outline_of(figure({{{1, 1}, {1, 1}, {1, 1}}})).components.empty());
  EXPECT_EQ(area(outline_of(csg::unite(box(0, 0, 1, 1), figure({{{5, 5}, {6, 6}, {7, 7}}})))), 1);
}

TEST(PlanarOutline, UnboundedSetsAreRefused) {
  for (const PlanarTree& tree :
       {PlanarTree::full(), csg::complement(box(0, 0, 1, 1)), csg::complement(figure({}))}) {
    try {
      outline_of(tree);
      FAIL();
    } catch (const Error& error) {
      EXPECT_EQ(error.id(), ErrorId::UnboundedSolid);
    }
  }
}

TEST(PlanarOutline, IsCancelledAndCountsItsEdges) {
  Progress progress;
  const PlanarTree tree = csg::unite(box(0, 0, 2, 2), box(1, 1, 3, 3));
  outline_of(tree, {8, &progress});
  EXPECT_STREQ(progress.stage(), "merge");
  progress.cancel();
  try {
    outline_of(tree, {8, &progress});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.id(), ErrorId::Cancelled);
  }
}

// No recursion.
TEST(PlanarOutline, ADeepChainOfFigures) {
  EXPECT_EQ(area(outline_of(chain_of_rectangles(20'000))), Rational(10'000));
}

}  // namespace
}  // namespace exactcsg::test
