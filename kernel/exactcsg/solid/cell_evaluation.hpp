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

#include "exactcsg/csg/boolean_operator.hpp"
#include "exactcsg/csg/maintained_traverse.hpp"
#include "exactcsg/solid/local_form.hpp"
#include "exactcsg/solid/piece_buffer.hpp"
#include "exactcsg/solid/scene.hpp"
#include "exactcsg/support/progress.hpp"

namespace exactcsg {

// A facet polygon of a cell and the primitive it belongs to; those of one primitive are adjacent.
struct CellFacet {
  PrimitiveIndex primitive = 0;
  FacetIndex facet = 0;
  std::uint64_t share = facet_share::whole;
  FacetPolygon polygon;
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
  // in the tree.
  void evaluate(std::span<const CellFacet> facets, const PrunedTree& tree, PieceCollector& result,
                TierStatistics& statistics);

 private:
  // Corners of the pool, and what share of the facet they bound.
  struct Range {
    std::size_t begin;
    std::size_t end;
    std::uint64_t share;
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
  void join_pieces(const CellFacet& facet, const PieceCollector::Mark& before);
  void descend(Range piece, LocalPlace front, LocalPlace behind, std::size_t next);

  const Scene& scene_;
  Progress* progress_;
  // On either side of the facet at hand, as far as the primitives are decided.
  csg::MaintainedTraverse<PrimitiveIndex, csg::BooleanOperator, BothSides, CombineSides,
                          AbsorbsSides>
      truth_;
  std::vector<LocalNode> nodes_;
  std::vector<LocalPrimitive> locals_;
  std::vector<std::uint32_t> order_;  // indices into locals_, those coplanar with the facet first
  std::size_t coplanar_count_ = 0;
  std::vector<Corner> pool_;
  std::vector<Sign> signs_;
  const CellFacet* facet_ = nullptr;
  PieceCollector* result_ = nullptr;
  TierStatistics* statistics_ = nullptr;
};

}  // namespace exactcsg
