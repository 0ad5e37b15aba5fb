// SPDX-License-Identifier: Apache-2.0
#pragma once

// Facets that need no merging: most of a model's boundary is facets of which nothing was cut off,
// each alone in its plane. [Exact]
//
// A facet is settled if it came out as boundary whole, lies in the plane of no other facet of the
// scene (in either sense), and surely turns at every corner. No other piece of boundary lies in its
// plane: its sides bound a face as they are, and between two settled facets a side is an edge, but
// for vertices of other edges that touch it: not if either facet is in general position in all of
// its cells (LAW pieces.3).

#include <cstdint>
#include <vector>

#include "exactcsg/solid/cell_evaluation.hpp"
#include "exactcsg/solid/scene.hpp"

namespace exactcsg {

class SettledFacets {
 public:
  enum class Emitted : unsigned char { NotWhole = 0, Whole, InGeneralPosition };

  // emitted: by facet.
  SettledFacets(const Scene& scene, const std::vector<Emitted>& emitted, unsigned threads);

  bool is_settled(const BoundaryPiece& piece) const { return is_settled(piece.plane.plane); }
  // Whether the plane is that of a settled facet.
  bool is_settled(PlaneRef plane) const {
    return !plane.is_wall() && planes_[plane.table_index()] != Emitted::NotWhole;
  }
  // Asks for what is_settled(plane) reads. REQUIRES no wall
  void prefetch(PlaneRef plane) const { __builtin_prefetch(&planes_[plane.table_index()]); }
  // REQUIRES is_settled(plane)
  bool is_in_general_position(PlaneRef plane) const {
    return planes_[plane.table_index()] == Emitted::InGeneralPosition;
  }

 private:
  std::vector<Emitted> planes_;  // by table index; NotWhole: no settled facet's plane
};

// REQUIRES whole facets were restored: a piece is a whole facet of the scene iff its share says so.
// COST: O(facets of the scene + pieces).
SettledFacets settled_facets(const Scene& scene, const std::vector<PieceBuffer>& buffers,
                             unsigned threads);

}  // namespace exactcsg
