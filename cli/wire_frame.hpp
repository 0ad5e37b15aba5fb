// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "exactcsg/solid/boundary.hpp"

namespace exactcsg::cli {

// The edges in four views (front, right, top, axonometric) as one SVG drawing to one scale.
// [Approximate: to a hundredth of a pixel]
std::string wire_frame_svg(const Boundary& boundary, const std::string& title);

}  // namespace exactcsg::cli
