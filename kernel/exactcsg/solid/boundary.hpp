// SPDX-License-Identifier: Apache-2.0
#pragma once

// The canonical boundary of a solid. [Exact]
//
// A vertex is a point where edges of at least two directions meet; an edge is maximal between
// vertices; a face is a maximal connected region of one oriented plane, with holes.
//
// LAW boundary.1  it depends on the point set alone: not on how the tree is written, on the cells
// of the decomposition, on the executor or on the number of threads. LAW boundary.2  vertices are
// sorted lexicographically, edges by (from, to) with from < to, faces by their loops, planes by
// their first face; a loop starts at its smallest vertex. LAW boundary.3  for a bounded solid the
// directed edges of all loops balance: every edge is walked as often in one direction as in the
// other.
//
// Source: DESIGN section 5 (docs/architecture.md); MEG (longest wires) in the Bath modellers'
// paper.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "exactcsg/number/exact_points.hpp"
#include "exactcsg/number/point.hpp"
#include "exactcsg/number/tier_statistics.hpp"

namespace exactcsg {

struct BoundaryEdge {
  std::uint32_t from = 0;  // indices of vertices, from < to
  std::uint32_t to = 0;
  friend auto operator<=>(const BoundaryEdge&, const BoundaryEdge&) = default;
};

struct BoundaryFace {
  // Faces of one oriented plane have one number, below plane_count. exact_plane of face_planes.hpp
  // gives its coefficients.
  std::uint32_t plane = 0;
  // Vertex indices of each boundary component, the face on the left seen from outside (outer loops
  // counter-clockwise, holes clockwise). Every edge of a loop is an edge of the boundary.
  std::vector<std::vector<std::uint32_t>> loops;
};

struct EvaluationStatistics {
  TierStatistics tiers;
  std::uint64_t primitives = 0;
  std::uint64_t facets = 0;           // of all primitives
  std::uint64_t cells = 0;            // leaves of the decomposition
  std::uint64_t evaluated_cells = 0;  // of these, cells that needed two-sided classification
  std::uint64_t pieces = 0;           // parts of facets that are boundary, before merging
};

struct Boundary {
  ExactPoints vertices;
  std::vector<std::array<double, 3>> approximate;  // vertices rounded to nearest
  std::uint32_t plane_count = 0;                   // distinct oriented planes of faces
  std::vector<BoundaryEdge> edges;
  std::vector<BoundaryFace> faces;
  EvaluationStatistics statistics;

  bool empty() const { return faces.empty(); }
};

struct Topology {
  std::uint64_t vertices = 0;
  std::uint64_t edges = 0;
  std::uint64_t faces = 0;
  // Connected components of the interior, and bounded components of the complement. Where the
  // boundary touches itself along an edge or at a vertex, interiors that meet only there are
  // different components.
  std::uint64_t components = 0;
  std::uint64_t cavities = 0;
  // Sum over the boundary's shells (each a closed surface after it is pulled apart where it touches
  // itself, the solid's side kept together).
  std::int64_t genus = 0;
  friend bool operator==(const Topology&, const Topology&) = default;
};

Topology topology(const Boundary& boundary);

// 64 hexadecimal digits: SHA-256 over the sorted exact vertices, the edges and the sides of faces
// by oriented planes (docs/digest.md). LAW digest.1  equal boundaries have equal digests, and (but
// for a collision of SHA-256) equal digests mean the same solid. Vertices and edges without the
// sides would not do. LAW digest.2  it does not depend on the order of vertices, edges, planes,
// faces and loops.
std::string digest(const Boundary& boundary);

}  // namespace exactcsg
