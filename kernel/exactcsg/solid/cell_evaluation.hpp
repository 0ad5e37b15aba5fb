// SPDX-License-Identifier: Apache-2.0
#pragma once

// Two-sided classification of the facets of one cell. [Exact]
//
// Of every facet polygon we carry what every primitive of the cell is in front and behind, and cut
// it by the other primitives' local forms until the pruned tree is constant on both sides. Equal:
// no boundary. Different: boundary, turned by the side that is In. A piece that facets of several
// primitives cover is emitted by the lowest of them only.

#include <cstdint>
#include <span>
#include <vector>

#include "exactcsg/csg/traverse.hpp"
#include "exactcsg/solid/local_form.hpp"
#include "exactcsg/solid/scene.hpp"
#include "exactcsg/support/progress.hpp"

namespace exactcsg {

struct BoundaryPiece {
  OrientedPlaneRef plane;        // outward normal of the solid
  signed char corner_sense = 1;  // corners are counter-clockwise about the stored normal if +1
  std::uint32_t first_corner = 0;
  std::uint32_t corner_count = 0;
};

struct PieceBuffer {
  std::vector<BoundaryPiece> pieces;
  std::vector<Corner> corners;

  void add(OrientedPlaneRef outward, signed char corner_sense, std::span<const Corner> polygon);
};

// A facet polygon of a cell and the primitive it belongs to; those of one primitive are adjacent.
struct CellFacet {
  PrimitiveIndex primitive = 0;
  FacetPolygon polygon;
};

class CellEvaluator {
 public:
  // Asks the progress, if there is one, for cancellation once a facet.
  CellEvaluator(const Scene& scene, Progress* progress);

  // REQUIRES every primitive of the tree has facets in the cell, and every facet's primitive occurs
  // in the tree.
  void evaluate(std::span<const CellFacet> facets, const PrunedTree& tree, PieceBuffer& result,
                TierStatistics& statistics);

 private:
  struct Range {
    std::size_t begin;
    std::size_t end;
  };
  struct LocalPrimitive {
    PrimitiveIndex primitive;
    LocalPlace root;
    std::size_t first_facet;
    std::size_t facet_count;
  };

  void build_local_forms(std::span<const CellFacet> facets);
  void order_primitives_for(const CellFacet& facet, std::span<const CellFacet> facets);
  void classify(Range piece, std::size_t next);
  void descend(Range piece, LocalPlace front, LocalPlace behind, std::size_t next);
  csg::Membership truth(const std::vector<csg::Membership>& status);

  const Scene& scene_;
  Progress* progress_;
  // Status of every primitive of the scene on either side of the facet at hand; Unknown between
  // uses. Front: along the stored normal of the facet's plane.
  std::vector<csg::Membership> front_;
  std::vector<csg::Membership> behind_;
  std::vector<LocalNode> nodes_;
  std::vector<LocalPrimitive> locals_;
  std::vector<std::uint32_t> order_;  // indices into locals_, those coplanar with the facet first
  std::size_t coplanar_count_ = 0;
  std::vector<Corner> pool_;
  std::vector<Sign> signs_;
  csg::TraverseScratch<PrunedTree, csg::Membership> scratch_;
  const PrunedTree* tree_ = nullptr;
  const CellFacet* facet_ = nullptr;
  PieceBuffer* result_ = nullptr;
  TierStatistics* statistics_ = nullptr;
};

}  // namespace exactcsg
