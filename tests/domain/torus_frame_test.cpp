// SPDX-License-Identifier: GPL-3.0-or-later
// What is seen from the axis of a torus. Expected values: the torus's own polynomials.

#include "exactcsg/domain/torus_frame.hpp"

#include <gtest/gtest.h>

#include "domain/random_rationals.hpp"
#include "exactcsg/domain/half_spaces.hpp"
#include "exactcsg/domain/vector.hpp"

namespace exactcsg::domain::test {
namespace {

// LAW torus_frame.3 and torus_frame.4
TEST(TorusFrame, PointsOfTheAxisAndTheSteepestWay) {
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const Axis axis{random.coordinates<3>(), random.direction<3>()};
    const Torus torus = make_torus(axis, random.positive(), random.positive(), random.positive());
    const TorusFrame frame(torus);
    const Rational w = random.rational();
    const Coordinates<3> on_axis = frame.on_axis(w);
    EXPECT_EQ(frame.along()(on_axis), w);
    EXPECT_EQ(torus.radicand()(on_axis), 0);
    const Coordinates<3> d = random.coordinates<3>();
    EXPECT_EQ(4 * frame.squared_distance(d), torus.radicand()(detail::sum(on_axis, d)));

    const Quadric<3> plane(LinearForm<3>{random.direction<3>(), random.rational()});
    const Coordinates<3> uphill = frame.uphill(plane);
    const Coordinates<3>& normal = plane.linear().normal;
    EXPECT_EQ(detail::scalar_product(frame.along().normal, uphill), 0);
    EXPECT_EQ(frame.form(plane)->squared_slope, frame.squared_distance(uphill));
    // No other direction across the axis has a greater slope: the squares, in units of distance.
    const Rational height = detail::scalar_product(frame.along().normal, d) /
                            detail::scalar_product(frame.along().normal, axis.direction);
    const Coordinates<3> across = detail::sum(d, detail::scaled(Rational(-height), axis.direction));
    const Rational slope = detail::scalar_product(normal, across);
    EXPECT_LE(slope * slope, frame.squared_distance(uphill) * frame.squared_distance(across));
    EXPECT_GE(detail::scalar_product(normal, uphill), 0);
    EXPECT_EQ(frame.uphill(make_cylinder(axis, 1).polynomial()), Coordinates<3>{});
  }
}

}  // namespace
}  // namespace exactcsg::domain::test
