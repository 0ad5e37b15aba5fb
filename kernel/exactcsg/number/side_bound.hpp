// SPDX-License-Identifier: Apache-2.0
#pragma once

// The bound of Geometry::filtered_side for any vertex near the origin and known well enough, so
// that it can be computed once for many. [Certified]

#include <cmath>

#include "exactcsg/number/geometry.hpp"

namespace exactcsg {

// How far the doubles' a x + b y + c z + d may be off the true (scaled) value for a vertex with
// |x| + |y| + |z| <= length and an error of at most `error`; as Geometry::filtered_side derives it.
// Infinity or NaN: nobody knows.
inline double side_bound(const Geometry::ApproximatePlane& plane, double length, double error) {
  constexpr double rounding = 6 * 0x1p-53;
  return length * (plane.normal_error + rounding) +
         (plane.offset_error + std::fabs(plane.d) * rounding) + 4 * error + 0x1p-1022;
}

}  // namespace exactcsg
