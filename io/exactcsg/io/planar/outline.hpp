// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Outlines (exactcsg/planar/outline.hpp) in convex parts. [Exact]

#include <vector>

#include "exactcsg/io/planar/planar.hpp"
#include "exactcsg/planar/outline.hpp"

namespace exactcsg::io {

using exactcsg::Outline;
using exactcsg::outline_of;
using exactcsg::OutlineComponent;
using exactcsg::PlanarLoop;
using exactcsg::strictly_convex;

// Convex polygons of the component's points, counter-clockwise, interior-disjoint, strictly convex
// at every vertex; every edge of the component's loops is an edge of one of them, every other edge
// of two. COST: O(n log n) expected.
std::vector<PlanarLoop> convex_parts(const Outline& outline, const OutlineComponent& component);

}  // namespace exactcsg::io
