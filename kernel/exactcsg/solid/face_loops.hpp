// SPDX-License-Identifier: Apache-2.0
#pragma once

// Directed edges of faces linked to loops, and faces in canonical order. [Exact]

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "exactcsg/number/geometry.hpp"
#include "exactcsg/solid/boundary.hpp"
#include "exactcsg/solid/oriented_table_plane.hpp"

namespace exactcsg {

// An edge as a face's boundary walks it: the face on the left, seen from outside.
struct FaceEdge {
  OrientedTablePlane plane;
  std::uint32_t face = 0;  // any number that edges of one face share
  std::uint32_t from = 0;  // indices of the boundary's vertices
  std::uint32_t to = 0;
};

// Faces that are the only ones in their planes, each with one loop that meets no vertex twice. The
// loops lie one after the other.
struct SingleFaces {
  std::vector<std::uint32_t> vertices;  // indices of the boundary's vertices, from any of a loop
  std::vector<std::uint32_t> ends;      // of each loop, among them

  std::size_t count() const { return ends.size(); }
  // Where its loop begins.
  std::uint32_t begin(std::size_t face) const { return face == 0 ? 0 : ends[face - 1]; }
  std::span<std::uint32_t> loop(std::size_t face) {
    return std::span(vertices).subspan(begin(face), ends[face] - begin(face));
  }
  std::span<const std::uint32_t> loop(std::size_t face) const {
    return std::span(vertices).subspan(begin(face), ends[face] - begin(face));
  }
};

// Sets boundary.faces and boundary.plane_count. Where a face touches itself at a vertex, its
// interior is kept connected on the left of each passage. REQUIRES no edge lies in the plane of a
// single face. REQUIRES boundary.vertices and approximate are set. THROWS Error(InternalError) if
// edges do not balance at some vertex of a face.
void link_faces(const Geometry& geometry, std::vector<FaceEdge> edges, SingleFaces singles,
                Boundary& boundary, unsigned threads = 1);

}  // namespace exactcsg
