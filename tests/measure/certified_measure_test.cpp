// SPDX-License-Identifier: GPL-3.0-or-later
// Certified volumes. Expected values: closed forms (curved_solids.hpp), the law of inclusion and
// exclusion, the determinant of a map, and exact rational volumes.

#include "exactcsg/measure/certified_measure.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "exactcsg/domain/classify.hpp"
#include "measure/curved_solids.hpp"
#include "measure/opaque_domain.hpp"
#include "measure/random_solids.hpp"

namespace exactcsg::measure::test {
namespace {

TEST(CertifiedVolume, ClosedFormsLieInTheBoundsAtEveryWidth) {
  for (const KnownSolid& known : known_solids()) {
    for (const double width : {1e-1, 1e-2, 1e-3}) {
      const CertifiedMeasure measure = volume(known.set, known.box, to_width(width));
      EXPECT_TRUE(encloses(measure.value, known.volume)) << known.name << " at " << width;
      EXPECT_EQ(measure.stop, StopReason::Width) << known.name << " at " << width;
      EXPECT_LE(Rational(measure.value.upper - measure.value.lower),
                Rational(rational_of(width) * measure.value.lower));
    }
  }
}

// The cells needed grow by less than the third root of what the width falls by, and by the square
// root at worst.
TEST(CertifiedVolume, TheWidthFallsAtLeastAsTheInverseSquareOfTheCells) {
  for (const KnownSolid& known : known_solids()) {
    const auto cells = [&](double width) {
      return static_cast<double>(volume(known.set, known.box, to_width(width)).cells);
    };
    EXPECT_LE(cells(1e-5) / cells(1e-3), std::sqrt(1e2)) << known.name;
  }
}

TEST(CertifiedVolume, PlanesAcrossTheAxesAreExact) {
  const Box<3> third(point(0, 0, 0), point(Rational(1, 3), Rational(1, 3), Rational(1, 3)));
  const Solid3 solid_third = domain::make_block(third);
  const Solid3 half = domain::make_block(
      Box<3>(point(Rational(1, 6), 0, 0), point(Rational(1, 2), Rational(1, 2), 1)));
  const auto exact = [](const Solid3& set) {
    const CertifiedMeasure measure = volume(set, cube(7), to_width(0));
    EXPECT_EQ(measure.stop, StopReason::Width);
    EXPECT_EQ(measure.value.lower, measure.value.upper);
    return measure.value.lower;
  };
  EXPECT_EQ(exact(solid_third), Rational(1, 27));
  EXPECT_EQ(exact(half), Rational(1, 6));
  EXPECT_EQ(exact(csg::intersect(solid_third, half)), Rational(1, 54));
  EXPECT_EQ(exact(csg::unite(solid_third, half)),
            Rational(1, 27) + Rational(1, 6) - Rational(1, 54));
  EXPECT_EQ(exact(Solid3::empty()), 0);
  EXPECT_EQ(exact(Solid3::full()), 14 * 14 * 14);
}

// A set and its complement, written so that pruning alone does not see it.
TEST(CertifiedVolume, WhatCancelsLeavesNoWidth) {
  const HalfSpace<3> sphere = domain::make_sphere(point(0, 0, 0), 1);
  const Solid3 everything = csg::unite(solid(sphere), solid(complement(sphere)));
  const CertifiedMeasure measure = volume(everything, cube(1), to_width(1e-4));
  EXPECT_TRUE(encloses(measure.value, 8));
}

TEST(CertifiedVolume, LimitsGiveTheBoundsReached) {
  const Solid3 unit_ball = ball({}, 1);
  const double expected = 4 * std::numbers::pi / 3;
  const CertifiedMeasure few = volume(unit_ball, cube(2), to_width(1e-12, 100));
  EXPECT_EQ(few.stop, StopReason::Cells);
  EXPECT_TRUE(encloses(few.value, expected));
  MeasureLimits limits = to_width(1e-12);
  limits.deadline = std::chrono::steady_clock::now();
  const CertifiedMeasure late = volume(unit_ball, cube(2), limits);
  EXPECT_EQ(late.stop, StopReason::Deadline);
  EXPECT_TRUE(encloses(late.value, expected));
  Progress progress;
  progress.cancel();
  limits.deadline.reset();
  limits.progress = &progress;
  const CertifiedMeasure cancelled = volume(unit_ball, cube(2), limits);
  EXPECT_EQ(cancelled.stop, StopReason::Cancelled);
  EXPECT_TRUE(encloses(cancelled.value, expected));
  EXPECT_EQ(progress.done(), cancelled.cells);
}

// What doubles cannot narrow is said, and ends.
TEST(CertifiedVolume, TheEndOfPrecisionIsReported) {
  const Solid3 slanted = below({1, 2, 4}, 1);
  const CertifiedMeasure measure = volume(slanted, cube(1), to_width(0));
  EXPECT_EQ(measure.stop, StopReason::Precision);
  // {x + 2 y + 4 z <= 1}: z is below (1 - x - 2 y) / 4, which lies in [-1/2, 1]: its mean 1/4.
  EXPECT_TRUE(encloses(measure.value, 4 * 1.25));
  EXPECT_LT(Rational(measure.value.upper - measure.value.lower), rational_of(1e-11));
}

// Far from the origin, in cells that are small: the filters' doubles cancel, the bounds hold.
TEST(CertifiedVolume, APlaceFarAwayCostsNoPrecision) {
  const Rational far = Rational(1'000'000) + Rational(1, 3);
  const Solid3 small = ball(point(far, far, far), Rational(1, 10000));
  const Rational low = far - 1;
  const Rational high = far + 1;
  const CertifiedMeasure measure =
      volume(small, Box<3>(point(low, low, low), point(high, high, high)), to_width(1e-6));
  EXPECT_EQ(measure.stop, StopReason::Width);
  EXPECT_TRUE(encloses(measure.value, 4e-6 * std::numbers::pi / 3));
}

TEST(CertifiedVolume, AnyDomainOfSpaceIsMeasured) {
  const auto opaque = csg::BooleanTree<Opaque>::primitive({domain::make_sphere(point(0, 0, 0), 1)});
  const CertifiedMeasure measure = volume(opaque, cube(2), to_width(1e-1));
  EXPECT_EQ(measure.stop, StopReason::Width);
  EXPECT_TRUE(encloses(measure.value, 4 * std::numbers::pi / 3));
}

Enclosure sum(const Enclosure& a, const Enclosure& b) {
  return {Rational(a.lower + b.lower), Rational(a.upper + b.upper)};
}
bool have_common_number(const Enclosure& a, const Enclosure& b) {
  return a.lower <= b.upper && b.lower <= a.upper;
}

// v(A + B) + v(A * B) = v(A) + v(B), v(A - B) + v(A * B) = v(A), v(A) + v(not A) = v(box).
RC_GTEST_PROP(CertifiedVolume, InclusionAndExclusion, ()) {
  const Solid3 a = random_solid();
  const Solid3 b = random_solid();
  const Box<3> box = cube(1);
  MeasureLimits limits;
  limits.relative_width = 0;
  limits.absolute_width = 1e-4;
  limits.cells = 600;
  const auto v = [&](const Solid3& set) { return volume(set, box, limits).value; };
  const Enclosure common = v(csg::intersect(a, b));
  const Enclosure of_a = v(a);
  RC_ASSERT(have_common_number(sum(v(csg::unite(a, b)), common), sum(of_a, v(b))));
  RC_ASSERT(have_common_number(sum(v(csg::subtract(a, b)), common), of_a));
  RC_ASSERT(have_common_number(sum(v(csg::complement(a)), of_a), {8, 8}));
}

// The same set in boxes divided in different places: the parts add up.
RC_GTEST_PROP(CertifiedVolume, VolumesInPartsOfTheBoxAddUp, ()) {
  const Solid3 set = random_solid();
  const Rational cut = random_rational(-1, 1) / 2;
  MeasureLimits limits;
  limits.relative_width = 0;
  limits.absolute_width = 1e-5;
  limits.cells = 1000;
  const Rational low = -1;
  const Box<3> left(point(low, low, low), point(cut, 1, 1));
  const Box<3> right(point(cut, low, low), point(1, 1, 1));
  RC_ASSERT(
      have_common_number(sum(volume(set, left, limits).value, volume(set, right, limits).value),
                         volume(set, cube(1), limits).value));
}

// Certain points of the set, counted on a grid of cells that are In or Out as a whole: bounds from
// classification alone.
RC_GTEST_PROP(CertifiedVolume, AgreesWithTheCellsOfAGrid, ()) {
  const Solid3 set = random_solid();
  constexpr int n = 8;
  int inside = 0;
  int mixed = 0;
  for (int i = 0; i < n * n * n; ++i) {
    const auto at = [&](int k) { return Rational(Rational(2 * k) / n - 1); };
    const int x = i % n;
    const int y = i / n % n;
    const int z = i / n / n;
    const Box<3> cell(point(at(x), at(y), at(z)), point(at(x + 1), at(y + 1), at(z + 1)));
    const csg::Membership membership = domain::classify(set, cell);
    inside += membership == csg::Membership::In ? 1 : 0;
    mixed += membership == csg::Membership::Unknown ? 1 : 0;
  }
  const Rational of_cell = Rational(8) / (n * n * n);
  MeasureLimits limits = to_width(1e-3, 2000);
  limits.absolute_width = 1e-3;
  RC_ASSERT(have_common_number({Rational(inside * of_cell), Rational((inside + mixed) * of_cell)},
                               volume(set, cube(1), limits).value));
}

}  // namespace
}  // namespace exactcsg::measure::test
