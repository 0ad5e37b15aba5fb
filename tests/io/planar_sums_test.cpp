// SPDX-License-Identifier: GPL-3.0-or-later
// Offsets, shadows, sections and Minkowski sums of sets of unit squares and cubes, against counting
// the squares and cubes; and the laws of their headers.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <set>

#include "exactcsg/io/planar/minkowski.hpp"
#include "exactcsg/io/planar/offset.hpp"
#include "exactcsg/io/planar/projection.hpp"
#include "exactcsg/solid/evaluate.hpp"
#include "exactcsg/solid/measures.hpp"
#include "planar_support.hpp"

namespace exactcsg::io {
namespace {

using csg::BooleanOperator;

using Cell = std::array<int, 3>;
using Cells = std::set<Cell>;

// Each cell of the block of this size, or not; at least one.
Cells some_cells(const Cell& size) {
  Cells cells;
  for (int x = 0; x < size[0]; ++x) {
    for (int y = 0; y < size[1]; ++y) {
      for (int z = 0; z < size[2]; ++z) {
        if (*rc::gen::inRange(0, 3) != 0) cells.insert({x, y, z});
      }
    }
  }
  if (cells.empty()) cells.insert({0, 0, 0});
  return cells;
}

// As a block less the cells that are missing: no union that could be taken apart.
Solid carved(const Cells& cells, const Cell& size, int lift = 0) {
  std::vector<Solid> operands{
      Solid::primitive({make_box({0, 0, lift}, {size[0], size[1], size[2] + lift})})};
  for (int x = 0; x < size[0]; ++x) {
    for (int y = 0; y < size[1]; ++y) {
      for (int z = 0; z < size[2]; ++z) {
        if (cells.count({x, y, z}) != 0) continue;
        operands.push_back(
            Solid::primitive({make_box({x, y, z + lift}, {x + 1, y + 1, z + 1 + lift})}));
      }
    }
  }
  if (operands.size() == 1) return operands.front();
  return Solid::compose(BooleanOperator::Difference, std::move(operands));
}

PlanarTree squares(const Cells& cells) {
  std::vector<PlanarTree> figures;
  for (const auto& [x, y, z] : cells) figures.push_back(test::box(x, y, x + 1, y + 1));
  return PlanarTree::compose(BooleanOperator::Union, std::move(figures));
}

// The sum of two unit cubes is a cube of side 2.
std::size_t cells_of_sum(const Cells& a, const Cells& b, int depth) {
  Cells sum;
  for (const auto& [x, y, z] : a) {
    for (const auto& [u, v, w] : b) {
      for (int i = 0; i < 2; ++i) {
        for (int j = 0; j < 2; ++j) {
          for (int k = 0; k < depth; ++k) sum.insert({x + u + i, y + v + j, z + w + k});
        }
      }
    }
  }
  return sum.size();
}

Rational volume(const Solid& solid) { return *exact_volume(evaluate(solid)); }
Rational count(std::size_t n) { return Rational(static_cast<unsigned long>(n)); }

RC_GTEST_PROP(MinkowskiSum, OfCarvedBlocksCountsCells, ()) {
  const Cell size{2, 2, 1};
  const Cell other_size{2, 1, 2};
  const Cells a = some_cells(size);
  const Cells b = some_cells(other_size);
  RC_ASSERT(volume(minkowski_sum(carved(a, size), carved(b, other_size))) ==
            count(cells_of_sum(a, b, 2)));
}

// LAW minkowski.1
RC_GTEST_PROP(MinkowskiSum, CommutesWithAPolytope, ()) {
  const Cell size{3, 2, 2};
  const Cells a = some_cells(size);
  const Solid cube = Solid::primitive({make_box({0, 0, 0}, {1, 1, 1})});
  const Boundary left = evaluate(minkowski_sum(carved(a, size), cube));
  RC_ASSERT(*exact_volume(left) == count(cells_of_sum(a, {{0, 0, 0}}, 2)));
  RC_ASSERT(digest(left) == digest(evaluate(minkowski_sum(cube, carved(a, size)))));
}

// LAW minkowski.2: an octahedron and half of it.
TEST(MinkowskiSum, OfAPolytopeAndItsMultipleIsAMultiple) {
  const auto octahedron = [](const Rational& r) {
    const std::vector<Point3> points{{r, 0, 0}, {Rational(-r), 0, 0},
                                     {0, r, 0}, {0, Rational(-r), 0},
                                     {0, 0, r}, {0, 0, Rational(-r)}};
    return hull(points);
  };
  EXPECT_EQ(digest(evaluate(minkowski_sum(octahedron(1), octahedron(Rational(1, 2))))),
            digest(evaluate(octahedron(Rational(3, 2)))));
}

TEST(MinkowskiSum, RefusesWhatIsTooLarge) {
  std::vector<Point3> points;
  for (int i = 0; i < 5000; ++i) points.push_back({i, i * i, i * i * i});
  const Solid many = hull(points);
  try {
    minkowski_sum(many, many);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.id(), ErrorId::TooLarge);
  }
}

RC_GTEST_PROP(MinkowskiSum, OfSquaresCountsSquares, ()) {
  const Cells a = some_cells({4, 4, 1});
  const Cells b = some_cells({3, 2, 1});
  RC_ASSERT(test::area(minkowski_sum(squares(a), squares(b))) == count(cells_of_sum(a, b, 1)));
}

Offset sharp(const Rational& distance) { return {distance, OffsetCorner::Sharp}; }

Rational area_of(const OffsetResult& result) { return test::area(result.figure.paths); }

// With right angles alone, a sharp offset by 1 is the sum with the square [-1, 1]^2, and shrinking
// is growing what is not there.
RC_GTEST_PROP(PlanarOffset, OfSquaresIsTheSumWithASquare, ()) {
  const PlanarTree figure = squares(some_cells({4, 4, 1}));
  const PlanarTree square = test::box(-1, -1, 1, 1);
  RC_ASSERT(area_of(offset(figure, sharp(1))) == test::area(minkowski_sum(figure, square)));
  const PlanarTree frame = test::box(-9, -9, 9, 9);
  const PlanarTree rest = PlanarTree::compose(BooleanOperator::Difference, {frame, figure});
  const Rational grown_rest = test::area(
      PlanarTree::compose(BooleanOperator::Intersection,
                          {frame, minkowski_sum(rest, test::box(Rational(-1, 4), Rational(-1, 4),
                                                                Rational(1, 4), Rational(1, 4)))}));
  RC_ASSERT(area_of(offset(figure, sharp(Rational(-1, 4)))) == 18 * 18 - grown_rest);
}

// LAW offset.1 and LAW offset.2
TEST(PlanarOffset, AddsUpOnConvexPolygons) {
  const PlanarTree triangle = test::figure({{{0, 0}, {4, 0}, {0, 3}}});
  EXPECT_EQ(area_of(offset(triangle, sharp(0))), 6);
  const OffsetResult once = offset(triangle, sharp(Rational(1, 3)));
  const OffsetResult twice = offset(PlanarTree::primitive(once.figure), sharp(Rational(2, 3)));
  EXPECT_EQ(once.rounding, 0);
  EXPECT_EQ(area_of(twice), 24);
  EXPECT_EQ(area_of(offset(triangle, sharp(1))), 24);
}

// Every corner of a fine circle is nearly straight; its offset is the circle of the larger radius.
TEST(PlanarOffset, OfACircleIsACircle) {
  const PlanarTree circle = test::figure({test::circle(0, 0, 10, 200)});
  const OffsetResult grown = offset(circle, sharp(Rational(1, 2)));
  const double inner = 10 * std::cos(M_PI / 200) + 0.5;
  EXPECT_NEAR(nearest_double(area_of(grown)), inner * inner * 200 * std::tan(M_PI / 200), 1e-9);
  EXPECT_EQ(grown.figure.paths.size(), 1U);
  EXPECT_EQ(grown.figure.paths[0].size(), 200U);
  EXPECT_GT(grown.rounding, 0);
}

// Edges that turn by less than doubles can tell are not prolonged to where they would meet.
TEST(PlanarOffset, DoesNotProlongNearlyParallelEdges) {
  const Rational tiny(1, Integer(1) << 60U);
  const PlanarTree figure = test::figure({{{0, 0}, {1, Rational(-tiny)}, {2, 0}, {2, 1}, {0, 1}}});
  const OffsetResult grown = offset(figure, sharp(1));
  for (const Point2& p : grown.figure.paths.at(0)) {
    EXPECT_LT(abs(p.x - 1), Rational(21, 10));
    EXPECT_LT(abs(p.y), Rational(21, 10));
  }
  EXPECT_NEAR(nearest_double(area_of(grown)), 12, 1e-12);
}

RC_GTEST_PROP(Projection, OfCarvedBlocksCountsColumns, ()) {
  const Cell size{3, 3, 3};
  const Cells cells = some_cells(size);
  std::set<std::array<int, 2>> columns;
  std::set<std::array<int, 2>> cut;
  for (const auto& [x, y, z] : cells) {
    columns.insert({x, y});
    if (z == 0 || z == 1) cut.insert({x, y});  // next to the plane, once lowered by 1
  }
  const Solid solid = carved(cells, size, -1);
  RC_ASSERT(test::area(shadow(solid)) == count(columns.size()));
  RC_ASSERT(test::area(section(solid)) == count(cut.size()));
}

// LAW projection.1: of polytopes and meshes, without an evaluation, as of the same with one.
TEST(Projection, OfAUnionIsTheUnionOfShadows) {
  const Solid tilted = hull(std::vector<Point3>{{0, 0, 0}, {4, 1, 2}, {1, 5, 3}, {2, 2, 7}});
  const Solid box = Solid::primitive({make_box({3, 3, 0}, {6, 6, 1})});
  const Solid both = Solid::compose(BooleanOperator::Union, {tilted, box});
  const Solid evaluated = Solid::compose(
      BooleanOperator::Intersection, {both, Solid::primitive({make_box({-9, -9, -9}, {9, 9, 9})})});
  EXPECT_EQ(test::area(shadow(both)), test::area(shadow(evaluated)));
}

}  // namespace
}  // namespace exactcsg::io
