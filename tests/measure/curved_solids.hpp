// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Curved solids whose volumes, and the areas of most, have closed forms, each derived where it
// stands.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "exactcsg/domain/bounded_primitives.hpp"
#include "exactcsg/domain/half_spaces.hpp"
#include "exactcsg/measure/certified_measure.hpp"

namespace exactcsg::measure::test {

using domain::Axis;
using domain::Box;
using domain::Coordinates;
using domain::HalfSpace;
using domain::Point;
using domain::Solid3;

inline Solid3 solid(HalfSpace<3> half_space) { return Solid3::primitive(std::move(half_space)); }
inline Point<3> point(const Rational& x, const Rational& y, const Rational& z) {
  return Coordinates<3>{x, y, z};
}
inline Solid3 ball(const Point<3>& centre, const Rational& squared_radius) {
  return solid(domain::make_sphere(centre, squared_radius));
}
inline Solid3 cylinder(std::size_t axis, const Rational& squared_radius,
                       const Point<3>& on_axis = {}) {
  Coordinates<3> direction;
  direction[axis] = 1;
  return solid(domain::make_cylinder({on_axis, direction}, squared_radius));
}
// {normal . x <= bound}
inline Solid3 below(const Coordinates<3>& normal, const Rational& bound) {
  return solid(domain::make_plane(normal, Rational(-bound)));
}
// [-half, half]^3
inline Box<3> cube(const Rational& half) {
  const Rational low = -half;
  return {point(low, low, low), point(half, half, half)};
}

struct KnownSolid {
  std::string name;
  Solid3 set;
  Box<3> box;
  double volume;
  std::optional<double> area = std::nullopt;
};

inline std::vector<KnownSolid> known_solids() {
  using csg::intersect;
  using csg::subtract;
  using csg::unite;
  using std::numbers::pi;
  std::vector<KnownSolid> all;
  const Solid3 unit_ball = ball({}, 1);
  const Solid3 along_x = cylinder(0, 1);
  const Solid3 along_y = cylinder(1, 1);
  const Solid3 along_z = cylinder(2, 1);
  all.push_back({"ball", unit_ball, cube(2), 4 * pi / 3, 4 * pi});
  // Every section across y is a square of side 2 sqrt(1 - y^2): the integral of 4 (1 - y^2). A ball
  // of radius 1 touches all of the boundary: the area is three times the volume.
  all.push_back({"two cylinders", intersect(along_x, along_z), cube(2), 16.0 / 3, 16});
  // A cube of side sqrt 2, and six caps, the part of two cylinders beyond 1/sqrt 2 each. A ball of
  // radius 1 touches the boundary as above.
  all.push_back({"three cylinders", intersect(intersect(along_x, along_y), along_z), cube(2),
                 8 * (2 - std::numbers::sqrt2), 24 * (2 - std::numbers::sqrt2)});
  // The complete elliptic integral of the section's width, evaluated to 18 digits.
  all.push_back({"cylinders of radii 3 and 3/2",
                 intersect(cylinder(0, 9), cylinder(2, Rational(9, 4))), cube(4),
                 41.0410796806682577});
  // The integral of 2 sqrt(1 - r^2) over the disc of diameter 1, in polar coordinates. Of the
  // sphere 2 pi - 4 are in the cylinder, of the cylinder 4 are in the ball.
  all.push_back({"Viviani",
                 intersect(unit_ball, cylinder(2, Rational(1, 4), point(Rational(1, 2), 0, 0))),
                 cube(2), 2 * pi / 3 - 8.0 / 9, 2 * pi});
  // Two caps of height 1/2: pi h^2 (3 - h) / 3 each, and 2 pi h.
  all.push_back(
      {"lens", intersect(unit_ball, ball(point(1, 0, 0), 1)), cube(2), 5 * pi / 12, 2 * pi});
  // (3 sqrt 2 - 49 pi + 162 arctan sqrt 2) / 12 times the cube of the edge, sqrt 2; 18 digits. The
  // area is (8 pi - 18 arccos(1/3)) times the edge's square: four triangles on spheres.
  Solid3 reuleaux = ball({}, 2);
  for (const Point<3>& centre : {point(1, 1, 0), point(1, 0, 1), point(0, 1, 1)}) {
    reuleaux = intersect(reuleaux, ball(centre, 2));
  }
  all.push_back({"Reuleaux tetrahedron", reuleaux, cube(3), 1.19404238326616699,
                 2 * (8 * pi - 18 * std::acos(1.0 / 3))});
  // Outside the cube there are six caps of height 1 of a ball of radius 5: pi (15 - 1) / 3 each;
  // they do not meet, since 4^2 + 4^2 > 5^2. Their areas are 10 pi each, their discs' 9 pi.
  const Solid3 ball_5 = ball({}, 25);
  const Solid3 cube_8 = domain::make_block(cube(4));
  const double caps = 28 * pi;
  all.push_back({"ball without cube", subtract(ball_5, cube_8), cube(6), caps, 114 * pi});
  all.push_back({"ball in cube", intersect(ball_5, cube_8), cube(6), 500 * pi / 3 - caps, 94 * pi});
  all.push_back({"ball and cube", unite(ball_5, cube_8), cube(6), 512 + caps, 384 + 6 * pi});
  // The napkin ring of height 8: a ball of diameter 8; a zone of area 80 pi, and a cylinder's 48
  // pi.
  all.push_back(
      {"ball with a hole", subtract(ball_5, cylinder(2, 9)), cube(6), 256 * pi / 3, 128 * pi});
  // The radius is 3 + 3 z / 10: a cone with its apex at z = -10. Cut by x >= 2 and x >= 4: the
  // integral of the circular segments, evaluated to 15 digits; the rest by the volume 210 pi.
  const Solid3 frustum =
      intersect(solid(domain::make_cone({point(0, 0, -10), {0, 0, 1}}, Rational(9, 100))),
                intersect(below({0, 0, -1}, 0), below({0, 0, 1}, 10)));
  all.push_back(
      {"frustum beyond 2", intersect(frustum, below({-1, 0, 0}, -2)), cube(12), 156.276979970903});
  all.push_back(
      {"frustum up to 2", intersect(frustum, below({1, 0, 0}, 2)), cube(12), 503.457477282954});
  all.push_back(
      {"frustum beyond 4", intersect(frustum, below({-1, 0, 0}, -4)), cube(12), 31.7815784559137});
  // A cone of radius 3 and height 10 whose axis is (0, 3/5, 4/5), cut by the plane z = 4: an
  // oblique elliptic cone is left, evaluated to 15 digits; the rest by the volume 30 pi.
  const Solid3 tilted = domain::make_bounded_cone({point(0, 0, 0), {0, 6, 8}}, 9);
  all.push_back({"tilted cone above 4", intersect(tilted, below({0, 0, -1}, -4)), cube(16),
                 12.7357478956402});
  all.push_back(
      {"tilted cone below 4", intersect(tilted, below({0, 0, 1}, 4)), cube(16), 81.5120317120536});
  // 4 pi / 3 times the semi-axes 1, 1/2 and 1/3; the area by elliptic integrals, 17 digits.
  all.push_back({"ellipsoid",
                 solid(domain::make_ellipsoid<3>({}, {1, Rational(1, 4), Rational(1, 9)})), cube(2),
                 2 * pi / 9, 4.4008095646649703});
  // The tetrahedron in the cube of side 2: a third of it; four triangles of side 2 sqrt 2.
  all.push_back({"tetrahedron",
                 intersect(intersect(below({1, 1, 1}, 1), below({1, -1, -1}, 1)),
                           intersect(below({-1, 1, -1}, 1), below({-1, -1, 1}, 1))),
                 cube(2), 8.0 / 3, 8 * std::numbers::sqrt3});
  return all;
}

inline MeasureLimits to_width(double relative, std::uint64_t cells = 20'000'000) {
  MeasureLimits limits;
  limits.relative_width = relative;
  limits.cells = cells;
  return limits;
}

// A value that is known to 14 digits at least.
inline ::testing::AssertionResult encloses(const Enclosure& value, double expected) {
  const double slack = std::abs(expected) * 2e-15 * 10;
  if (value.lower <= rational_of(expected + slack) &&
      value.upper >= rational_of(expected - slack)) {
    return ::testing::AssertionSuccess();
  }
  return ::testing::AssertionFailure() << "[" << to_decimal(value.lower, 17) << ", "
                                       << to_decimal(value.upper, 17) << "] misses " << expected;
}

}  // namespace exactcsg::measure::test
