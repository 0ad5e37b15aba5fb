// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/evaluate.hpp"

#include <iterator>
#include <list>

#include "exactcsg/skeleton/divacon.hpp"
#include "exactcsg/solid/canonical_boundary.hpp"
#include "exactcsg/solid/cell_solver.hpp"
#include "exactcsg/solid/whole_facets.hpp"

namespace exactcsg {

namespace {

struct CellResult {
  std::list<PieceBuffer> buffers;  // joined at every division: without moving any of them
  TierStatistics tiers;
  std::uint64_t cells = 0;
  std::uint64_t evaluated_cells = 0;
};

class Evaluation {
 public:
  Evaluation(const Scene& scene, const EvaluateOptions& options)
      : solver_(scene, options, CellUse::Once), progress_(options.progress) {}

  EvaluationTask root() const { return solver_.prepared(solver_.decomposition().root()); }

  static bool is_leaf(const EvaluationTask& task) { return !task.division; }

  std::vector<EvaluationTask> divide(EvaluationTask& task) const { return solver_.divide(task); }

  CellResult solve(EvaluationTask& task) const {
    CellResult result;
    result.tiers = task.cell.statistics;
    result.cells = 1;
    if (progress_ != nullptr) progress_->advance(task.cell.facet_count);
    CellSolver::Solution solution = solver_.solve(task.cell, result.tiers);
    if (solution.was_classified) result.evaluated_cells = 1;
    if (!solution.pieces.pieces.empty()) result.buffers.push_back(std::move(solution.pieces));
    return result;
  }

  static CellResult combine(std::span<CellResult> results) {
    CellResult sum;
    for (CellResult& result : results) {
      sum.buffers.splice(sum.buffers.end(), result.buffers);
      sum.tiers += result.tiers;
      sum.cells += result.cells;
      sum.evaluated_cells += result.evaluated_cells;
    }
    return sum;
  }

 private:
  CellSolver solver_;
  Progress* progress_;
};

CellResult run(const Scene& scene, const EvaluateOptions& options) {
  const Evaluation evaluation(scene, options);
  const auto with = [&](const auto& executor) {
    return skeleton::divacon(
        evaluation.root(), [](const EvaluationTask& task) { return Evaluation::is_leaf(task); },
        [&](EvaluationTask&& task) { return evaluation.divide(task); },
        [&](EvaluationTask&& task) { return evaluation.solve(task); },
        [](std::span<CellResult> results) { return Evaluation::combine(results); }, executor);
  };
  if (options.threads == 1) return with(skeleton::SequentialExecutor{});
  return with(skeleton::ParallelExecutor<>(options.threads));
}

}  // namespace

Boundary evaluate(const Solid& solid, const EvaluateOptions& options) {
  if (options.progress != nullptr) options.progress->begin("prepare", 0);
  Scene scene = make_scene(solid, options.threads);
  if (options.progress != nullptr) options.progress->begin("decompose", scene.facets.size());
  CellResult result = run(scene, options);
  std::vector<PieceBuffer> buffers(std::make_move_iterator(result.buffers.begin()),
                                   std::make_move_iterator(result.buffers.end()));
  result.buffers.clear();
  require_bounded(solid, scene, buffers, options.threads);
  restore_whole_facets(scene, buffers, options.threads);
  if (options.progress != nullptr) options.progress->begin("merge", 0);
  scene.bounds = {};
  const std::size_t primitives = scene.primitives.size();
  const std::size_t facets = scene.facets.size();
  Boundary boundary =
      merge_pieces(std::move(scene), std::move(buffers), options.threads, options.progress);
  boundary.statistics.tiers += result.tiers;
  boundary.statistics.primitives = primitives;
  boundary.statistics.facets = facets;
  boundary.statistics.cells = result.cells;
  boundary.statistics.evaluated_cells = result.evaluated_cells;
  return boundary;
}

}  // namespace exactcsg
