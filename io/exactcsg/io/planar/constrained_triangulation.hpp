// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The triangulation of a polygon with holes by a constrained, nearly Delaunay triangulation: no
// vertex is added, and every orientation is decided exactly. [Exact]
//
// LAW triangulation.1  every edge of the loops is an edge of the triangles, and the triangles,
// counter-clockwise, cover exactly the points with an odd number of loops round them.
// REQUIRES loops that meet in common vertices only; distinct points.
// COST: O(n log n) expected.

#include <array>
#include <cstdint>
#include <vector>

#include "exactcsg/io/planar/planar.hpp"

namespace exactcsg::io {

using TriangleIndices = std::array<std::uint32_t, 3>;

// The loops' vertices are indices of points; points of no loop are ignored.
std::vector<TriangleIndices> triangulate_loops(const std::vector<std::vector<std::uint32_t>>& loops,
                                               const std::vector<Point2>& points);

}  // namespace exactcsg::io
