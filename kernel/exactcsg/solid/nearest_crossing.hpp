// SPDX-License-Identifier: Apache-2.0
#pragma once

// In or out of a closed mesh by the nearest crossing of a segment. [Exact]

#include <functional>
#include <vector>

#include "exactcsg/csg/boolean_operator.hpp"
#include "exactcsg/number/geometry.hpp"
#include "exactcsg/solid/box_pairs.hpp"
#include "exactcsg/solid/scene.hpp"

namespace exactcsg {

// A box that certainly holds the vertex.
DoubleBox box_of(const Vertex& vertex);
DoubleBox box_of(const Point3& point);
// The same of all corners, of which there is one at least.
DoubleBox box_of(const CornerView& corners);

// The membership of a point that lies on none of the facets. The facets are those parts of a closed
// mesh's boundary that meet a convex region, and the point is in that region; bounds_of(f) is a box
// that holds facet f, corners_of(f) its corners, counter-clockwise from outside.
// Segments from the point towards facets are tried until one meets neither a side nor a corner; its
// nearest crossing decides. REQUIRES facet_count > 0
csg::Membership nearest_crossing(const Point3& point, std::size_t facet_count,
                                 const std::function<DoubleBox(std::size_t)>& bounds_of,
                                 const std::function<std::vector<Point3>(std::size_t)>& corners_of);

}  // namespace exactcsg
