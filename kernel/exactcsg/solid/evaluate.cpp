// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/evaluate.hpp"

#include <algorithm>
#include <iterator>

#include "exactcsg/csg/membership.hpp"
#include "exactcsg/skeleton/divacon.hpp"
#include "exactcsg/solid/canonical_boundary.hpp"
#include "exactcsg/solid/classify.hpp"
#include "exactcsg/solid/decomposition.hpp"
#include "exactcsg/solid/per_thread.hpp"
#include "exactcsg/solid/whole_facets.hpp"

namespace exactcsg {

namespace {

using csg::Membership;

struct CellResult {
  std::vector<PieceBuffer> buffers;
  TierStatistics tiers;
  std::uint64_t cells = 0;
  std::uint64_t evaluated_cells = 0;
};

// A task that may have been looked at already: where to divide it, if anywhere.
struct EvaluationTask {
  CellTask cell;
  std::optional<Division> division;
};

class Evaluation {
 public:
  Evaluation(const Scene& scene, const EvaluateOptions& options)
      : scene_(scene),
        decomposition_(scene, options.facets_per_cell, options.progress),
        progress_(options.progress),
        evaluators_(
            [&scene, progress = options.progress] { return CellEvaluator(scene, progress); }) {}

  EvaluationTask root() const { return prepared(decomposition_.root()); }

  static bool is_leaf(const EvaluationTask& task) { return !task.division; }

  std::vector<EvaluationTask> divide(EvaluationTask& task) const {
    std::vector<EvaluationTask> children;
    children.reserve(2);
    for (CellTask& child : decomposition_.divide(task.cell, *task.division)) {
      children.push_back(prepared(std::move(child)));
    }
    return children;
  }

  CellResult solve(EvaluationTask& task) const {
    CellResult result;
    result.tiers = task.cell.statistics;
    result.cells = 1;
    if (progress_ != nullptr) progress_->advance(task.cell.facets.size());
    if (task.cell.facets.empty()) return result;
    PieceBuffer buffer;
    if (decomposition_.is_one_primitive(task.cell)) {
      emit_primitive(task.cell, buffer);
    } else {
      result.evaluated_cells = 1;
      thread_local std::vector<CellFacet> facets;
      decomposition_.collect_facets(task.cell, facets);
      evaluators_.local().evaluate(facets, task.cell.tree, buffer, result.tiers);
    }
    if (!buffer.pieces.empty()) result.buffers.push_back(std::move(buffer));
    return result;
  }

  static CellResult combine(std::span<CellResult> results) {
    CellResult sum;
    for (CellResult& result : results) {
      if (sum.buffers.empty()) {
        sum.buffers = std::move(result.buffers);
      } else {
        sum.buffers.insert(sum.buffers.end(), std::make_move_iterator(result.buffers.begin()),
                           std::make_move_iterator(result.buffers.end()));
      }
      sum.tiers += result.tiers;
      sum.cells += result.cells;
      sum.evaluated_cells += result.evaluated_cells;
    }
    return sum;
  }

 private:
  // A cell with one primitive only needs no division: most of a scene ends there.
  EvaluationTask prepared(CellTask cell) const {
    EvaluationTask task{std::move(cell), std::nullopt};
    if (!decomposition_.is_leaf(task.cell) && !decomposition_.is_one_primitive(task.cell)) {
      task.division = decomposition_.choose_division(task.cell);
    }
    return task;
  }

  // The only primitive of the cell: its facets are boundary as they are, or not at all.
  void emit_primitive(const CellTask& cell, PieceBuffer& buffer) const {
    const auto truth = [&](Membership status) {
      return csg::membership_of(cell.tree, [&](PrimitiveIndex) { return status; });
    };
    const Membership inside = truth(Membership::In);
    if (inside == truth(Membership::Out)) return;
    for (const ClippedFacet& facet : cell.facets) {
      const OrientedPlaneRef plane = scene_.facets[facet.facet].plane;
      const int sense = inside == Membership::In ? plane.sense : -plane.sense;
      buffer.add({plane.plane, static_cast<signed char>(sense)}, plane.sense, facet.facet,
                 facet.share, decomposition_.corners_of(cell, facet));
      buffer.pieces.back().isolated = is_isolated(cell, facet);
    }
  }

  // In a cell of one primitive.
  bool is_isolated(const CellTask& cell, const ClippedFacet& facet) const {
    if (facet.clipped || !scene_.primitives[scene_.facets[facet.facet].primitive].convex) {
      return false;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!(facet.lower[axis] > cell.cell.lower[axis] &&
            facet.upper[axis] < cell.cell.upper[axis])) {
        return false;
      }
    }
    return true;
  }

  const Scene& scene_;
  Decomposition decomposition_;
  Progress* progress_;
  mutable PerThread<CellEvaluator> evaluators_;
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

// A bounded solid has no boundary at the root cell's walls, and its complement has the space there.
void require_bounded(const Solid& solid, const Scene& scene,
                     const std::vector<PieceBuffer>& buffers) {
  const auto is_root_wall = [&](PlaneRef plane) {
    if (!plane.is_wall()) return false;
    const auto axis = static_cast<std::size_t>(plane.wall_axis());
    return plane.wall_position() == scene.root.lower[axis] ||
           plane.wall_position() == scene.root.upper[axis];
  };
  const auto reaches_wall = [&](const Corner& corner) {
    return !corner.vertex.is_point && std::any_of(std::begin(corner.vertex.planes),
                                                  std::end(corner.vertex.planes), is_root_wall);
  };
  bool bounded = true;
  for (const PieceBuffer& buffer : buffers) {
    bounded = bounded && std::none_of(buffer.corners.begin(), buffer.corners.end(), reaches_wall);
  }
  const Point3 corner{rational_of(scene.root.lower[0]), rational_of(scene.root.lower[1]),
                      rational_of(scene.root.lower[2])};
  if (!bounded || classify(solid, corner) != PointClass::Out) {
    throw Error(ErrorId::UnboundedSolid, {"a solid without bounds", "a bounded solid"});
  }
}

}  // namespace

Boundary evaluate(const Solid& solid, const EvaluateOptions& options) {
  if (options.progress != nullptr) options.progress->begin("prepare", 0);
  const Scene scene = make_scene(solid);
  if (options.progress != nullptr) options.progress->begin("decompose", scene.facets.size());
  CellResult result = run(scene, options);
  require_bounded(solid, scene, result.buffers);
  restore_whole_facets(scene, result.buffers);
  if (options.progress != nullptr) options.progress->begin("merge", 0);
  Boundary boundary = merge_pieces(scene, result.buffers, options.threads, options.progress);
  boundary.statistics.tiers += result.tiers;
  boundary.statistics.primitives = scene.primitives.size();
  boundary.statistics.facets = scene.facets.size();
  boundary.statistics.cells = result.cells;
  boundary.statistics.evaluated_cells = result.evaluated_cells;
  return boundary;
}

}  // namespace exactcsg
