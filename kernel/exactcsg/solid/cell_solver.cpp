// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/cell_solver.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <variant>

#include "exactcsg/csg/membership.hpp"
#include "exactcsg/solid/classify.hpp"
#include "exactcsg/support/in_parallel.hpp"

namespace exactcsg {

using csg::Membership;

CellSolver::CellSolver(const Scene& scene, const EvaluateOptions& options, CellUse use)
    : scene_(scene),
      facets_per_cell_(options.facets_per_cell),
      use_(use),
      decomposition_(scene, options.facets_per_cell, options.progress),
      workers_([&scene, progress = options.progress] {
        return Worker{CellEvaluator(scene, progress), {}, {}};
      }) {}

// A cell with one primitive only needs no division: most of a scene ends there.
EvaluationTask CellSolver::prepared(CellTask cell) const {
  EvaluationTask task{std::move(cell), std::nullopt};
  if (!decomposition_.is_leaf(task.cell) && !decomposition_.is_one_primitive(task.cell) &&
      !is_cheap(task.cell)) {
    task.division = decomposition_.choose_division(task.cell);
  }
  return task;
}

// Few convex primitives leave most of each other's facets alone, by the first plane that is asked,
// where every pair more may cross. A mesh's local form is dear.
bool CellSolver::is_cheap(const CellTask& task) const {
  const std::size_t primitives = task.primitives.size();
  if (use_ == CellUse::Changing || primitives > 3) return false;
  const std::size_t limit = facets_per_cell_ * (primitives == 2 ? 10 : 7) / 6;
  return task.facet_count <= limit &&
         std::ranges::all_of(task.primitives, [&](const PrimitiveFacets& facets) {
           return scene_.primitives[facets.primitive].convex;
         });
}

std::vector<EvaluationTask> CellSolver::divide(EvaluationTask& task) const {
  std::vector<EvaluationTask> children;
  children.reserve(2);
  for (CellTask& child : decomposition_.divide(task.cell, *task.division)) {
    children.push_back(prepared(std::move(child)));
  }
  return children;
}

CellSolver::Solution CellSolver::solve(const CellTask& cell, TierStatistics& statistics) const {
  if (cell.facet_count == 0) return {};
  Worker& worker = workers_.local();
  worker.collector.discard();
  const bool classified = !decomposition_.is_one_primitive(cell);
  bool in_general_position = true;
  if (classified) {
    decomposition_.collect_facets(cell, worker.facets);
    in_general_position = worker.evaluator.evaluate(worker.facets, cell.cell, cell.tree,
                                                    worker.collector, statistics);
  } else {
    emit_primitive(cell, worker.collector);
  }
  return {worker.collector.take(in_general_position && !touches_walls(cell)), classified};
}

// The only primitive of the cell: its facets are boundary as they are, or not at all.
void CellSolver::emit_primitive(const CellTask& cell, PieceCollector& result) const {
  const auto truth = [&](Membership status) {
    return csg::membership_of(cell.tree, [&](PrimitiveIndex) { return status; });
  };
  const Membership inside = truth(Membership::In);
  if (inside == truth(Membership::Out)) return;
  const PrimitiveFacets& facets = cell.primitives.front();
  const auto outward = [&](const OrientedPlaneRef& plane) {
    const int sense = inside == Membership::In ? plane.sense : -plane.sense;
    return OrientedPlaneRef{plane.plane, static_cast<signed char>(sense)};
  };
  for (std::uint32_t i = 0; i < facets.whole_count; ++i) {
    const FacetIndex facet = cell.whole_facet(scene_, facets, i);
    const OrientedPlaneRef plane = scene_.facets[facet].plane;
    result.add(outward(plane), plane.sense, facet, facet_share::whole, {});
  }
  for (const SlicedFacet& facet : cell.sliced_of(facets)) {
    const OrientedPlaneRef plane = scene_.facets[facet.facet].plane;
    result.add_slice(outward(plane), plane.sense, facet.facet, facet.share,
                     slice_of(cell.cell, facet.walls));
  }
  for (const ClippedFacet& facet : cell.clipped_of(facets)) {
    const OrientedPlaneRef plane = scene_.facets[facet.facet].plane;
    result.add(outward(plane), plane.sense, facet.facet, facet.share, cell.corners_of(facet));
  }
}

// Whether a facet may have a corner in a wall that did not cut it, or its primitive meets itself.
bool CellSolver::touches_walls(const CellTask& task) const {
  const Cell& cell = task.cell;
  const auto is_inside = [&](FacetIndex facet) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Range& bounds = scene_.bounds.facets[axis][facet];
      if (!(bounds.lower > cell.lower[axis] && bounds.upper < cell.upper[axis])) return false;
    }
    return true;
  };
  const auto is_off = [](const Vertex& vertex, Axis axis, double wall) {
    return std::abs(vertex.coordinate(axis) - wall) > vertex.error * (1 + 0x1p-50) ||
           is_made_by(vertex, PlaneRef::of_wall(axis, wall));
  };
  const auto is_off_walls = [&](const ClippedFacet& facet) {
    const std::span<const Corner> corners = task.corners_of(facet);
    return std::ranges::all_of(std::array{Axis::X, Axis::Y, Axis::Z}, [&](Axis axis) {
      const auto i = static_cast<std::size_t>(axis);
      const auto are_off = [&](double wall) {
        return std::ranges::all_of(
            corners, [&](const Corner& corner) { return is_off(corner.vertex, axis, wall); });
      };
      return (facet.bounds[i].lower > cell.lower[i] || are_off(cell.lower[i])) &&
             (facet.bounds[i].upper < cell.upper[i] || are_off(cell.upper[i]));
    });
  };
  // LAW decomposition.3 says it of walls that cut it.
  const auto is_slice_off_walls = [&](const SlicedFacet& facet) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!facet.walls.across(axis)) continue;
      const Range& bounds = scene_.bounds.facets[axis][facet.facet];
      if (!(facet.walls.lower(axis) || bounds.lower > cell.lower[axis])) return false;
      if (!(facet.walls.upper(axis) || bounds.upper < cell.upper[axis])) return false;
    }
    return true;
  };
  for (const PrimitiveFacets& facets : task.primitives) {
    if (scene_.primitives[facets.primitive].meets_itself) return true;
    for (std::uint32_t i = 0; i < facets.whole_count; ++i) {
      if (!is_inside(task.whole_facet(scene_, facets, i))) return true;
    }
    for (const SlicedFacet& facet : task.sliced_of(facets)) {
      if (!is_slice_off_walls(facet)) return true;
    }
    for (const ClippedFacet& facet : task.clipped_of(facets)) {
      if (!is_off_walls(facet)) return true;
    }
  }
  return false;
}

namespace {

// The root cell's lower corner is outside every bounded primitive, without a look at its facets.
bool is_root_corner_outside(const Solid& solid, const Scene& scene) {
  bool all_bounded = true;
  const Membership corner = csg::membership_of(solid, [&](const Primitive& primitive) {
    if (std::holds_alternative<HalfSpace>(primitive.shape)) all_bounded = false;
    return Membership::Out;
  });
  if (all_bounded) return corner == Membership::Out;
  return classify(solid, {rational_of(scene.root.lower[0]), rational_of(scene.root.lower[1]),
                          rational_of(scene.root.lower[2])}) == PointClass::Out;
}

}  // namespace

// A bounded solid has no boundary at the root cell's walls, and its complement has the space there.
void require_bounded(const Solid& solid, const Scene& scene,
                     const std::vector<PieceBuffer>& buffers, unsigned threads) {
  const auto is_root_wall = [&](PlaneRef plane) {
    if (!plane.is_wall()) return false;
    const auto axis = static_cast<std::size_t>(plane.wall_axis());
    return plane.wall_position() == scene.root.lower[axis] ||
           plane.wall_position() == scene.root.upper[axis];
  };
  const auto reaches_wall = [&](const Vertex& meeting_point) {
    return std::any_of(std::begin(meeting_point.planes), std::end(meeting_point.planes),
                       is_root_wall);
  };
  const auto is_whole_half_space = [&](const BoundaryPiece& piece) {
    return piece.share == facet_share::whole && scene.facets[piece.facet].is_half_space;
  };
  unsigned char unbounded = 0;
  in_parallel(threads, buffers.size(), [&](std::size_t b) {
    const PieceBuffer& buffer = buffers[b];
    if (std::ranges::any_of(buffer.meeting_points, reaches_wall) ||
        std::ranges::any_of(buffer.pieces, is_whole_half_space)) {
      set_mark(unbounded);
    }
  });
  if (unbounded != 0 || !is_root_corner_outside(solid, scene)) {
    throw Error(ErrorId::UnboundedSolid, {"a solid without bounds", "a bounded solid"});
  }
}

}  // namespace exactcsg
