// SPDX-License-Identifier: GPL-3.0-or-later
// Certified areas. Expected values: closed forms (curved_solids.hpp), exact areas of blocks, and
// the laws of complements, of parts of a box, and of a solid in a larger block.

#include "exactcsg/measure/area.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <map>

#include "measure/curved_solids.hpp"
#include "measure/random_solids.hpp"

namespace exactcsg::measure::test {
namespace {

using csg::intersect;
using csg::subtract;
using csg::unite;
using domain::LinearForm;
using domain::Quadric;

Rational exact_area(const Solid3& set, const Box<3>& box) {
  const CertifiedMeasure measure = area(set, box, to_width(0));
  EXPECT_EQ(measure.stop, StopReason::Width);
  EXPECT_EQ(measure.value.lower, measure.value.upper);
  return measure.value.lower;
}

// The width falls at least as the inverse cube of the cells.
TEST(CertifiedArea, ClosedFormsLieInTheBoundsAtEveryWidth) {
  for (const KnownSolid& known : known_solids()) {
    if (!known.area) continue;
    std::map<double, double> cells;
    for (const double width : {1e-1, 1e-3, 1e-6}) {
      const CertifiedMeasure measure = area(known.set, known.box, to_width(width));
      EXPECT_TRUE(encloses(measure.value, *known.area)) << known.name << " at " << width;
      EXPECT_EQ(measure.stop, StopReason::Width) << known.name << " at " << width;
      EXPECT_LE(Rational(measure.value.upper - measure.value.lower),
                Rational(rational_of(width) * measure.value.lower));
      cells[width] = static_cast<double>(measure.cells);
    }
    EXPECT_LE(cells[1e-6] / cells[1e-3], std::cbrt(1e3)) << known.name;
  }
}

// A sphere of radius 5, a cylinder of radius 3 and a cone meet in a circle at z = 4. The cone's
// part up to there has the area 3 * 5 pi, the cap beyond 2 * 5 * 1 pi; the cylinder bounds nothing.
// In its place, up to z = 4: the cylinder's 2 * 3 * 4 pi and its bottom's 9 pi.
TEST(CertifiedArea, ThreeSurfacesMayMeetInACurve) {
  const Solid3 ball_5 = ball({}, 25);
  const Solid3 cone = solid(domain::make_cone({point(0, 0, 0), {0, 0, 1}}, Rational(9, 16)));
  const Solid3 cut = intersect(intersect(ball_5, cylinder(2, 9)), cone);
  const auto cells = [&](const Solid3& set, double expected, double width) {
    const CertifiedMeasure measure = area(set, cube(6), to_width(width));
    EXPECT_EQ(measure.stop, StopReason::Width);
    EXPECT_TRUE(encloses(measure.value, expected));
    return measure.cells;
  };
  const double pi = std::numbers::pi;
  EXPECT_LE(cells(cut, 25 * pi, 1e-6), 10 * cells(cut, 25 * pi, 1e-3));
  const Solid3 upper_rod =
      intersect(intersect(ball_5, cylinder(2, 9)), unite(cone, below({0, 0, -1}, 0)));
  cells(upper_rod, (10 + 24 + 9) * pi, 1e-6);
}

// A cylinder touches planes across the axes along lines, and a slanted one too.
TEST(CertifiedArea, SurfacesMayTouchPlanesAlongLines) {
  const double pi = std::numbers::pi;
  const Solid3 rod =
      intersect(cylinder(2, 1), intersect(below({0, 0, -1}, 0), below({0, 0, 1}, 1)));
  // In a box that fits.
  const Box<3> tight(point(-1, -1, 0), point(1, 1, 1));
  EXPECT_TRUE(encloses(area(rod, tight, to_width(1e-9)).value, 2 * pi));
  // A block with a half round end: two planes go on as a cylinder.
  const Solid3 block = domain::make_block(Box<3>(point(-2, -1, 0), point(0, 1, 1)));
  EXPECT_TRUE(encloses(area(unite(rod, block), cube(3), to_width(1e-9)).value,
                       2 * (4 + pi / 2) + (4 + 2 + pi)));
  // 3 x + 4 y <= 5 touches the rod.
  EXPECT_TRUE(encloses(area(intersect(rod, below({3, 4, 0}, 5)), cube(3), to_width(1e-7)).value,
                       2 * pi + 2 * pi));
}

TEST(CertifiedArea, BlocksAreExact) {
  const Solid3 block = domain::make_block(Box<3>(point(0, 0, 0), point(Rational(1, 3), 2, 3)));
  EXPECT_EQ(exact_area(block, cube(7)), 2 * (Rational(2, 3) + 1 + 6));
  EXPECT_EQ(exact_area(Solid3::empty(), cube(7)), 0);
  EXPECT_EQ(exact_area(Solid3::full(), cube(7)), 0);
  // Two that share a face: what is between them is no boundary.
  const Solid3 next = domain::make_block(Box<3>(point(Rational(1, 3), 0, 0), point(1, 2, 3)));
  EXPECT_EQ(exact_area(unite(block, next), cube(7)), 2 * (2 + 3 + 6));
  EXPECT_EQ(exact_area(intersect(block, next), cube(7)), 0);
  // A side of the box itself is none.
  EXPECT_EQ(exact_area(block, Box<3>(point(0, 0, 0), point(1, 2, 3))), 6);
}

// Surfaces with the set on both sides, or on none, in whatever form they are written.
TEST(CertifiedArea, SurfacesThatBoundNothingDoNotCount) {
  const HalfSpace<3> sphere = domain::make_sphere(point(0, 0, 0), 1);
  const Quadric<3> twice = Rational(2) * sphere.polynomial();
  const Solid3 outside = solid(complement(HalfSpace<3>(twice)));
  EXPECT_EQ(exact_area(unite(solid(sphere), outside), cube(2)), 0);
  EXPECT_EQ(exact_area(intersect(solid(sphere), outside), cube(2)), 0);
  const Solid3 slanted = below({1, 2, 3}, 1);
  EXPECT_EQ(exact_area(unite(slanted, below({-1, -2, -3}, -1)), cube(2)), 0);
  // A ball in two halves.
  const Solid3 unit_ball = solid(sphere);
  const Solid3 halves = unite(intersect(unit_ball, slanted), subtract(unit_ball, slanted));
  EXPECT_TRUE(encloses(area(halves, cube(2), to_width(1e-3)).value, 4 * std::numbers::pi));
  // A ball in a larger one.
  EXPECT_TRUE(encloses(area(unite(ball({}, 4), unit_ball), cube(3), to_width(1e-3)).value,
                       16 * std::numbers::pi));
}

// Quadrics that are pairs of planes across an axis.
TEST(CertifiedArea, PairsOfPlanesCount) {
  const auto pair = [](const LinearForm<3>& f, const LinearForm<3>& g) {
    return solid(HalfSpace<3>(domain::product(f, g)));
  };
  const LinearForm<3> x{{1, 0, 0}, 0};
  const LinearForm<3> y{{0, 1, 0}, 0};
  const LinearForm<3> slanted{{1, 1, 0}, Rational(-1, 2)};
  EXPECT_EQ(exact_area(pair(x, y), cube(1)), 8);
  EXPECT_EQ(exact_area(intersect(pair(x, y), below({1, 0, 0}, 0)), cube(1)), 4);
  EXPECT_EQ(exact_area(pair({{1, 0, 0}, 1}, {{1, 0, 0}, -1}), cube(2)), 32);
  // x^2 <= 2
  const CertifiedMeasure irrational =
      area(solid(HalfSpace<3>(Quadric<3>({{{1, 0, 0}, {0, 0, 0}, {0, 0, 0}}}, {{0, 0, 0}, -2}))),
           cube(2), to_width(1e-6));
  EXPECT_TRUE(encloses(irrational.value, 32));
  // In x = 0 a square of side 2; x + y = 1/2 from y = -1/2 to 1 along x, so 3/2 sqrt 2 wide.
  EXPECT_TRUE(
      encloses(area(pair(x, slanted), cube(1), to_width(1e-4)).value, 4 + 3 * std::numbers::sqrt2));
}

TEST(CertifiedArea, LimitsGiveTheBoundsReached) {
  const CertifiedMeasure few = area(ball({}, 1), cube(2), to_width(1e-12, 100));
  EXPECT_EQ(few.stop, StopReason::Cells);
  EXPECT_TRUE(encloses(few.value, 4 * std::numbers::pi));
}

Enclosure sum(const Enclosure& a, const Enclosure& b) {
  return {Rational(a.lower + b.lower), Rational(a.upper + b.upper)};
}
bool have_common_number(const Enclosure& a, const Enclosure& b) {
  return a.lower <= b.upper && b.lower <= a.upper;
}
Enclosure rough_area(const Solid3& set, const Box<3>& box) {
  MeasureLimits limits;
  limits.relative_width = 0;
  limits.absolute_width = 1e-3;
  limits.cells = 600;
  return area(set, box, limits).value;
}

// area(not A) = area(A); in a block that holds all of the box, and in a larger box, the block's
// sides count where they meet the complement.
RC_GTEST_PROP(CertifiedArea, AComplementHasTheSameBoundary, ()) {
  const Solid3 set = random_solid();
  const Enclosure of_set = rough_area(set, cube(1));
  RC_ASSERT(have_common_number(rough_area(csg::complement(set), cube(1)), of_set));
  // The block's sides of area 24 are boundary of the set or of its complement in the block.
  const Solid3 block = domain::make_block(cube(1));
  const Enclosure in_block =
      sum(rough_area(intersect(set, block), cube(2)), rough_area(subtract(block, set), cube(2)));
  RC_ASSERT(have_common_number(in_block, sum({24, 24}, sum(of_set, of_set))));
}

// Sevenths are on none of the planes across an axis of random solids.
RC_GTEST_PROP(CertifiedArea, AreasInPartsOfTheBoxAddUp, ()) {
  const Solid3 set = random_solid();
  Rational cut(*rc::gen::inRange(-6, 7), 7);
  cut.canonicalize();
  RC_PRE(cut != 0);
  const Rational low = -1;
  const Box<3> left(point(low, low, low), point(cut, 1, 1));
  const Box<3> right(point(cut, low, low), point(1, 1, 1));
  RC_ASSERT(have_common_number(sum(rough_area(set, left), rough_area(set, right)),
                               rough_area(set, cube(1))));
}

}  // namespace
}  // namespace exactcsg::measure::test
