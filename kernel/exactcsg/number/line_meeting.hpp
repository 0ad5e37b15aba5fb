// SPDX-License-Identifier: Apache-2.0
#pragma once

// Where lines through two points meet planes. Private to number/. [Exact]
//
// Denominators are kept as an odd number times a power of two: those of coordinates that come from
// doubles and short decimals have short odd parts, so that the common divisors that are sought are
// short, too.

#include <gmp.h>

#include <array>

#include "exactcsg/number/point.hpp"
#include "exactcsg/number/rational_view.hpp"

namespace exactcsg {

// The points x with normal.x = offset / (odd 2^exponent). The normal is of any length but 0.
struct PlaneForm {
  std::array<Integer, 3> normal;
  Integer offset;
  Integer odd;  // an odd number > 0
  mp_bitcnt_t exponent = 0;
};

// COST: much less than of coprime coefficients
// REQUIRES points that are not on one line
PlaneForm plane_form_through(const PointView& p, const PointView& q, const PointView& r);
PlaneForm plane_form_of(const Plane& plane);

// Where the line through p and q meets a plane. The view is of limbs of p, which are shared where
// the whole line has a coordinate in common, and of limbs that last until the thread calls this
// again. REQUIRES p != q, and that the line is not parallel to the plane
PointView meeting_point_of_line(const PointView& p, const PointView& q, const PlaneForm& plane);

}  // namespace exactcsg
