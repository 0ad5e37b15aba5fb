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

#include "exactcsg/csg/prune.hpp"
#include "exactcsg/solid/cell_evaluation.hpp"
#include "exactcsg/solid/scene.hpp"
#include "exactcsg/support/progress.hpp"

namespace exactcsg {

// A facet of the scene, whole or clipped to a cell, with bounds that its true corners do not
// exceed.
struct ClippedFacet {
  FacetIndex facet = 0;
  std::uint32_t first_corner = 0;
  std::uint32_t corner_count = 0;
  bool clipped = false;  // corners in the task's own store, otherwise in the scene's
  std::uint64_t share = facet_share::whole;
  std::array<double, 3> lower{};
  std::array<double, 3> upper{};
};

struct CellTask {
  Cell cell;
  std::vector<ClippedFacet> facets;  // facets of one primitive are adjacent
  std::vector<Corner> corners;
  PrunedTree tree;
  std::uint32_t stalled = 0;  // divisions in a row that hardly separated anything
  std::uint32_t depth = 0;
  TierStatistics statistics;  // of the divisions that led to this task
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
  // The tree is constant, or the facets are few, or dividing is of no use.
  // THROWS what Progress throws.
  bool is_leaf(const CellTask& task) const;
  // All facets are of one primitive.
  bool is_one_primitive(const CellTask& task) const;
  // Where to divide; nullopt: nowhere without a facet in the wall.
  std::optional<Division> choose_division(const CellTask& task) const;
  // The cell below the wall and the cell above it. REQUIRES no facet lies in the wall.
  std::vector<CellTask> divide(CellTask& task, const Division& division) const;

  // The facets of a task as the cell evaluator wants them.
  void collect_facets(const CellTask& task, std::vector<CellFacet>& facets) const;
  std::span<const Corner> corners_of(const CellTask& task, const ClippedFacet& facet) const;

 private:
  class Divider;
  struct Scratch;
  struct ScratchPerThread;

  bool has_facet_in_wall(const CellTask& task, const Division& division) const;
  bool inseparable(const CellTask& task) const;

  const Scene& scene_;
  std::size_t facets_per_cell_;
  Progress* progress_;
  // Memory of its own for every thread: a division allocates only what its children keep.
  std::unique_ptr<ScratchPerThread> scratch_;
};

}  // namespace exactcsg
