// SPDX-License-Identifier: Apache-2.0
#pragma once

// Two-sided classification of the facets of one cell. [Exact]
//
// Of every facet polygon we carry what every primitive of the cell is in front and behind, and cut
// it by the other primitives' local forms until the pruned tree is constant on both sides. Equal:
// no boundary. Different: boundary, turned by the side that is In. A piece that facets of several
// primitives cover is emitted by the lowest of them only.
//
// Of a slice (decomposition.hpp) the whole facet is held against the other primitives first: if it
// is outside one plane or inside all of them, so is its part in the cell. It is cut if that does
// not decide it.
//
// Most primitives leave a facet alone. Of one that is convex and crosses it, the section is taken:
// if it can be boundary only inside, or only inside differs, the section is the part to go on with.
// What the last primitive leaves outside is emitted as it is, with its notches and its hole
// (facet_section.hpp); where several primitives are left, a plane between their sections divides
// the part. A mesh divides it along the planes of its local form.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "exactcsg/csg/boolean_operator.hpp"
#include "exactcsg/csg/maintained_traverse.hpp"
#include "exactcsg/solid/facet_section.hpp"
#include "exactcsg/solid/local_form.hpp"
#include "exactcsg/solid/piece_buffer.hpp"
#include "exactcsg/solid/polygon.hpp"
#include "exactcsg/solid/scene.hpp"
#include "exactcsg/support/progress.hpp"

namespace exactcsg {

// Those of a cell's walls that cut a facet.
class CutWalls {
 public:
  bool any() const { return bits_ != 0; }
  bool across(std::size_t axis) const { return (bits_ >> 2 * axis & 3U) != 0; }
  bool lower(std::size_t axis) const { return (bits_ >> 2 * axis & 1U) != 0; }
  bool upper(std::size_t axis) const { return (bits_ >> 2 * axis & 2U) != 0; }
  void add_lower(std::size_t axis) { bits_ |= static_cast<unsigned char>(1U << 2 * axis); }
  void add_upper(std::size_t axis) { bits_ |= static_cast<unsigned char>(2U << 2 * axis); }

 private:
  unsigned char bits_ = 0;
};

Slice slice_of(const Cell& cell, CutWalls walls);

// A facet polygon of a cell and the primitive it belongs to; those of one primitive are adjacent.
struct CellFacet {
  PrimitiveIndex primitive = 0;
  FacetIndex facet = 0;
  std::uint64_t share = facet_share::whole;
  FacetPolygon polygon;  // of a slice, the facet as a whole
  CutWalls walls;
};

// What is known just in front of a facet, along the stored normal of its plane, and just behind.
struct BothSides {
  csg::Membership front = csg::Membership::Unknown;
  csg::Membership behind = csg::Membership::Unknown;
  friend bool operator==(const BothSides&, const BothSides&) = default;
};

struct CombineSides {
  BothSides operator()(const BothSides& a, csg::BooleanOperator op, const BothSides& b) const {
    return {csg::combine(a.front, op, b.front), csg::combine(a.behind, op, b.behind)};
  }
};

struct AbsorbsSides {
  bool operator()(const BothSides& a, csg::BooleanOperator op) const {
    return csg::absorbs(a.front, op) && csg::absorbs(a.behind, op);
  }
};

class CellEvaluator {
 public:
  // Asks the progress, if there is one, for cancellation once a facet.
  CellEvaluator(const Scene& scene, Progress* progress);

  // REQUIRES every primitive of the tree has facets in the cell, and every facet's primitive occurs
  // in the tree. Whether the cell is in general position, as far as that does not depend on walls
  // (LAW pieces.3).
  bool evaluate(std::span<const CellFacet> facets, const Cell& cell, const PrunedTree& tree,
                PieceCollector& result, TierStatistics& statistics);

 private:
  // A part of the facet at hand, and its share of the facet.
  struct Part {
    CornerRun polygon;
    std::uint64_t share;
  };
  struct LocalPrimitive {
    PrimitiveIndex primitive;
    bool convex;
    LocalPlace root;            // of a mesh
    std::uint32_t first_facet;  // in the cell
    std::uint32_t facet_count;
    std::uint32_t separating;  // of its facets, that whose plane left a polygon outside last
  };
  // The plane of a facet of the cell. A value of a x + b y + c z + d beyond the bound has the right
  // sign.
  struct NearPlane {
    OrientedPlaneRef oriented;
    double a, b, c, d;
    double bound;
  };
  // A primitive that crosses the part at hand, or has not been looked at.
  struct Crossing {
    std::uint32_t place;  // in order_
    CornerRun section;    // of the part with a convex primitive
    BothSides inside;     // what such a primitive is in front of the section and behind it
    bool is_known;        // the section is that with the part to be classified
  };
  // A row of them.
  struct Crossings {
    std::size_t begin;
    std::size_t end;
  };
  enum class Outcome : unsigned char { NoBoundary, Boundary, Undecided };
  enum class Relation : unsigned char { Outside, Inside, Across };

  void build_local_forms(std::span<const CellFacet> facets);
  void set_planes(std::span<const CellFacet> facets);
  LocalPlace local_form_of_mesh(std::span<const CellFacet> facets);
  void order_primitives_for(const CellFacet& facet);
  void join_pieces(const CellFacet& facet, const PieceCollector::Mark& before);
  void classify_slice(const CellFacet& facet);
  Outcome decide_whole(const CornerRun& polygon);
  std::optional<signed char> outward_sense() const;
  void classify(Part part, Crossings candidates);
  bool is_no_boundary_if(PrimitiveIndex primitive, const BothSides& sides);
  Outcome decide_uncrossed(Part& part, Crossings& candidates);
  Relation relate(const CornerRun& polygon, LocalPrimitive& local, Crossing& crossing);
  Relation relation_to_planes(const CornerRun& polygon, LocalPrimitive& local, BothSides& inside);
  Relation relation_of(const CornerRun& section) const;
  void divide(const Part& part, Crossings crossings);
  void classify_half(const Part& half, Crossings crossings, PlaneRef plane, PlaneSplit other_side);
  void emit_on_either_side(const Part& part, const Crossing& crossing);
  PlaneRef choose_plane(Crossings crossings);
  void descend(Part part, LocalPlace front, LocalPlace behind, Crossings crossings);
  std::array<Part, 2> halves(const Part& part, PlaneRef plane);

  const LocalPrimitive& local(const Crossing& crossing) const {
    return locals_[order_[crossing.place]];
  }
  bool is_coplanar(const Crossing& crossing) const { return crossing.place < coplanar_count_; }
  // A lower primitive that covers a part in the same plane emits it.
  bool is_left_to(PrimitiveIndex primitive, const BothSides& sides) const {
    return sides.front != sides.behind && primitive < facet_->primitive;
  }
  Sign side(const Vertex& vertex, PlaneRef plane);
  template <class SideOf>
  PlaneSplit split_with(const CornerRun& polygon, const SideOf& side_of);
  PlaneSplit split(const CornerRun& polygon, PlaneRef plane);
  PlaneSplit split(const CornerRun& polygon, const NearPlane& near);
  Sign side(const Vertex& v, const NearPlane& near, std::size_t& decided);
  PlaneSplit split_without_signs(const CornerRun& polygon, const NearPlane& near);
  static PlaneSplit split_of(bool negative, bool positive);
  void undo_decisions(std::size_t count);
  void decide(PrimitiveIndex primitive, const BothSides& sides);
  void emit(const CornerRun& polygon, std::uint64_t share, signed char outward);
  void emit_remainder(const Part& part, const CornerRun& section, signed char outward);

  const Scene& scene_;
  Progress* progress_;
  // On either side of the facet at hand, as far as the primitives are decided.
  csg::MaintainedTraverse<PrimitiveIndex, csg::BooleanOperator, BothSides, CombineSides,
                          AbsorbsSides>
      truth_;
  std::vector<PrimitiveIndex> decided_;  // in the order in which they were
  std::vector<LocalNode> nodes_;
  std::vector<LocalPrimitive> locals_;
  std::vector<std::uint32_t> order_;  // indices into locals_, those coplanar with the facet first
  std::vector<std::uint32_t> not_coplanar_;  // the rest of it
  std::size_t coplanar_count_ = 0;
  SectionStore store_;
  std::vector<Crossing> crossings_;
  std::vector<NearPlane> planes_;       // of the cell's facets
  double error_limit_ = 0;              // of vertices for which their bounds hold
  std::vector<std::uint32_t> cutting_;  // of them, those that may cut the part at hand
  std::vector<Sign> signs_;
  std::vector<LoopCorner> loop_;
  const CellFacet* facet_ = nullptr;
  const Cell* cell_ = nullptr;
  Slicer slicer_;
  std::vector<Corner> cut_slice_;
  bool in_general_position_ = true;
  PieceCollector* result_ = nullptr;
  TierStatistics* statistics_ = nullptr;
};

}  // namespace exactcsg
