// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// From solids to planar figures: shadows and sections. [Exact]

#include "exactcsg/io/planar/planar.hpp"

namespace exactcsg::io {

// The shadow of the solid under light along the z axis.
//
// LAW projection.1  shadow(A or B) = shadow(A) or shadow(B).
// THROWS Error(UnboundedSolid). COST: an evaluation, unless the solid only unites bounded
// primitives; then the union of their shadows.
PlanarTree shadow(const Solid& solid);

// The regularised intersection of the closed solid with the plane z = 0: a solid that stands on the
// plane leaves its footprint.
//
// LAW projection.2  section(A or B) = section(A) or section(B).
// THROWS Error(UnboundedSolid). COST: two evaluations, of the parts above and below the plane.
PlanarTree section(const Solid& solid);

}  // namespace exactcsg::io
