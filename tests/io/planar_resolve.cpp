// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>

#include "exactcsg/io/planar/outline.hpp"
#include "planar_support.hpp"

namespace exactcsg::io::test {
namespace {

TEST(PlanarResolve, KeepsASimplePolygonAndTurnsItCounterClockwise) {
  const PlanarFigure square = resolve(figure({{{0, 0}, {0, 2}, {2, 2}, {2, 0}}}));
  ASSERT_EQ(square.paths.size(), 1U);
  EXPECT_EQ(square.paths[0].size(), 4U);
  EXPECT_EQ(area(square.paths[0]), 4);  // clockwise in, counter-clockwise out
}

TEST(PlanarResolve, DropsStraightRepeatedAndSpikeVertices) {
  const PlanarFigure square =
      resolve(figure({{{0, 0}, {1, 0}, {1, 0}, {2, 0}, {2, 2}, {2, 5}, {2, 2}, {0, 2}, {0, 1}}}));
  ASSERT_EQ(square.paths.size(), 1U);
  EXPECT_EQ(square.paths[0].size(), 4U);
  EXPECT_EQ(area(square.paths), 4);
}

TEST(PlanarResolve, BooleansOfTwoSquares) {
  // Unit steps: [0,2]^2 and [1,3]^2 share a unit square.
  const PlanarTree a = box(0, 0, 2, 2);
  const PlanarTree b = box(1, 1, 3, 3);
  EXPECT_EQ(area(csg::unite(a, b)), 7);
  EXPECT_EQ(area(csg::intersect(a, b)), 1);
  EXPECT_EQ(area(csg::subtract(a, b)), 3);
  EXPECT_EQ(area(csg::symmetric_difference(a, b)), 6);
  EXPECT_EQ(resolve(csg::unite(a, b)).paths[0].size(), 8U);
}

TEST(PlanarResolve, OperatorsFoldFromTheLeft) {
  const auto tree = PlanarTree::compose(csg::BooleanOperator::Difference,
                                        {box(0, 0, 4, 1), box(0, 0, 1, 1), box(3, 0, 4, 1)});
  EXPECT_EQ(area(tree), 2);
}

TEST(PlanarResolve, FlushSquaresBecomeOneAndTouchingOnesVanish) {
  const PlanarTree a = box(0, 0, 1, 1);
  const PlanarTree b = box(1, 0, 2, 1);
  const PlanarFigure joined = resolve(csg::unite(a, b));
  ASSERT_EQ(joined.paths.size(), 1U);
  EXPECT_EQ(joined.paths[0].size(), 4U);
  EXPECT_TRUE(resolve(csg::intersect(a, b)).paths.empty());  // a segment is not regular
  EXPECT_TRUE(resolve(csg::subtract(a, a)).paths.empty());
}

TEST(PlanarResolve, EvenOddOfOnePath) {
  // A bow tie: two triangles of area 1 that meet in (1, 1).
  const PlanarFigure bow = resolve(figure({{{0, 0}, {2, 2}, {2, 0}, {0, 2}}}));
  EXPECT_EQ(bow.paths.size(), 2U);
  EXPECT_EQ(area(bow.paths), 2);
  // Two crossing triangles of area 18 in one figure: the hexagon they share (12: its width is 2, 4,
  // 2 at heights 0, 2, 4) is covered twice, so it is outside: 18 + 18 - 2 * 12.
  const PlanarFigure star = resolve(figure({{{0, 0}, {6, 0}, {3, 6}}, {{0, 4}, {6, 4}, {3, -2}}}));
  EXPECT_EQ(star.paths.size(), 6U);
  EXPECT_EQ(area(star.paths), 12);
  // A pentagram in one stroke: its middle is covered twice, the five tips are left.
  const Path pentagram{{0, 30}, {18, -24}, {-29, 9}, {29, 9}, {-18, -24}};
  EXPECT_EQ(resolve(figure({pentagram})).paths.size(), 5U);
}

TEST(PlanarResolve, CoincidentEdgesCancelByParity) {
  // The same square twice in one figure is nothing; three times, the square.
  const Path square = rectangle(0, 0, 1, 1);
  EXPECT_TRUE(resolve(figure({square, square})).paths.empty());
  EXPECT_EQ(area(figure({square, square, square})), 1);
  // In two figures of a union it is the square.
  EXPECT_EQ(area(csg::unite(figure({square}), figure({square}))), 1);
  // Two rectangles of one figure with a partly common edge: the edge is inside.
  const PlanarFigure joined = resolve(figure({rectangle(0, 0, 1, 2), rectangle(1, 1, 2, 3)}));
  ASSERT_EQ(joined.paths.size(), 1U);
  EXPECT_EQ(area(joined.paths), 4);
}

TEST(PlanarResolve, HolesAreClockwiseAndIslandsCounterClockwise) {
  const PlanarFigure rings =
      resolve(figure({rectangle(0, 0, 10, 10), rectangle(1, 1, 9, 9), rectangle(2, 2, 8, 8)}));
  ASSERT_EQ(rings.paths.size(), 3U);
  EXPECT_EQ(area(rings.paths), 100 - 64 + 36);
  EXPECT_EQ(std::count_if(rings.paths.begin(), rings.paths.end(),
                          [](const Path& path) { return area(path) < 0; }),
            1);
}

TEST(PlanarResolve, LoopsThatTouchAreSimple) {
  // LAW outline.1: a hole that touches the outer boundary in a corner of the hole.
  const PlanarTree touched = csg::subtract(box(0, 0, 4, 4), figure({{{2, 0}, {3, 2}, {1, 2}}}));
  const PlanarFigure outline = resolve(touched);
  EXPECT_EQ(area(outline.paths), 14);
  for (const Path& path : outline.paths) {
    for (std::size_t i = 0; i < path.size(); ++i) {
      EXPECT_EQ(std::count(path.begin(), path.end(), path[i]), 1);
    }
  }
  // LAW outline.3: the point where the hole touches is a vertex of the outer loop as well.
  ASSERT_EQ(outline.paths.size(), 2U);
  EXPECT_EQ(outline.paths[0].size() + outline.paths[1].size(), 5U + 3U);
  // Two squares that touch in a corner are two components.
  EXPECT_EQ(outline_of(csg::unite(box(0, 0, 1, 1), box(1, 1, 2, 2))).components.size(), 2U);
  // A ring pinched at one vertex is one component with one hole.
  const Outline pinched =
      outline_of(csg::subtract(box(0, 0, 4, 4), figure({{{0, 0}, {3, 1}, {3, 3}, {1, 3}}})));
  ASSERT_EQ(pinched.components.size(), 1U);
  EXPECT_EQ(pinched.components[0].loops.size(), 2U);
}

TEST(PlanarResolve, ACheckerboardOfTouchingSquares) {
  std::vector<PlanarTree> squares;
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 8; ++j) {
      if ((i + j) % 2 == 0) squares.push_back(box(i, j, i + 1, j + 1));
    }
  }
  const PlanarTree board = PlanarTree::compose(csg::BooleanOperator::Union, squares);
  EXPECT_EQ(area(board), 32);
  EXPECT_EQ(outline_of(board).components.size(), 32U);
  // The complement in the whole board is the other colour: also 32.
  const PlanarTree other = csg::subtract(box(0, 0, 8, 8), board);
  EXPECT_EQ(area(other), 32);
  EXPECT_EQ(area(csg::unite(board, other)), 64);
}

Path backwards(Path path) {
  std::reverse(path.begin(), path.end());
  return path;
}

TEST(PlanarResolveWinding, CountsTheTurnsOfAllPaths) {
  // Squares of area 4 that share one of area 1.
  const Path a = rectangle(0, 0, 2, 2);
  const Path b = rectangle(1, 1, 3, 3);
  EXPECT_EQ(area(resolve_winding({a, b}).paths), 7);
  EXPECT_EQ(area(resolve_winding({backwards(a), backwards(b)}).paths), 7);
  // The common square is gone round once in either sense.
  EXPECT_EQ(area(resolve_winding({a, backwards(b)}).paths), 6);
  EXPECT_EQ(area(resolve_winding({a, b, a}).paths), 7);
  EXPECT_TRUE(resolve_winding({a, backwards(a)}).paths.empty());
  EXPECT_EQ(area(resolve_winding({a, backwards(a), b}).paths), 4);
  EXPECT_TRUE(resolve_winding({}).paths.empty());
}

TEST(PlanarResolveWinding, AgreesWithEvenOddOnPathsThatDoNotMeet) {
  // An annulus with an island, each path against the one round it.
  const std::vector<Path> rings{rectangle(0, 0, 10, 10), backwards(rectangle(1, 1, 9, 9)),
                                rectangle(2, 2, 8, 8)};
  EXPECT_EQ(area(resolve_winding(rings).paths), 100 - 64 + 36);
  EXPECT_EQ(resolve_winding(rings).paths.size(), resolve(figure(rings)).paths.size());
  // All in one sense there is no hole.
  EXPECT_EQ(area(resolve_winding({rings[0], backwards(rings[1]), rings[2]}).paths), 100);
}

TEST(PlanarResolveWinding, FillsAPathThatCrossesItself) {
  // Of the pentagram no middle is left out. A bow tie is gone round in both senses.
  const Path pentagram{{0, 30}, {18, -24}, {-29, 9}, {29, 9}, {-18, -24}};
  EXPECT_EQ(resolve_winding({pentagram}).paths.size(), 1U);
  EXPECT_EQ(resolve_winding({backwards(pentagram)}).paths.size(), 1U);
  EXPECT_EQ(area(resolve_winding({{{0, 0}, {2, 2}, {2, 0}, {0, 2}}}).paths), 2);
  // A spike has no area.
  EXPECT_EQ(area(resolve_winding({{{0, 0}, {2, 0}, {2, 2}, {2, 5}, {2, 2}, {0, 2}}}).paths), 4);
}

TEST(PlanarResolve, UnboundedSetsAreRefused) {
  try {
    resolve(csg::complement(box(0, 0, 1, 1)));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.id(), ErrorId::UnboundedSolid);
  }
  EXPECT_EQ(area(csg::intersect(box(0, 0, 2, 2), csg::complement(box(0, 0, 1, 1)))), 3);
}

// LAW network.1, and no recursion: a chain as deep as there are nodes.
TEST(PlanarResolve, ADeepChainOfSharedAndDistinctFigures) {
  PlanarTree chain = box(0, 0, 1, 1);
  const PlanarTree again = chain;
  for (int i = 0; i < 100'000; ++i) chain = csg::unite(std::move(chain), again);
  chain = csg::subtract(std::move(chain), box(0, 0, Rational(1, 2), 1));
  EXPECT_EQ(area(chain), Rational(1, 2));
}

TEST(PlanarResolve, LawsOnRandomTrees) {
  // v(A+B) + v(A*B) = v(A) + v(B); v(A-B) + v(A*B) = v(A): on boxes of a coarse grid, so that most
  // edges coincide.
  std::uint32_t state = 12345;
  const auto random = [&](std::uint32_t n) {
    state = state * 1664525U + 1013904223U;
    return static_cast<int>((state >> 16U) % n);
  };
  for (int round = 0; round < 60; ++round) {
    const auto tree = [&] {
      std::vector<PlanarTree> members;
      for (int i = 0; i < 5; ++i) {
        const int x = random(6);
        const int y = random(6);
        members.push_back(random(2) == 0
                              ? box(x, y, x + 1 + random(4), y + 1 + random(4))
                              : figure({{{x, y}, {x + 1 + random(4), y}, {x, y + 1 + random(4)}}}));
      }
      const auto op = static_cast<csg::BooleanOperator>(random(4));
      return csg::unite(members[4],
                        PlanarTree::compose(op, {members.begin(), members.begin() + 4}));
    };
    const PlanarTree a = tree();
    const PlanarTree b = tree();
    EXPECT_EQ(area(csg::unite(a, b)) + area(csg::intersect(a, b)), area(a) + area(b)) << round;
    EXPECT_EQ(area(csg::subtract(a, b)) + area(csg::intersect(a, b)), area(a)) << round;
    EXPECT_EQ(area(csg::symmetric_difference(a, b)),
              area(csg::unite(a, b)) - area(csg::intersect(a, b)))
        << round;
  }
}

TEST(PlanarResolve, APlateWith2500Circles) {
  std::vector<PlanarTree> members{box(-1, -1, 150, 150)};
  for (int i = 0; i < 50; ++i) {
    for (int j = 0; j < 50; ++j)
      members.push_back(figure({circle(3 * i, 3 * j, Rational(1, 2), 30)}));
  }
  const Rational hole = area(circle(0, 0, Rational(1, 2), 30));
  const auto start = std::chrono::steady_clock::now();
  const Rational plate = area(PlanarTree::compose(csg::BooleanOperator::Difference, members));
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  EXPECT_EQ(plate, 151 * 151 - 2500 * hole);
  RecordProperty("seconds", std::to_string(seconds.count()));
  EXPECT_LT(seconds.count(), 60);  // a few seconds; generous for sanitizers and busy machines
}

TEST(PlanarConvexParts, CoverTheFigureWithoutNewVertices) {
  const std::vector<PlanarTree> trees{
      figure({{{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}}),                       // L
      figure({rectangle(0, 0, 10, 10), rectangle(1, 1, 9, 9), rectangle(2, 2, 8, 8)}),  // rings
      csg::subtract(box(0, 0, 4, 4), figure({{{2, 0}, {3, 2}, {1, 2}}})),               // touched
      figure({{{0, 0}, {2, 2}, {2, 0}, {0, 2}}}),                                       // bow tie
      csg::subtract(box(-9, -9, 9, 9), figure({circle(0, 0, 5, 24)}))};
  for (const PlanarTree& tree : trees) {
    const PlanarFigure outline = resolve(tree);
    const auto parts = convex_parts(outline);
    EXPECT_EQ(area(parts), area(outline.paths));
    for (const Path& part : parts) {
      for (std::size_t i = 0; i < part.size(); ++i) {
        const Point2& a = part[i];
        const Point2& b = part[(i + 1) % part.size()];
        const Point2& c = part[(i + 2) % part.size()];
        EXPECT_GT((b.x - a.x) * (c.y - b.y), (b.y - a.y) * (c.x - b.x));
        EXPECT_TRUE(std::any_of(outline.paths.begin(), outline.paths.end(), [&](const Path& path) {
          return std::find(path.begin(), path.end(), a) != path.end();
        }));
      }
    }
  }
  EXPECT_EQ(convex_parts({{circle(0, 0, 1, 100)}}).size(), 1U);
  EXPECT_LE(convex_parts(resolve(trees[0])).size(), 2U);
}

TEST(PlanarApply, MapsFiguresAndKeepsSharing) {
  const PlanarTree square = box(0, 0, 1, 1);
  const PlanarTree twice = csg::unite(square, square);
  const AffineMap2 map{{{{{2, 1, 5}}, {{0, -3, 7}}}}};
  const PlanarTree image = apply(map, twice);
  EXPECT_EQ(area(image), 6);  // |det| = 6
  EXPECT_TRUE(same_handle(image.children()[0], image.children()[1]));
  EXPECT_TRUE(apply({{{{{1, 2, 0}}, {{2, 4, 0}}}}}, twice).is_empty());
}

TEST(PlanarHull, DropsWhatBoundsNoArea) {
  // A square of side 3 without two corners of legs 2.
  EXPECT_EQ(area(hull(csg::unite(box(0, 0, 1, 1), box(2, 2, 3, 3)))), 9 - 2 * 2);
  // A hair (a path there and back) is not part of the regularised set.
  EXPECT_EQ(hull(figure({{{0, 0}, {1, 0}, {9, 0}, {1, 0}, {1, 1}, {0, 1}}})).size(), 4U);
  EXPECT_LT(hull(csg::intersect(box(0, 0, 1, 1), box(1, 0, 2, 1))).size(), 3U);
  // The part cut away does not count.
  EXPECT_EQ(area(hull(csg::subtract(box(0, 0, 4, 1), box(2, 0, 4, 1)))), 2);
}

}  // namespace
}  // namespace exactcsg::io::test
