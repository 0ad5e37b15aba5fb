// SPDX-License-Identifier: Apache-2.0
#pragma once

// Certified double coefficients of planes. Private to number/. [Certified]

#include <array>
#include <optional>

#include "exactcsg/number/geometry.hpp"
#include "exactcsg/number/point_table.hpp"

namespace exactcsg {

using ApproximatePlane = Geometry::ApproximatePlane;

// Stored errors are larger than the derived bounds by this factor, which pays for the roundings of
// evaluating the bounds themselves, here and in the filters (each a few units of 2^-53).
inline constexpr double error_inflation = 1 + 0x1p-45;
// A plane whose normal is not known to this relative error is computed exactly.
inline constexpr double poorest_normal = 0x1p-36;

// Errors of at most 2^-52 of the largest normal coefficient and of the offset, zero where the
// doubles are exact. An axis-parallel plane has a normal of exactly +-1 and zeros.
// An offset beyond the doubles' range has an infinite error.
ApproximatePlane approximate(const Plane& plane);

// From the doubles of three points; nullopt if they do not determine the normal to
// `poorest_normal`, or leave the doubles' comfortable range.
std::optional<ApproximatePlane> approximate_plane_through(const ApproximatePoint& p,
                                                          const ApproximatePoint& q,
                                                          const ApproximatePoint& r);

// The same of a plane through two points that contains an axis' direction; the normal is
// (q - p) x (the axis).
std::optional<ApproximatePlane> approximate_plane_along(const ApproximatePoint& p,
                                                        const ApproximatePoint& q, Axis axis);

// The axis-parallel plane {axis = position} of this sense, exact but for the position's error.
ApproximatePlane axis_parallel(Axis axis, int sense, double position, double error);

// The axis of a plane that is known to be exactly axis-parallel.
inline std::optional<Axis> exact_axis(const ApproximatePlane& p) {
  if (p.normal_error != 0) return std::nullopt;
  if (p.b == 0 && p.c == 0) return Axis::X;
  if (p.c == 0 && p.a == 0) return Axis::Y;
  if (p.a == 0 && p.b == 0) return Axis::Z;
  return std::nullopt;
}

ApproximatePlane opposite(const ApproximatePlane& plane);

// Whether the doubles exclude that both are the same plane, in either sense.
bool certainly_different(const ApproximatePlane& p, const ApproximatePlane& q);

}  // namespace exactcsg
