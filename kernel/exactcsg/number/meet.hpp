// SPDX-License-Identifier: Apache-2.0
#pragma once

// The meeting point of three planes in certified doubles. Private to number/. [Certified]

#include <array>
#include <optional>

#include "exactcsg/number/approximate_plane.hpp"

namespace exactcsg {

// nullopt if the doubles do not determine it to a small fraction of its distance from the origin.
std::optional<ApproximatePoint> approximate_meeting_point(
    const std::array<ApproximatePlane, 3>& planes);

// Where a plane crosses the segment between two points on different sides of it, which are known by
// their doubles; nullopt as above. Planes through the segment that are nearly parallel do no harm.
std::optional<ApproximatePoint> approximate_crossing(const ApproximatePlane& plane,
                                                     const ApproximatePoint& from,
                                                     const ApproximatePoint& to);

// Sets the coordinate of a point of an exactly axis-parallel plane.
void snap(const ApproximatePlane& plane, ApproximatePoint& point);

// The certified bound of the doubles' determinant det(n_p, n_q, n_r).
struct ApproximateDeterminant {
  double value;
  double error;
};
ApproximateDeterminant approximate_determinant(const ApproximatePlane& p, const ApproximatePlane& q,
                                               const ApproximatePlane& r);

}  // namespace exactcsg
