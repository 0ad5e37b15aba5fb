// SPDX-License-Identifier: Apache-2.0
#pragma once

// The orientation of four exact points, filtered in double. [Exact]

#include <concepts>
#include <cstddef>

#include "exactcsg/number/point.hpp"

namespace exactcsg {

// The side of the plane through a, b, c (counter-clockwise seen from outside) that d is on:
// Positive outside (along (b-a) x (c-a)), Zero in the plane (or if a, b, c are collinear).
// LAW orientation.1  equals the sign of dot(cross(b-a, c-a), d-a).
// COST: exact only near zero.
Sign orientation(const Point3& a, const Point3& b, const Point3& c, const Point3& d);

// The side of a planar convex polygon's plane that the point is on, as above. corner_at(i) is the
// i-th of at least three corners; some may be in the middle of a straight side.
// LAW orientation.2  equals the orientation of any three corners that are not collinear, in their
//                    order, and the point.
// COST: exact only near zero, or where the first corners are collinear.
template <std::invocable<std::size_t> CornerAt>
Sign side_of_polygon(std::size_t corner_count, CornerAt corner_at, const Point3& point) {
  const Point3& a = corner_at(0);
  for (std::size_t i = 2; i < corner_count; ++i) {
    const Point3& b = corner_at(i - 1);
    const Point3& c = corner_at(i);
    const Sign sign = orientation(a, b, c, point);
    if (sign != Sign::Zero) return sign;
    // Zero as well for corners that are collinear, and then the next ones are asked.
    const bool is_last = i + 1 == corner_count;
    if (!is_last && cross(b - a, c - a) != Vector3{}) return Sign::Zero;
  }
  return Sign::Zero;
}

}  // namespace exactcsg
