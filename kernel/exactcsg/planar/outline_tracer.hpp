// SPDX-License-Identifier: Apache-2.0
#pragma once

// From boundary edges to loops and components. Private to the kernel. [Exact]

#include "exactcsg/planar/boundary_edges.hpp"
#include "exactcsg/planar/outline.hpp"

namespace exactcsg::planar {

// LAW outline.1 to outline.3. COST: O(n log n) for n edges.
Outline trace_outline(const Scene& scene, const BoundaryEdges& boundary);

}  // namespace exactcsg::planar
