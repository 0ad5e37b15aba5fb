// SPDX-License-Identifier: Apache-2.0
#pragma once

// The orientation of four exact points, filtered in double. [Exact]

#include "exactcsg/number/point.hpp"

namespace exactcsg {

// The side of the plane through a, b, c (counter-clockwise seen from outside) that d is on:
// Positive outside (along (b-a) x (c-a)), Zero in the plane (or if a, b, c are collinear). LAW
// orientation.1  equals the sign of dot(cross(b-a, c-a), d-a). COST: exact only near zero.
Sign orientation(const Point3& a, const Point3& b, const Point3& c, const Point3& d);

}  // namespace exactcsg
