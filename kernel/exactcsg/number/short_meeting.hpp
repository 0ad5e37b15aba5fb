// SPDX-License-Identifier: Apache-2.0
#pragma once

// Planes and meeting points of input points whose coordinates are short, as nearly all are: as
// line_meeting.hpp says, in integers of few limbs. Private to number/. [Exact]

#include <optional>

#include "exactcsg/number/line_meeting.hpp"

namespace exactcsg {

// LAW short_meeting.1  the plane of plane_form_through, and the view of meeting_point_of_line, or
// nothing if a number is too long.
std::optional<PlaneForm> short_plane_form_through(const PointView& p, const PointView& q,
                                                  const PointView& r);
std::optional<PointView> short_meeting_point_of_line(const PointView& p, const PointView& q,
                                                     const PlaneForm& plane);

}  // namespace exactcsg
