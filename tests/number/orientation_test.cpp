// SPDX-License-Identifier: GPL-3.0-or-later
// Against the value of the plane in rational arithmetic.
#include "exactcsg/number/orientation.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>

#include "number/reference.hpp"

namespace exactcsg {
namespace {

using Random = std::mt19937_64;

// Thirds, most of which no double holds.
Rational third(Random& random) {
  Rational value(static_cast<long>(random() % 9) - 4, 3);
  value.canonicalize();
  return value;
}

Point3 point(Random& random) { return {third(random), third(random), third(random)}; }

Sign expected_side(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
  return sign_of(reference::value_at(reference::plane_through(a, b, c), d));
}

// LAW orientation.1
TEST(Orientation, IsTheSideOfThePlane) {
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const Point3 a = point(random);
    const Point3 b = point(random);
    const Point3 c = point(random);
    Point3 d = point(random);
    ASSERT_EQ(orientation(a, b, c, d), expected_side(a, b, c, d));
    // In the plane, and so near to it that no double tells.
    d = a + third(random) * (b - a) + third(random) * (c - a);
    ASSERT_EQ(orientation(a, b, c, d), Sign::Zero);
    d.z += Rational(1, Integer(1) << 200);
    ASSERT_EQ(orientation(a, b, c, d), expected_side(a, b, c, d));
  }
}

// LAW orientation.2: an oblique rectangle with a corner in the middle of a side, from each corner.
TEST(Orientation, OfAPolygonWithCollinearCorners) {
  Random random(2);
  for (int i = 0; i < 500; ++i) {
    const Point3 origin = point(random);
    const Point3 right = point(random);
    const Point3 up = point(random);
    const Vector3 u = right - origin;
    const Vector3 v = up - origin;
    const std::array corners{origin, origin + Rational(1, 3) * u, right, right + v, up};
    const Point3 in_plane = origin + third(random) * u + third(random) * v;
    for (const Point3& asked : {point(random), in_plane}) {
      for (std::size_t first = 0; first < corners.size(); ++first) {
        const auto corner_at = [&](std::size_t k) { return corners[(first + k) % corners.size()]; };
        ASSERT_EQ(side_of_polygon(corners.size(), corner_at, asked),
                  expected_side(origin, right, up, asked));
      }
    }
  }
}

}  // namespace
}  // namespace exactcsg
