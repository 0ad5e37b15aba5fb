// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "exactcsg/io/openscad/degree_trigonometry.hpp"
#include "exactcsg/io/openscad/tessellation.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg::io::openscad {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

// LAW degree.1
TEST(OpenscadDegrees, AreExactWhereTheValueIs) {
  EXPECT_EQ(sine_of_degrees(0), 0);
  EXPECT_EQ(sine_of_degrees(30), 0.5);
  EXPECT_EQ(sine_of_degrees(90), 1);
  EXPECT_EQ(sine_of_degrees(180), 0);
  EXPECT_EQ(sine_of_degrees(-90), -1);
  EXPECT_EQ(cosine_of_degrees(60), 0.5);
  EXPECT_EQ(cosine_of_degrees(90), 0);
  EXPECT_EQ(cosine_of_degrees(270), 0);
  EXPECT_EQ(cosine_of_degrees(720), 1);
  EXPECT_TRUE(std::isnan(sine_of_degrees(1e30)));
  EXPECT_TRUE(std::isnan(cosine_of_degrees(not_a_number)));
}

// LAW degree.2, against the library's long double functions.
TEST(OpenscadDegrees, AreWithinTheirBound) {
  for (int i = 0; i <= 36000; ++i) {
    const double x = i / 100.0;
    const long double angle = static_cast<long double>(x) * std::numbers::pi_v<long double> / 180;
    EXPECT_LE(std::fabs(sine_of_degrees(x) - std::sin(angle)), 0x1p-51L) << x;
    EXPECT_LE(std::fabs(cosine_of_degrees(x) - std::cos(angle)), 0x1p-51L) << x;
  }
}

// Worked by hand from OpenSCAD's rule: 3 below the grid; $fn cut to an integer; else
// ceil(max(min(360 / $fa, 2 pi r / $fs), 5)).
TEST(OpenscadFragments, FollowTheRule) {
  EXPECT_EQ(fragments(1e-7, {100, 12, 2}), 3U);
  EXPECT_EQ(fragments(1, {not_a_number, 12, 2}), 3U);
  EXPECT_EQ(fragments(1, {infinity, 12, 2}), 3U);
  EXPECT_EQ(fragments(1, {2, 12, 2}), 3U);
  EXPECT_EQ(fragments(1, {7.9, 12, 2}), 7U);
  EXPECT_EQ(fragments(1, {0, 12, 2}), 5U);     // 3.14 fragments by $fs
  EXPECT_EQ(fragments(5, {0, 12, 2}), 16U);    // 15.7 by $fs
  EXPECT_EQ(fragments(100, {0, 12, 2}), 30U);  // 30 by $fa
  EXPECT_EQ(fragments(100, {-3, 12, 2}), 30U);
  EXPECT_EQ(fragments(100, {0, not_a_number, 20}), 32U);  // 31.4 by $fs alone
  EXPECT_THROW(fragments(1, {1e9, 12, 2}), Error);
  EXPECT_THROW(fragments(1e90, {0, 1e-5, 1e-5}), Error);
}

// Worked by hand: the least count is one slice for every 120 degrees begun.
TEST(OpenscadSlices, FollowTheRule) {
  EXPECT_EQ(helix_slices(1, 1, 90, {20, 12, 2}), 5U);
  EXPECT_EQ(helix_slices(1, 1, 90, {0, 12, 2}), 1U);    // length 1.86 within one $fs
  EXPECT_EQ(helix_slices(1, 1, -400, {0, 12, 2}), 4U);  // 400 / 120
  EXPECT_EQ(helix_slices(1e4, 1, 90, {0, 12, 2}), 8U);  // 90 / 12
  EXPECT_EQ(helix_slices(0, 1, 90, {20, 12, 2}), 1U);   // no radius
  EXPECT_EQ(diagonal_slices(9, 4, {0, 12, 2}), 3U);     // length 5
  EXPECT_EQ(diagonal_slices(9, 4, {7.5, 12, 2}), 7U);
  EXPECT_EQ(conical_helix_slices(1e4, 1, 90, 0.5, {0, 12, 2}), 8U);
  EXPECT_EQ(conical_helix_slices(1e4, 1, 90, 2, {10, 12, 2}), 3U);
  EXPECT_THROW(helix_slices(1, 1, 1e9, {1e9, 12, 2}), Error);
}

Polyhedron rational_form(const IntegerPolyhedron& polyhedron) {
  return place(AffineMap::identity(), polyhedron);
}

// LAW tessellation.1: the complete check of convexity and planarity accepts the shapes, and finds
// nothing to merge.
TEST(OpenscadShapes, AreExactlyPlanarAndConvex) {
  ShapeCache shapes;
  for (const std::size_t n : {3U, 4U, 5U, 6U, 7U, 8U, 12U, 13U, 30U}) {
    for (const IntegerPolyhedron& shape :
         {shapes.sphere(n), shapes.cylinder(n), shapes.frustum(n, Rational(1, 3)),
          shapes.frustum(n, 0), shapes.frustum(n, 5), shapes.box()}) {
      const Polyhedron polyhedron = rational_form(shape);
      const ConvexPolytope checked = make_convex_polytope(polyhedron);
      EXPECT_EQ(checked.polyhedron->facets.size(), polyhedron.facets.size()) << n;
      EXPECT_EQ(checked.polyhedron->vertices.size(), polyhedron.vertices.size()) << n;
    }
  }
}

// LAW tessellation.2, against the formulas of OPENSCAD's primitives in long double.
TEST(OpenscadShapes, AreWithinTheRoundingBound) {
  ShapeCache shapes;
  const double bound = nearest_double(unit_rounding_bound());
  constexpr auto pi = std::numbers::pi_v<long double>;
  for (const std::size_t n : {3U, 5U, 16U, 31U, 100U}) {
    const std::size_t rings = (n + 1) / 2;
    const Polyhedron sphere = rational_form(shapes.sphere(n));
    ASSERT_EQ(sphere.vertices.size(), n * rings);
    for (std::size_t j = 0; j < rings; ++j) {
      const long double phi =
          pi * (static_cast<long double>(j) + 0.5L) / static_cast<long double>(rings);
      for (std::size_t i = 0; i < n; ++i) {
        const long double theta =
            2 * pi * static_cast<long double>(i) / static_cast<long double>(n);
        const Point3& p = sphere.vertices[j * n + i];
        EXPECT_NEAR(nearest_double(p.x), static_cast<double>(std::sin(phi) * std::cos(theta)),
                    bound);
        EXPECT_NEAR(nearest_double(p.y), static_cast<double>(std::sin(phi) * std::sin(theta)),
                    bound);
        EXPECT_NEAR(nearest_double(p.z), static_cast<double>(std::cos(phi)), bound);
      }
    }
  }
}

TEST(OpenscadShapes, AreRefusedBeyondTheLimit) {
  ShapeCache shapes;
  EXPECT_THROW(shapes.sphere(10'000), Error);
  EXPECT_THROW(shapes.cylinder(shape_vertex_limit), Error);
}

// A mirroring map turns the facets round: the complete check would find the polytope inside out.
TEST(OpenscadShapes, StayRightSideOutUnderMirrors) {
  ShapeCache shapes;
  AffineMap mirror = AffineMap::identity();
  mirror.m[0] = {Rational(-2), Rational(1, 3), 0, 7};
  EXPECT_NO_THROW(make_convex_polytope(place(mirror, shapes.sphere(7))));
}

}  // namespace
}  // namespace exactcsg::io::openscad
