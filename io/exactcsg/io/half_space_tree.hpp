// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// A solid of planar primitives as a tree of half-spaces, so that it can be held against curved
// ones. [Exact]
//
// LAW half_space_tree.1  the tree has the solid's points, up to boundaries.
// Every primitive must be a half-space or convex: of a mesh this is checked.
// THROWS Error(NotConvex), with the primitive's origin, of a mesh that is not.

#include "exactcsg/domain/bounded_primitives.hpp"
#include "exactcsg/solid/solid.hpp"

namespace exactcsg::io {

domain::Solid3 half_space_tree(const Solid& solid);

}  // namespace exactcsg::io
