// SPDX-License-Identifier: Apache-2.0
#pragma once

// In or out of a closed mesh at a point of a convex region, from the facets in that region. [Exact]

#include <span>

#include "exactcsg/csg/boolean_operator.hpp"
#include "exactcsg/solid/local_form.hpp"

namespace exactcsg {

// In or Out of a mesh for a point that lies on none of its facets, from the facets of a convex
// region that holds the point: the nearest crossing of a segment decides; a segment that meets a
// side or a corner is given up for another. REQUIRES the point is the meeting point of three walls
// and facets is not empty. COST: O(facets) doubles where they decide, as they nearly always do;
// else rationals.
csg::Membership mesh_membership(const Geometry& geometry, const Vertex& point,
                                std::span<const FacetPolygon> facets, TierStatistics& statistics);

}  // namespace exactcsg
