// SPDX-License-Identifier: Apache-2.0
#pragma once

// Pieces of boundary, as cells and facets emit them for merging. Internal to the evaluator. [Exact]
//
// LAW pieces.1  in one buffer, a meeting point of three planes is stored once, however many pieces
//               have it for a corner.
//
// LAW pieces.3  a cell is in general position if in all signs that deciding it took no corner of
//               a facet lay in a plane or a wall by chance, being no meeting point of it, no facets
//               of two primitives are coplanar in it, no primitive in it meets itself, and no plane
//               of a mesh cut a facet: the planes of one mesh may have a line or a point of the
//               facet in common by chance, and not all of them are asked for. Then the edges of its
//               pieces have no point in common but common ends, and two of them lie on one line
//               only if they lie in the same two planes: where edges p q and r s of different
//               primitives meet, a facet in p has a corner in p, q and r (or a cut makes one) whose
//               side of s is asked for, since nothing has settled yet whether it is inside the
//               other primitive; and a point of contact on a wall lies in both cells, or in an edge
//               that lies in the wall.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "exactcsg/solid/polygon.hpp"
#include "exactcsg/solid/scene.hpp"

namespace exactcsg {

// How much of a facet a polygon is, as a share of `whole`: every cut into two halves the share of
// either part, whatever their areas. The parts of a facet that have a share therefore add up to
// `whole` only if none is missing. After 62 cuts a part has no share any more.
namespace facet_share {
inline constexpr std::uint64_t whole = std::uint64_t{1} << 62U;
}

struct BoundaryPiece {
  OrientedPlaneRef plane;        // outward normal of the solid
  signed char corner_sense = 1;  // corners are counter-clockwise about the stored normal if +1
  // In the buffer's store; none of a whole facet, whose corners are the scene's.
  std::uint32_t first_corner = 0;
  std::uint32_t corner_count = 0;
  FacetIndex facet = 0;     // of the scene, that this is a part of
  std::uint64_t share = 0;  // of that facet
  // In its cells (LAW pieces.3).
  bool in_general_position = false;
  // The corners bound a hole in the piece before this one, clockwise seen from its front.
  bool is_hole = false;
  // The part of the facet on one side each of some walls, not cut yet: instead of corners there are
  // the walls, as side planes, with 1 as the vertex if what is above is kept.
  bool is_slice = false;
};

struct PieceCorner {
  PlaneRef side_plane;
  std::uint32_t vertex = 0;  // an input point's id, or a place among the buffer's meeting points
  bool is_point = false;
};

struct PieceBuffer {
  std::vector<BoundaryPiece> pieces;
  std::vector<PieceCorner> corners;
  std::vector<Vertex> meeting_points;

  // REQUIRES the piece is not a whole facet
  std::span<const PieceCorner> corners_of(const BoundaryPiece& piece) const {
    return std::span(corners).subspan(piece.first_corner, piece.corner_count);
  }
  // REQUIRES piece.is_slice
  Slice slice_of(const BoundaryPiece& piece) const {
    Slice slice;
    for (const PieceCorner& wall : corners_of(piece)) {
      slice.add({wall.side_plane, wall.vertex == 1 ? Sign::Positive : Sign::Negative});
    }
    return slice;
  }
};

// What both hold, without looking for meeting points that both have.
void append(const PieceBuffer& added, PieceBuffer& result);

// LAW pieces.2  the same pieces, with the same corners, in memory of the right size: without
// corners that belong to no piece, or to one that has become a whole facet, and without meeting
// points that no corner has. COST: O(corners)
PieceBuffer compacted(const PieceBuffer& buffer);

// Builds one buffer after the other in the same memory.
class PieceCollector {
 public:
  // The corners are stored unless the share is that of a whole facet. COST: O(1) a corner
  void add(OrientedPlaneRef outward, signed char corner_sense, FacetIndex facet,
           std::uint64_t share, const CornerView& polygon);
  // The same without corners, which add_corner adds to the last piece. A piece with corners of its
  // own need not be convex. REQUIRES share != facet_share::whole
  void begin(OrientedPlaneRef outward, signed char corner_sense, FacetIndex facet,
             std::uint64_t share, bool is_hole = false);
  void add_corner(const Vertex& vertex, PlaneRef side_plane);
  void add_slice(OrientedPlaneRef outward, signed char corner_sense, FacetIndex facet,
                 std::uint64_t share, const Slice& slice);

  struct Mark {
    std::size_t pieces;
    std::size_t corners;
    std::size_t meeting_points;
  };
  Mark mark() const;
  std::span<const BoundaryPiece> pieces_since(const Mark& mark) const;
  // Takes back what was added since. REQUIRES no earlier mark was taken back to since
  void take_back_to(const Mark& mark);

  // What was added since the last call, in memory of the right size.
  PieceBuffer take(bool in_general_position = false);
  // Forgets it: what a cell added before an error or a cancellation ended it.
  void discard();

  // Goes on with a buffer in place of what was added.
  void resume(PieceBuffer buffer);
  const PieceBuffer& buffer() const { return buffer_; }
  // Gives a piece that is a slice its corners.
  void cut_slice(std::size_t piece, const CornerView& polygon);

 private:
  struct Slot {
    std::uint32_t place = 0;  // among the meeting points
    std::uint32_t round = 0;  // in use if it is the present one
  };

  void append_corner(const Vertex& vertex, PlaneRef side_plane);
  std::uint32_t place_of(const Vertex& meeting_point);
  Slot& slot_of(const Vertex& meeting_point);
  void enlarge_slots();

  PieceBuffer buffer_;
  std::vector<Slot> slots_;  // open addressing
  std::uint32_t round_ = 1;
};

}  // namespace exactcsg
