// SPDX-License-Identifier: Apache-2.0
#pragma once

// The boundary of the whole set: the cells' pieces joined where a wall cuts them, between numbered
// vertices. Private to the kernel. [Exact]

#include <cstdint>
#include <vector>

#include "exactcsg/planar/cell_evaluation.hpp"

namespace exactcsg::planar {

using VertexIndex = std::uint32_t;

// From a vertex to the next, along one line, with the set on its left.
struct BoundaryEdge {
  VertexIndex from = 0;
  VertexIndex to = 0;
  EdgeIndex edge = 0;  // of the line
  Sign way = Sign::Positive;
};

struct BoundaryEdges {
  std::vector<BoundaryEdge> edges;
  std::vector<PieceEnd> vertices;  // where each is; never at a wall
};

// LAW boundary_edges.1  vertices are distinct points.
// LAW boundary_edges.2  no two edges have an inner point in common; every vertex is the end of as
// many edges as it is the beginning of.
BoundaryEdges join_pieces(const Scene& scene, const std::vector<Piece>& pieces);

Point2 exact_vertex(const Scene& scene, const PieceEnd& vertex);

}  // namespace exactcsg::planar
