// SPDX-License-Identifier: GPL-3.0-or-later
// Half-spaces where the answer is known in closed form, above all boxes and lines that touch.

#include <gtest/gtest.h>

#include "domain/random_rationals.hpp"
#include "exactcsg/domain/half_spaces.hpp"

namespace exactcsg::domain {

// The archetype of Domain: exactly what it asks for.
struct Archetype {
  static constexpr std::size_t dimension = 1;
  friend PointClass classify(const Archetype&, const Point<1>&);
  friend csg::Membership classify(const Archetype&, const Box<1>&);
  friend Section section(const Archetype&, const LineSection<1>&);
  friend Archetype complement(const Archetype&);
};
static_assert(Domain<Archetype>);
static_assert(!Domain<int>);

namespace {

using csg::Membership;

const Rational tiny(Integer(1), Integer(1) << 300);
const Rational tiniest(Integer(1), Integer(1) << 1000);

// A box that touches is Out; one that reaches 2^-300 further is mixed. Likewise inside.
template <std::size_t D>
void expect_touches(const HalfSpace<D>& set, const Box<D>& box, std::size_t axis, bool at_upper,
                    Membership expected) {
  EXPECT_EQ(classify(set, box), expected);
  Coordinates<D> low = box.lower().coordinates();
  Coordinates<D> high = box.upper().coordinates();
  (at_upper ? high : low)[axis] += at_upper ? tiny : Rational(-tiny);
  EXPECT_EQ(classify(set, Box<D>(low, high)), Membership::Unknown);
}

TEST(Boxes, DiscsAreTouchedExactly) {
  const HalfSpace<2> disc = make_disc({0, 0}, 25);
  expect_touches<2>(disc, {{5, -1}, {7, 2}}, 0, false, Membership::Out);  // a side touches
  expect_touches<2>(disc, {{3, 4}, {7, 7}}, 0, false, Membership::Out);   // a corner
  expect_touches<2>(disc, {{-3, -4}, {3, 4}}, 1, true, Membership::In);   // four corners
  expect_touches<2>(complement(disc), {{5, -1}, {7, 2}}, 0, false, Membership::In);
  EXPECT_EQ(classify(disc, Box<2>({-9, -9}, {9, 9})), Membership::Unknown);  // no corner inside
  EXPECT_EQ(classify(make_disc({0, 0}, 2), Box<2>({-1, -1}, {1, 1})), Membership::In);
}

TEST(Boxes, SpheresAreTouchedExactly) {
  const HalfSpace<3> ball = make_sphere({0, 0, 0}, 9);
  expect_touches<3>(ball, {{3, -1, -1}, {4, 1, 1}}, 0, false, Membership::Out);
  expect_touches<3>(ball, {{1, 2, 2}, {4, 4, 4}}, 2, false, Membership::Out);
  expect_touches<3>(ball, {{-1, -2, -2}, {1, 2, 2}}, 0, true, Membership::In);
  // An edge touches: distance sqrt(8) from the z axis, radius sqrt(8).
  expect_touches<3>(make_sphere({0, 0, 0}, 8), {{2, 2, -1}, {3, 3, 1}}, 0, false, Membership::Out);
}

TEST(Boxes, CylindersInGeneralPositionAreTouchedExactly) {
  const HalfSpace<3> upright = make_cylinder({{0, 0, 0}, {0, 0, 3}}, 1);
  expect_touches<3>(upright, {{1, -1, -5}, {2, 1, 5}}, 0, false, Membership::Out);
  // Axis (1, 1, 0), radius sqrt(1/2): the vertical edge x = 1, y = 0 lies on the surface, since the
  // distance of (1, 0) from the line x = y is sqrt(1/2); and z = 0 is where it is nearest.
  const HalfSpace<3> oblique = make_cylinder({{0, 0, 0}, {1, 1, 0}}, Rational(1, 2));
  expect_touches<3>(oblique, {{1, -1, -2}, {2, 0, 2}}, 1, true, Membership::Out);
  // Axis (1, 1, 1): the corner (1, -1, 0) has distance sqrt(2).
  const HalfSpace<3> diagonal = make_cylinder({{0, 0, 0}, {1, 1, 1}}, 2);
  EXPECT_EQ(classify(diagonal, Point<3>(1, -1, 0)), PointClass::On);
  // Farthest corners of the cube [0, 1]^3 from its diagonal: distance sqrt(2/3).
  expect_touches<3>(make_cylinder({{0, 0, 0}, {1, 1, 1}}, Rational(2, 3)), {{0, 0, 0}, {1, 1, 1}},
                    0, true, Membership::In);
}

TEST(Boxes, ConesAreTouchedExactly) {
  const Axis axis{{0, 0, 0}, {0, 0, 1}};
  const HalfSpace<3> cone = make_cone(axis, 1);
  const HalfSpace<3> two = make_double_cone(axis, 1);
  // Below the apex, where only the second nappe is.
  EXPECT_EQ(classify(cone, Box<3>({-1, -1, -3}, {1, 1, -2})), Membership::Out);
  EXPECT_EQ(classify(two, Box<3>({-1, -1, -3}, {1, 1, -2})), Membership::In);
  // The apex touches.
  expect_touches<3>(cone, {{-1, -1, -3}, {1, 1, 0}}, 2, true, Membership::Out);
  EXPECT_EQ(classify(two, Box<3>({-1, -1, -3}, {1, 1, 0})), Membership::Unknown);
  expect_touches<3>(cone, {{-3, -4, 5}, {3, 4, 6}}, 0, true, Membership::In);
  // The side x = 2 touches the circle at height 2 in its edge.
  expect_touches<3>(cone, {{2, -1, 0}, {3, 1, 2}}, 0, false, Membership::Out);
  // A box far round the apex sees both nappes at once.
  EXPECT_EQ(classify(two, Box<3>({-9, -9, -1}, {9, 9, 1})), Membership::Unknown);
}

TEST(Lines, TangentsAreReportedTwice) {
  const HalfSpace<2> disc = make_disc({0, 0}, 25);
  const Section tangent = section(disc, whole_line<2>({5, -3}, {0, 1}));
  ASSERT_EQ(tangent.crossings.size(), 1U);
  EXPECT_EQ(tangent.crossings[0].multiplicity, 2);
  EXPECT_EQ(tangent.crossings[0].parameter, QuadraticNumber(3));
  EXPECT_EQ(tangent.between, (std::vector{PointClass::Out, PointClass::Out}));
  EXPECT_TRUE(section(disc, whole_line<2>({5 + tiny, -3}, {0, 1})).crossings.empty());
  EXPECT_EQ(section(disc, whole_line<2>({5 - tiny, -3}, {0, 1})).crossings.size(), 2U);
}

TEST(Lines, CrossingsAreExactRoots) {
  // x = y crosses the circle of radius 1 at +-sqrt(1/2).
  const Section found = section(make_disc({0, 0}, 1), whole_line<2>({0, 0}, {1, 1}));
  ASSERT_EQ(found.crossings.size(), 2U);
  EXPECT_EQ(found.crossings[0].parameter, QuadraticNumber(0, -1, Rational(1, 2)));
  EXPECT_EQ(found.crossings[1].parameter, QuadraticNumber(0, 1, Rational(1, 2)));
  EXPECT_EQ(found.between, (std::vector{PointClass::Out, PointClass::In, PointClass::Out}));
}

TEST(Lines, SectionsEndAtTheirBounds) {
  const HalfSpace<2> disc = make_disc({0, 0}, 25);
  // From the boundary through the middle to the boundary: no crossing strictly between.
  const Section chord = section(disc, segment<2>({-3, -4}, {3, 4}));
  EXPECT_TRUE(chord.crossings.empty());
  EXPECT_EQ(chord.between, std::vector{PointClass::In});
  const Section from_inside = section(disc, ray<2>({0, 0}, {3, 4}));
  ASSERT_EQ(from_inside.crossings.size(), 1U);
  EXPECT_EQ(from_inside.crossings[0].parameter, QuadraticNumber(1));
}

TEST(Lines, LinesInTheSurfaceAreOn) {
  const Axis axis{{0, 0, 0}, {0, 0, 1}};
  const auto along = whole_line<3>({3, 4, 5}, {3, 4, 5});  // a ruling through the apex, at t = -1
  const Section one = section(make_cone(axis, 1), along);
  ASSERT_EQ(one.crossings.size(), 1U);
  EXPECT_EQ(one.crossings[0].parameter, QuadraticNumber(-1));
  EXPECT_EQ(one.crossings[0].multiplicity, 0);
  EXPECT_EQ(one.between, (std::vector{PointClass::Out, PointClass::On}));
  EXPECT_EQ(section(make_double_cone(axis, 1), along).between,
            (std::vector{PointClass::On, PointClass::On}));
  EXPECT_EQ(section(make_cylinder(axis, 25), whole_line<3>({3, 4, 5}, {0, 0, 1})).between,
            std::vector{PointClass::On});
  // Along the axis of one nappe: enters at the apex.
  const Section inner = section(make_cone(axis, 1), whole_line<3>({0, 0, 0}, {0, 0, 1}));
  EXPECT_EQ(inner.between, (std::vector{PointClass::Out, PointClass::In}));
}

// LAW quadric.5, and that the bounds are tight, against the range in rationals.
TEST(Quadrics, RangeBoundsAreThoseOfTheRange) {
  test::Random random(1);
  for (int i = 0; i < 2000; ++i) {
    Quadric<3>::Matrix square;
    LinearForm<3> linear{random.coordinates<3>(), random.rational()};
    for (std::size_t k = 0; k < 3; ++k) {
      square[k][k] = random.one_in(4) ? Rational(0) : random.rational();
    }
    const Quadric<3> f(square, linear);
    const Box<3> box = random.box<3>();
    const Range exact = range(f, box);
    const RangeBounds bounds = f.range_bounds(box);
    EXPECT_LE(rational_of(bounds.least_lower), exact.minimum);
    EXPECT_GE(rational_of(bounds.least_upper), exact.minimum);
    EXPECT_LE(rational_of(bounds.greatest_lower), exact.maximum);
    EXPECT_GE(rational_of(bounds.greatest_upper), exact.maximum);
    double scale = 1;
    for (const Rational& x : box.upper().coordinates()) scale += std::abs(x.get_d());
    for (const Rational& x : box.lower().coordinates()) scale += std::abs(x.get_d());
    EXPECT_LE(bounds.least_upper - bounds.least_lower, 1e-9 * scale * scale);
    EXPECT_LE(bounds.greatest_upper - bounds.greatest_lower, 1e-9 * scale * scale);
  }
}

// LAW quadric.6
TEST(Quadrics, NowhereNegativeIsWhereTheLeastValueIsNot) {
  test::Random random(2);
  int count = 0;
  for (int i = 0; i < 1000; ++i) {
    Quadric<3>::Matrix square;
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t l = k; l < 3; ++l) {
        if (k == l || i % 2 == 0) square[k][l] = square[l][k] = random.rational();
      }
    }
    const Box<3> box = random.box<3>();
    const Quadric<3> f(square, {random.coordinates<3>(), random.rational()});
    // Moved, so that the least value is 0 or next to it.
    const Rational least = range(f, box).minimum;
    for (const Rational& value : {Rational(0), random.tiny(), random.rational()}) {
      const Quadric<3> moved = f + Quadric<3>(LinearForm<3>{{}, Rational(value - least)});
      EXPECT_EQ(is_nowhere_negative(moved, box), value >= 0);
      count += value >= 0 ? 1 : 0;
    }
  }
  EXPECT_GT(count, 1000);
}

TEST(HalfSpaces, DegenerateOnesAreRefused) {
  const auto id_of = [](auto&& make) {
    try {
      make();
    } catch (const Error& error) {
      return error.id();
    }
    return ErrorId::InternalError;
  };
  EXPECT_EQ(id_of([] { make_line(0, 0, 1); }), ErrorId::DegenerateHalfSpace);
  EXPECT_EQ(id_of([] { make_plane({0, 0, 0}, 1); }), ErrorId::DegenerateHalfSpace);
  EXPECT_EQ(id_of([] { make_disc({0, 0}, 0); }), ErrorId::BadArgument);
  EXPECT_EQ(id_of([] { make_sphere({0, 0, 0}, -1); }), ErrorId::BadArgument);
  EXPECT_EQ(id_of([] { make_cylinder({{0, 0, 0}, {0, 0, 0}}, 1); }), ErrorId::BadArgument);
  EXPECT_EQ(id_of([] { make_cone({{0, 0, 0}, {0, 0, 1}}, 0); }), ErrorId::BadArgument);
  EXPECT_EQ(id_of([] { Box<2>({0, 0}, {1, 0}); }), ErrorId::BadArgument);
  EXPECT_EQ(id_of([] { segment<2>({1, 0}, {1, 0}); }), ErrorId::BadArgument);
  EXPECT_EQ(id_of([] {
              AffineMap map = AffineMap::identity();
              map.m[0][0] = 0;
              apply(map, make_sphere({0, 0, 0}, 1));
            }),
            ErrorId::SingularMap);
}

TEST(HalfSpaces, TiersAreCounted) {
  TierStatistics statistics;
  const HalfSpace<2> disc = make_disc({0, 0}, 25);
  EXPECT_EQ(classify(disc, Point<2>(1, 1), &statistics), PointClass::In);
  EXPECT_EQ(classify(disc, Point<2>(3, 4), &statistics), PointClass::On);
  EXPECT_EQ(classify(disc, Point<2>(3 + tiny, 4), &statistics), PointClass::Out);
  EXPECT_EQ(classify(disc, Point<2>(3 - tiniest, 4), &statistics), PointClass::In);
  TierStatistics expected;
  expected.record(Tier::Double, false);
  expected.record(Tier::Fixed, true);
  expected.record(Tier::Fixed, false);
  expected.record(Tier::Unbounded, false);
  EXPECT_EQ(statistics, expected);
}

}  // namespace
}  // namespace exactcsg::domain
