// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// An evaluated solid as a primitive again. [Exact]

#include "exactcsg/solid/boundary.hpp"
#include "exactcsg/solid/solid.hpp"

namespace exactcsg::io {

// The solid with this boundary: one mesh of exact triangles between the boundary's own vertices, or
// Empty.
// LAW leaf.1  evaluate(solid_of_boundary(evaluate(s))) has the digest of evaluate(s).
// REQUIRES the canonical boundary of a bounded solid
// COST: O(n log n) expected, for the triangulation of faces that are not convex.
Solid solid_of_boundary(const Boundary& boundary);

}  // namespace exactcsg::io
