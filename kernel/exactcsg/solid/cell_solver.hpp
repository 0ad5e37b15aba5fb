// SPDX-License-Identifier: Apache-2.0
#pragma once

// What becomes of the cells of a decomposition: which are divided, where, and the pieces of
// boundary in those that are not. Shared by the evaluators. [Exact]

#include <optional>
#include <vector>

#include "exactcsg/solid/decomposition.hpp"
#include "exactcsg/solid/evaluate.hpp"
#include "exactcsg/solid/per_thread.hpp"

namespace exactcsg {

// A task that has been looked at already: where to divide it, if anywhere.
struct EvaluationTask {
  CellTask cell;
  std::optional<Division> division;
};

// When cells are divided no further. Once: as is cheapest for one evaluation. Changing: cells stay
// small, since a change renews whole ones.
enum class CellUse : unsigned char { Once, Changing };

// For any number of threads.
class CellSolver {
 public:
  // The scene outlives it.
  CellSolver(const Scene& scene, const EvaluateOptions& options, CellUse use);

  const Decomposition& decomposition() const { return decomposition_; }

  EvaluationTask prepared(CellTask cell) const;
  // REQUIRES the task has a division.
  std::vector<EvaluationTask> divide(EvaluationTask& task) const;
  // The pieces of boundary in the cell, and whether that took two-sided classification.
  struct Solution {
    PieceBuffer pieces;
    bool was_classified = false;
  };
  Solution solve(const CellTask& cell, TierStatistics& statistics) const;

 private:
  struct Worker {
    CellEvaluator evaluator;
    std::vector<CellFacet> facets;
    PieceCollector collector;
  };

  void emit_primitive(const CellTask& cell, PieceCollector& result) const;
  bool touches_walls(const CellTask& cell) const;
  bool is_cheap(const CellTask& task) const;

  const Scene& scene_;
  std::size_t facets_per_cell_;
  CellUse use_;
  Decomposition decomposition_;
  mutable PerThread<Worker> workers_;
};

// THROWS Error(UnboundedSolid) unless these pieces, in the cells of this scene, are the boundary of
// a bounded solid.
void require_bounded(const Solid& solid, const Scene& scene,
                     const std::vector<PieceBuffer>& buffers, unsigned threads);

}  // namespace exactcsg
