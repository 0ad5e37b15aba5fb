// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Does a Boundary keep the laws of its contract (solid/boundary.hpp)? [Exact]
//
// Checked by rational arithmetic on the boundary alone: sorted and distinct (boundary.2), directed
// edges balance (boundary.3), vertices lie on their faces' planes, loops are simple in what they
// use, outer loops and holes turn the right way, no vertex inside a straight edge, every vertex,
// edge and plane is used, and the volume is positive.

#include <vector>

#include "exactcsg/solid/boundary.hpp"
#include "exactcsg/verify/report.hpp"

namespace exactcsg::verify {

Check check_boundary_laws(const Boundary& boundary);

// The measures that the library prints (enclosures, exact volume, topology's Euler count) against
// sums made here from the loops.
std::vector<Check> check_measures(const Boundary& boundary);

}  // namespace exactcsg::verify
