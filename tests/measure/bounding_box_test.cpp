// SPDX-License-Identifier: GPL-3.0-or-later
// Boxes that hold sets, and decimals that hold bounds. Expected values: the sets' own extents.

#include "exactcsg/measure/bounding_box.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "exactcsg/domain/classify.hpp"
#include "exactcsg/measure/decimal_bounds.hpp"
#include "measure/curved_solids.hpp"
#include "measure/random_solids.hpp"

namespace exactcsg::measure::test {
namespace {

TEST(BoundingBox, KnownSolidsAreBoundedByBoxesNotMuchLarger) {
  for (const KnownSolid& known : known_solids()) {
    const Extent extent = bounding_box(known.set);
    ASSERT_EQ(extent.kind, ExtentKind::Bounded) << known.name;
    // All of the volume is in it.
    EXPECT_TRUE(encloses(volume(known.set, *extent.box, to_width(1e-2)).value, known.volume))
        << known.name;
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_LE(extent.box->upper()[i] - extent.box->lower()[i],
                4 * (known.box.upper()[i] - known.box.lower()[i]))
          << known.name;
    }
  }
}

TEST(BoundingBox, PlanesAcrossTheAxesAreItsSides) {
  const Box<3> block(point(-3, Rational(1, 3), 5), point(Rational(7, 5), 100, 6));
  EXPECT_EQ(*bounding_box(domain::make_block(block)).box, block);
  // A cylinder between two planes.
  const Extent rod = bounding_box(
      csg::intersect(cylinder(2, 1), csg::intersect(below({0, 0, -1}, 10), below({0, 0, 1}, 10))));
  ASSERT_TRUE(rod.box);
  EXPECT_EQ(rod.box->lower()[2], -10);
  EXPECT_EQ(rod.box->upper()[2], 10);
}

// A hexagonal prism: planes that are across no axis.
TEST(BoundingBox, SlantedPlanesMayBoundASet) {
  Solid3 prism = csg::intersect(below({0, 0, 1}, 1), below({0, 0, -1}, 1));
  for (const auto& normal :
       {Coordinates<3>{2, 1, 0}, Coordinates<3>{1, 2, 0}, Coordinates<3>{1, -1, 0}}) {
    const Coordinates<3> opposite{Rational(-normal[0]), Rational(-normal[1]), 0};
    prism = csg::intersect(prism, csg::intersect(below(normal, 1), below(opposite, 1)));
  }
  EXPECT_EQ(bounding_box(prism).kind, ExtentKind::Bounded);
}

TEST(BoundingBox, UnboundedSetsHaveNone) {
  const Solid3 unit_ball = ball({}, 1);
  for (const Solid3& set :
       {Solid3::full(), csg::complement(unit_ball), cylinder(1, 1), below({1, 2, 3}, 1),
        csg::unite(unit_ball, csg::intersect(below({0, 1, 0}, 1), below({0, -1, 0}, 1))),
        solid(domain::make_double_cone({point(0, 0, 0), {1, 1, 1}}, 1)),
        csg::intersect(solid(domain::make_cone({point(0, 0, 0), {1, 1, 1}}, 1)),
                       below({-1, 0, 0}, 5))}) {
    EXPECT_EQ(bounding_box(set).kind, ExtentKind::NotBounded);
  }
  EXPECT_EQ(bounding_box(Solid3::empty()).kind, ExtentKind::Empty);
  EXPECT_EQ(bounding_box(csg::intersect(unit_ball, ball(point(9, 0, 0), 1))).kind,
            ExtentKind::Empty);
}

// Nothing is outside, as far as points tell.
RC_GTEST_PROP(BoundingBox, RandomPointsOutsideAreNotInTheSet, ()) {
  const Solid3 set = csg::intersect(random_solid(), ball({}, 4));
  const Extent extent = bounding_box(set);
  RC_ASSERT(extent.kind != ExtentKind::NotBounded);
  for (int i = 0; i < 20; ++i) {
    const Point<3> p =
        point(random_rational(-2, 2), random_rational(-2, 2), random_rational(-2, 2));
    if (extent.box) {
      bool is_outside = false;
      for (std::size_t k = 0; k < 3; ++k) {
        is_outside = is_outside || p[k] < extent.box->lower()[k] || p[k] > extent.box->upper()[k];
      }
      if (!is_outside) continue;
    }
    const csg::Membership at =
        csg::membership_of(set, [&](const HalfSpace<3>& h) { return membership(classify(h, p)); });
    RC_ASSERT(at != csg::Membership::In);
  }
}

RC_GTEST_PROP(DecimalBounds, RoundOutwards, ()) {
  const int digits = *rc::gen::inRange(2, 18);
  Rational a(*rc::gen::inRange(-1000000, 1000000), *rc::gen::inRange(1, 1000000));
  a.canonicalize();
  const Rational b = a + random_rational(0, 1) / 1000;
  const DecimalBounds bounds = decimal_bounds({a, b}, digits);
  const Rational lower = *parse_rational(bounds.lower);
  const Rational upper = *parse_rational(bounds.upper);
  RC_ASSERT(lower <= a);
  RC_ASSERT(b <= upper);
  Integer scale;
  mpz_ui_pow_ui(scale.get_mpz_t(), 10, static_cast<unsigned long>(digits - 1));
  RC_ASSERT(Rational(a - lower) * scale <= 2 * abs(a));
  RC_ASSERT(Rational(upper - b) * scale <= 2 * abs(b));
}

}  // namespace
}  // namespace exactcsg::measure::test
