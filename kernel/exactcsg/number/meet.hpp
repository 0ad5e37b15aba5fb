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

// The certified bound of the doubles' determinant det(n_p, n_q, n_r).
struct ApproximateDeterminant {
  double value;
  double error;
};
ApproximateDeterminant approximate_determinant(const ApproximatePlane& p, const ApproximatePlane& q,
                                               const ApproximatePlane& r);

}  // namespace exactcsg
