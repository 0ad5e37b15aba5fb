// SPDX-License-Identifier: Apache-2.0
#pragma once

// The recursive decomposition of space that the evaluator and the point classifier share: what a
// task is, when it is small enough, how it is divided. [Exact]
//
// LAW decomposition.1  in a task, the facets are exactly those parts of the scene's facets that
// meet the open cell and belong to a primitive of the tree; a primitive of the tree has at least
// one. LAW decomposition.2  for every point of the open cell, the tree of the task classifies it as
// the scene's tree does.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "exactcsg/solid/cell_evaluation.hpp"
#include "exactcsg/solid/scene.hpp"
#include "exactcsg/support/progress.hpp"

namespace exactcsg {

// A part of a facet of the scene, with bounds that its true corners do not exceed.
struct ClippedFacet {
  FacetIndex facet = 0;
  std::uint32_t first_corner = 0;  // in the task's store
  std::uint32_t corner_count = 0;
  std::uint64_t share = facet_share::whole;
  std::array<Range, 3> bounds;
};

// The part in the cell of a facet of a bounded convex primitive that reaches beyond the cell across
// one or two axes. It is not cut before that matters: mostly no other primitive does, and the parts
// of a facet are put together again.
// LAW decomposition.3  the facet's bounds are inside the cell, off its walls, along the axes
// without a wall that cuts it; no corner of the facet lies in a wall that cuts it, and none of its
// sides meets two such walls in one point.
struct SlicedFacet {
  FacetIndex facet = 0;
  CutWalls walls;
  std::uint64_t share = facet_share::whole;
};

// The facets of one primitive that reach a cell.
struct PrimitiveFacets {
  PrimitiveIndex primitive = 0;
  bool all = false;  // all of them, whole, and not listed
  std::uint32_t first_whole = 0;
  std::uint32_t whole_count = 0;  // also where they are not listed
  std::uint32_t first_sliced = 0;
  std::uint32_t sliced_count = 0;
  std::uint32_t first_clipped = 0;
  std::uint32_t clipped_count = 0;

  std::size_t count() const { return std::size_t{whole_count} + sliced_count + clipped_count; }
};

struct CellTask {
  Cell cell;
  std::vector<PrimitiveFacets> primitives;  // each with a facet at least
  std::vector<FacetIndex> whole;            // facets of one primitive are adjacent
  std::vector<SlicedFacet> sliced;          // likewise
  std::vector<ClippedFacet> clipped;        // likewise
  std::vector<Corner> corners;              // of the clipped ones
  std::size_t facet_count = 0;
  PrunedTree tree;
  std::uint32_t stalled = 0;  // divisions in a row that hardly separated anything
  std::uint32_t depth = 0;
  TierStatistics statistics;  // of the divisions that led to this task

  // REQUIRES facets is one of primitives. i < facets.whole_count
  FacetIndex whole_facet(const Scene& scene, const PrimitiveFacets& facets, std::uint32_t i) const {
    return facets.all ? scene.primitives[facets.primitive].first_facet + i
                      : whole[facets.first_whole + i];
  }
  std::span<const SlicedFacet> sliced_of(const PrimitiveFacets& facets) const {
    return std::span(sliced).subspan(facets.first_sliced, facets.sliced_count);
  }
  std::span<const ClippedFacet> clipped_of(const PrimitiveFacets& facets) const {
    return std::span(clipped).subspan(facets.first_clipped, facets.clipped_count);
  }
  std::span<const Corner> corners_of(const ClippedFacet& facet) const {
    return std::span(corners).subspan(facet.first_corner, facet.corner_count);
  }
};

struct Division {
  Axis axis = Axis::X;
  double position = 0;
};

class Decomposition {
 public:
  Decomposition(const Scene& scene, std::size_t facets_per_cell, Progress* progress);
  ~Decomposition();

  CellTask root() const;
  // The same of any cell and tree: its primitives' facets, whole. Of LAW decomposition.1 it is the
  // caller's to see to it that they meet the cell. COST: O(nodes + facets of the tree's primitives)
  CellTask task_of(const Cell& cell, const PrunedTree& tree) const;
  // The tree is constant, or the facets are few, or dividing is of no use.
  // THROWS what Progress throws.
  bool is_leaf(const CellTask& task) const;
  // All facets are of one primitive.
  static bool is_one_primitive(const CellTask& task) { return task.primitives.size() == 1; }
  // Where to divide; nullopt: nowhere without a facet in the wall.
  std::optional<Division> choose_division(const CellTask& task) const;
  // The cell below the wall and the cell above it. REQUIRES no facet lies in the wall.
  std::vector<CellTask> divide(CellTask& task, const Division& division) const;

  // The facets of a task as the cell evaluator wants them.
  void collect_facets(const CellTask& task, std::vector<CellFacet>& facets) const;
  bool has_facet_in_wall(const CellTask& task, const Division& division) const;

 private:
  class Divider;
  struct Scratch;
  struct ScratchPerThread;

  bool inseparable(const CellTask& task) const;

  const Scene& scene_;
  std::size_t facets_per_cell_;
  Progress* progress_;
  // Memory of its own for every thread: a division allocates only what its children keep.
  std::unique_ptr<ScratchPerThread> scratch_;
};

}  // namespace exactcsg
