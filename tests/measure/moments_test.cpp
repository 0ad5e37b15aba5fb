// SPDX-License-Identifier: GPL-3.0-or-later
// Certified moments and centroids. Expected values: closed forms, each derived where it stands,
// exact moments of blocks, and the laws of inclusion and exclusion and of another origin.

#include "exactcsg/measure/moments.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "measure/curved_solids.hpp"
#include "measure/opaque_domain.hpp"
#include "measure/random_solids.hpp"

namespace exactcsg::measure::test {
namespace {

using std::numbers::pi;

testing::AssertionResult has(const CertifiedMeasure& measure, double expected, double width) {
  if (measure.stop != StopReason::Width) return testing::AssertionFailure() << "a limit";
  if (Rational(measure.value.upper - measure.value.lower) > rational_of(width)) {
    return testing::AssertionFailure() << "too wide";
  }
  const Rational slack = rational_of(1e-13);
  const Rational value = rational_of(expected);
  if (measure.value.lower - slack <= value && value <= measure.value.upper + slack) {
    return testing::AssertionSuccess();
  }
  return testing::AssertionFailure() << to_decimal(measure.value.lower, 12) << " to "
                                     << to_decimal(measure.value.upper, 12) << ", not " << expected;
}

// By symmetry a third of the integral of r^2, 4 pi / 5.
TEST(CertifiedMoments, OfABall) {
  for (const double width : {1e-3, 1e-6}) {
    const Moments m = moments(ball({}, 1), cube(Rational(5, 4)), to_width(width));
    EXPECT_TRUE(has(m.volume, 4 * pi / 3, 5 * width));
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_TRUE(has(m.first[i], 0, 8 * width));
      for (std::size_t j = 0; j < 3; ++j) {
        EXPECT_TRUE(has(m.second[i][j], i == j ? 4 * pi / 15 : 0, 8 * width));
      }
    }
  }
}

// Sections across y are squares of side 2 s, s^2 = 1 - y^2: the integral of x^2 over one is
// 4 s^4 / 3, that of y^2 is 4 s^2 y^2.
TEST(CertifiedMoments, OfTwoCylinders) {
  const Solid3 set = csg::intersect(cylinder(0, 1), cylinder(2, 1));
  const Moments m = moments(set, cube(Rational(5, 4)), to_width(1e-5));
  EXPECT_TRUE(has(m.second[0][0], 4.0 / 3 * (2 - 4.0 / 3 + 2.0 / 5), 1e-4));
  EXPECT_TRUE(has(m.second[1][1], 4 * (2.0 / 3 - 2.0 / 5), 1e-4));
  EXPECT_TRUE(has(m.second[0][1], 0, 1e-4));
}

TEST(CertifiedMoments, OfBlocksAreExact) {
  const Solid3 block = domain::make_block(Box<3>(point(0, 1, 0), point(Rational(1, 3), 2, 3)));
  const auto exact = [&](const Exponents& exponents) {
    const CertifiedMeasure m = moment(block, cube(7), exponents, to_width(0));
    EXPECT_EQ(m.value.lower, m.value.upper);
    return m.value.lower;
  };
  // Products of (b^(k+1) - a^(k+1)) / (k+1).
  EXPECT_EQ(exact({0, 0, 0}), 1);
  EXPECT_EQ(exact({1, 0, 0}), Rational(1, 18) * 3);
  EXPECT_EQ(exact({0, 1, 0}), Rational(3, 2));
  EXPECT_EQ(exact({0, 0, 2}), Rational(1, 3) * 9);
  EXPECT_EQ(exact({0, 1, 1}), Rational(1, 3) * Rational(3, 2) * Rational(9, 2));
}

// A half ball's is 3/8 above its centre, a cone's a quarter of the height above its base, that of
// the half of a cylinder cut by a slanted plane through a diameter of its base (a hoof of height h)
// at 3 pi r / 16 and 3 pi h / 32.
TEST(CertifiedMoments, CentroidsOfKnownSolids) {
  struct Known {
    const char* name;
    Solid3 set;
    std::array<double, 3> centroid;
  };
  const Known known[] = {
      {"half ball", csg::intersect(ball({}, 1), below({0, 0, -1}, 0)), {0, 0, 3.0 / 8}},
      {"ball aside",
       ball(point(Rational(1, 3), Rational(1, 4), 0), Rational(1, 4)),
       {1.0 / 3, 0.25, 0}},
      {"cone", domain::make_bounded_cone({point(0, 0, -1), {0, 0, 2}}, 1), {0, 0, -0.5}},
      {"hoof",
       csg::intersect(cylinder(2, 1), csg::intersect(below({0, 0, -1}, 0), below({-1, 0, 1}, 0))),
       {3 * pi / 16, 0, 3 * pi / 32}},
  };
  for (const Known& k : known) {
    for (const double width : {1e-2, 1e-5}) {
      const auto found = centroid(k.set, cube(Rational(3, 2)), to_width(width));
      ASSERT_TRUE(found) << k.name;
      EXPECT_EQ(found->stop, StopReason::Width) << k.name;
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_TRUE(has({found->coordinates[i]}, k.centroid[i], 3 * width)) << k.name << " " << i;
      }
    }
  }
  EXPECT_FALSE(centroid(Solid3::empty(), cube(1)));
}

// By division alone.
TEST(CertifiedMoments, AnyDomainOfSpaceIsMeasured) {
  const auto opaque = csg::BooleanTree<Opaque>::primitive({domain::make_sphere(point(1, 0, 0), 1)});
  const CertifiedMeasure m = moment(opaque, cube(2), {1, 0, 0}, to_width(1e-1));
  EXPECT_EQ(m.stop, StopReason::Width);
  EXPECT_TRUE(encloses(m.value, 4 * pi / 3));
}

bool have_common_number(const Enclosure& a, const Enclosure& b) {
  return a.lower <= b.upper && b.lower <= a.upper;
}
Enclosure sum(const Enclosure& a, const Enclosure& b) {
  return {Rational(a.lower + b.lower), Rational(a.upper + b.upper)};
}
MeasureLimits rough() {
  MeasureLimits limits;
  limits.relative_width = 0;
  limits.absolute_width = 1e-4;
  limits.cells = 600;
  return limits;
}
Exponents random_exponents() {
  Exponents exponents{};
  ++exponents[*rc::gen::inRange(0U, 3U)];
  if (*rc::gen::arbitrary<bool>()) ++exponents[*rc::gen::inRange(0U, 3U)];
  return exponents;
}

RC_GTEST_PROP(CertifiedMoments, InclusionAndExclusion, ()) {
  const Solid3 a = random_solid();
  const Solid3 b = random_solid();
  const Exponents exponents = random_exponents();
  const auto m = [&](const Solid3& set) { return moment(set, cube(1), exponents, rough()).value; };
  const Enclosure common = m(csg::intersect(a, b));
  RC_ASSERT(have_common_number(sum(m(csg::unite(a, b)), common), sum(m(a), m(b))));
  RC_ASSERT(have_common_number(sum(m(csg::subtract(a, b)), common), m(a)));
}

// The integral of (x - o) (y - p) is that of x y - o y - p x + o p.
RC_GTEST_PROP(CertifiedMoments, AnotherOriginIsAnotherPolynomial, ()) {
  const Solid3 set = random_solid();
  const Point<3> origin = random_point();
  const auto m = [&](const Exponents& exponents, const Point<3>& about) {
    return moment(set, cube(1), exponents, rough(), about).value;
  };
  const auto times = [](const Rational& factor, const Enclosure& e) {
    return factor >= 0 ? Enclosure{Rational(factor * e.lower), Rational(factor * e.upper)}
                       : Enclosure{Rational(factor * e.upper), Rational(factor * e.lower)};
  };
  const Enclosure of_x = m({1, 0, 0}, {});
  const Enclosure of_y = m({0, 1, 0}, {});
  const Enclosure of_1 = m({0, 0, 0}, {});
  const Enclosure expected =
      sum(sum(m({1, 1, 0}, {}), times(Rational(-origin[0]), of_y)),
          sum(times(Rational(-origin[1]), of_x), times(Rational(origin[0] * origin[1]), of_1)));
  RC_ASSERT(have_common_number(m({1, 1, 0}, origin), expected));
  RC_ASSERT(have_common_number(m({1, 0, 0}, origin), sum(of_x, times(Rational(-origin[0]), of_1))));
}

}  // namespace
}  // namespace exactcsg::measure::test
