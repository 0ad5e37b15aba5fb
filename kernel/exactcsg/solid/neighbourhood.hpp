// SPDX-License-Identifier: Apache-2.0
#pragma once

// The neighbourhood of a point: the cells that planes through it cut from a small sphere. [Exact]
//
// Every cell is named by a direction d + e u + e^2 w for small e > 0: it is on the side of a plane
// with normal n that the first non-zero one of n.d, n.u, n.w says. Directions along the meeting
// lines of two planes, then along one of the planes, then off it, reach every cell, because every
// cell has a corner on the sphere (or, where all planes share a line, lies at its ends).
// Source: Tilove; Requicha and Voelcker (neighbourhoods in set membership classification).

#include <functional>
#include <span>
#include <vector>

#include "exactcsg/number/point.hpp"
#include "exactcsg/solid/classify.hpp"

namespace exactcsg {

// In if membership is In in all cells, Out if it is Out in all, On otherwise. membership(sides) is
// asked with the side of every plane (Positive: along its normal), in their order.
// REQUIRES the planes are pairwise different point sets. COST: at most O(planes^3) questions, far
// fewer where the answer is On.
PointClass classify_neighbourhood(
    std::span<const Plane> planes_through_point,
    const std::function<csg::Membership(std::span<const Sign> sides)>& membership);

}  // namespace exactcsg
