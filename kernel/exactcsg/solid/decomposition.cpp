// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/decomposition.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "exactcsg/solid/per_thread.hpp"
#include "exactcsg/solid/polygon.hpp"

namespace exactcsg {

namespace {

using csg::Membership;

constexpr std::uint32_t depth_limit = 4000;
constexpr std::size_t sample_size = 384;

// How many divisions in a row may hardly separate anything before the cell is evaluated as it is.
// Evaluation costs at least the square of the facets (measured: bevel gears of 240 meshes went from
// more than a minute to half a second with 8 chances for 2), so large cells are given more of them.
constexpr std::uint32_t stall_limit(std::size_t facets) {
  return facets <= 48 ? 2 : facets <= 96 ? 4 : facets <= 512 ? 8 : 12;
}

// Facets in at most three planes share a point: no division will ever separate them (MEG's rule).
constexpr std::size_t inseparable_planes = 3;

void set_bounds(ClippedFacet& facet, std::span<const Corner> corners) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  facet.lower = {infinity, infinity, infinity};
  facet.upper = {-infinity, -infinity, -infinity};
  for (const Corner& corner : corners) {
    const std::array<double, 3> position{corner.vertex.x, corner.vertex.y, corner.vertex.z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      // Widened by two units in the last place, for the rounding of this very sum.
      const double slack = corner.vertex.error + 0x1p-51 * std::abs(position[axis]);
      facet.lower[axis] = std::min(facet.lower[axis], position[axis] - slack);
      facet.upper[axis] = std::max(facet.upper[axis], position[axis] + slack);
    }
  }
}

// Where a facet is with respect to a wall.
enum class WallSide : unsigned char { Below, Above, Both, Within };

WallSide wall_side(const Geometry& geometry, const ClippedFacet& facet,
                   std::span<const Corner> corners, const Division& division,
                   std::vector<Sign>& signs, TierStatistics& statistics) {
  const auto axis = static_cast<std::size_t>(division.axis);
  if (facet.upper[axis] < division.position) return WallSide::Below;
  if (facet.lower[axis] > division.position) return WallSide::Above;
  signs.resize(corners.size());
  bool below = false;
  bool above = false;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    signs[i] = geometry.compare_coordinate(corners[i].vertex, division.axis, division.position,
                                           statistics);
    below |= signs[i] == Sign::Negative;
    above |= signs[i] == Sign::Positive;
  }
  if (below && above) return WallSide::Both;
  if (below) return WallSide::Below;
  return above ? WallSide::Above : WallSide::Within;
}

}  // namespace

// Indexed by primitive; reset after use.
struct Decomposition::Scratch {
  explicit Scratch(std::size_t primitives)
      : status(primitives, Membership::Unknown), in_tree(primitives, 0) {}
  std::vector<Membership> status;
  std::vector<unsigned char> in_tree;
  csg::PruneScratch<PrunedTree> prune;
};

struct Decomposition::ScratchPerThread : PerThread<Scratch> {
  using Base = PerThread<Scratch>;
  using Base::Base;
};

Decomposition::~Decomposition() = default;

// What both children of one division share while they are made.
class Decomposition::Divider {
 public:
  Divider(const Decomposition& decomposition, CellTask& task, const Division& division)
      : decomposition_(decomposition),
        scene_(decomposition.scene_),
        task_(task),
        division_(division),
        scratch_(decomposition.scratch_->local()) {}

  std::vector<CellTask> divide() {
    std::vector<CellTask> children(2);
    sides_.reserve(task_.facets.size());
    for (const ClippedFacet& facet : task_.facets) {
      sides_.push_back(wall_side(scene_.geometry, facet, decomposition_.corners_of(task_, facet),
                                 division_, signs_, task_.statistics));
    }
    make_child(children[0], WallSide::Below);
    make_child(children[1], WallSide::Above);
    const auto square = [](std::size_t n) {
      return static_cast<double>(n) * static_cast<double>(n);
    };
    const bool separates = square(children[0].facets.size()) + square(children[1].facets.size()) <
                           0.9 * square(task_.facets.size());
    for (CellTask& child : children) child.stalled = separates ? 0 : task_.stalled + 1;
    children[0].statistics = task_.statistics;
    children[0].statistics += below_statistics_;
    return children;
  }

 private:
  void make_child(CellTask& child, WallSide which) {
    const auto axis = static_cast<std::size_t>(division_.axis);
    child.cell = task_.cell;
    (which == WallSide::Below ? child.cell.upper : child.cell.lower)[axis] = division_.position;
    child.depth = task_.depth + 1;
    settle_lost_primitives(child.cell, which);
    csg::prune_into(
        task_.tree, [&](PrimitiveIndex primitive) { return scratch_.status[primitive]; },
        child.tree, scratch_.prune);
    mark_tree(child.tree, 1);
    for (std::size_t i = 0; i < task_.facets.size(); ++i) {
      const ClippedFacet& facet = task_.facets[i];
      if (sides_[i] != which && sides_[i] != WallSide::Both) continue;
      if (scratch_.in_tree[scene_.facets[facet.facet].primitive] == 0) continue;
      add_facet(child, facet, sides_[i] == WallSide::Both, which);
    }
    mark_tree(child.tree, 0);
    for (const ClippedFacet& facet : task_.facets) {
      scratch_.status[scene_.facets[facet.facet].primitive] = Membership::Unknown;
    }
  }

  void mark_tree(const PrunedTree& tree, unsigned char mark) {
    auto node = tree.root();
    const auto end = node.next_sibling();
    for (; !(node == end); node = node.first_child()) {
      if (node.kind() == csg::NodeKind::Primitive) scratch_.in_tree[node.primitive()] = mark;
    }
  }

  // A primitive none of whose facets reaches the child is Full or Empty there: an inner point of
  // the child decides.
  void settle_lost_primitives(const Cell& cell, WallSide which) {
    inner_point_.reset();
    for (std::size_t begin = 0; begin < task_.facets.size();) {
      const PrimitiveIndex primitive = scene_.facets[task_.facets[begin].facet].primitive;
      std::size_t end = begin;
      bool reaches = false;
      for (; end < task_.facets.size() &&
             scene_.facets[task_.facets[end].facet].primitive == primitive;
           ++end) {
        reaches |= sides_[end] == which || sides_[end] == WallSide::Both;
      }
      if (!reaches) scratch_.status[primitive] = status_at_inner_point(cell, primitive, begin, end);
      begin = end;
    }
  }

  Membership status_at_inner_point(const Cell& cell, PrimitiveIndex primitive, std::size_t begin,
                                   std::size_t end) {
    if (!inner_point_) inner_point_ = inner_point(cell);
    if (!scene_.primitives[primitive].convex) {
      std::vector<FacetPolygon> polygons;
      for (std::size_t i = begin; i < end; ++i) {
        polygons.push_back({scene_.facets[task_.facets[i].facet].plane,
                            decomposition_.corners_of(task_, task_.facets[i])});
      }
      return mesh_membership(scene_.geometry, scene_.geometry.exact_point(*inner_point_), polygons);
    }
    for (std::size_t i = begin; i < end; ++i) {
      const OrientedPlaneRef plane = scene_.facets[task_.facets[i].facet].plane;
      const Sign side = scene_.geometry.side(*inner_point_, plane.plane, task_.statistics);
      if (side * sign_of(static_cast<int>(plane.sense)) != Sign::Negative) return Membership::Out;
    }
    return Membership::In;
  }

  Vertex inner_point(const Cell& cell) const {
    std::array<PlaneRef, 3> walls;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double middle = cell.lower[axis] + (cell.upper[axis] - cell.lower[axis]) / 2;
      walls[axis] = PlaneRef::of_wall(static_cast<Axis>(axis), round_wall_position(middle));
    }
    return scene_.geometry.meet(walls[0], walls[1], walls[2]);
  }

  void add_facet(CellTask& child, const ClippedFacet& facet, bool cut, WallSide which) {
    const std::span<const Corner> corners = decomposition_.corners_of(task_, facet);
    ClippedFacet added = facet;
    if (!cut && !facet.clipped) {
      child.facets.push_back(added);
      return;
    }
    added.clipped = true;
    added.first_corner = static_cast<std::uint32_t>(child.corners.size());
    if (cut) {
      added.share = facet.share / 2;
      const PlaneRef wall = PlaneRef::of_wall(division_.axis, division_.position);
      TierStatistics& statistics = which == WallSide::Below ? below_statistics_ : task_.statistics;
      // The signs are needed again; the filter makes them cheap.
      ClippedFacet unbounded = facet;
      unbounded.lower.fill(-std::numeric_limits<double>::infinity());
      unbounded.upper.fill(std::numeric_limits<double>::infinity());
      wall_side(scene_.geometry, unbounded, corners, division_, signs_, statistics);
      append_part(scene_.geometry, corners, scene_.facets[facet.facet].plane.plane, wall, signs_,
                  which == WallSide::Below ? Sign::Negative : Sign::Positive, child.corners);
    } else {
      child.corners.insert(child.corners.end(), corners.begin(), corners.end());
    }
    added.corner_count = static_cast<std::uint32_t>(child.corners.size()) - added.first_corner;
    if (cut) set_bounds(added, std::span(child.corners).subspan(added.first_corner));
    child.facets.push_back(added);
  }

  const Decomposition& decomposition_;
  const Scene& scene_;
  CellTask& task_;
  const Division& division_;
  Scratch& scratch_;
  std::vector<WallSide> sides_;
  std::vector<Sign> signs_;
  std::optional<Vertex> inner_point_;
  TierStatistics below_statistics_;
};

Decomposition::Decomposition(const Scene& scene, std::size_t facets_per_cell, Progress* progress)
    : scene_(scene),
      facets_per_cell_(facets_per_cell),
      progress_(progress),
      scratch_(std::make_unique<ScratchPerThread>(
          [count = scene.primitives.size()] { return Scratch(count); })) {}

bool Decomposition::inseparable(const CellTask& task) const {
  std::array<PlaneRef, inseparable_planes> planes;
  std::size_t count = 0;
  for (const ClippedFacet& facet : task.facets) {
    const PlaneRef plane = scene_.facets[facet.facet].plane.plane;
    const auto end = planes.begin() + static_cast<std::ptrdiff_t>(count);
    if (std::find(planes.begin(), end, plane) != end) continue;
    if (count == planes.size()) return false;
    planes[count++] = plane;
  }
  return true;
}

bool Decomposition::is_one_primitive(const CellTask& task) const {
  return !task.facets.empty() && scene_.facets[task.facets.front().facet].primitive ==
                                     scene_.facets[task.facets.back().facet].primitive;
}

std::span<const Corner> Decomposition::corners_of(const CellTask& task,
                                                  const ClippedFacet& facet) const {
  const std::vector<Corner>& store = facet.clipped ? task.corners : scene_.corners;
  return std::span(store).subspan(facet.first_corner, facet.corner_count);
}

CellTask Decomposition::root() const {
  CellTask task;
  task.cell = scene_.root;
  // Simplified, so that LAW decomposition.1 holds of the root as well.
  csg::PruneScratch<PrunedTree> scratch;
  csg::prune_into(
      scene_.tree, [](PrimitiveIndex) { return Membership::Unknown; }, task.tree, scratch);
  std::vector<unsigned char> in_tree(scene_.primitives.size(), 0);
  auto node = task.tree.root();
  const auto end = node.next_sibling();
  for (; !(node == end); node = node.first_child()) {
    if (node.kind() == csg::NodeKind::Primitive) in_tree[node.primitive()] = 1;
  }
  for (FacetIndex f = 0; f < scene_.facets.size(); ++f) {
    const SceneFacet& facet = scene_.facets[f];
    if (in_tree[facet.primitive] == 0) continue;
    ClippedFacet whole;
    whole.facet = f;
    whole.first_corner = facet.first_corner;
    whole.corner_count = facet.corner_count;
    set_bounds(whole, std::span(scene_.corners).subspan(facet.first_corner, facet.corner_count));
    task.facets.push_back(whole);
  }
  return task;
}

bool Decomposition::is_leaf(const CellTask& task) const {
  if (progress_ != nullptr) progress_->check();
  return task.facets.empty() || task.facets.size() <= facets_per_cell_ ||
         task.stalled >= stall_limit(task.facets.size()) || task.depth >= depth_limit ||
         inseparable(task);
}

namespace {

// Facets spread over all of them, at most sample_size. A fixed stride would pick the same facet of
// every primitive; multiples of a large odd number do not.
std::vector<std::uint32_t> sample_of(std::size_t count) {
  std::vector<std::uint32_t> sample;
  if (count <= sample_size) {
    sample.resize(count);
    std::iota(sample.begin(), sample.end(), 0U);
    return sample;
  }
  constexpr std::uint64_t multiplier = 2654435761U;
  for (std::uint64_t i = 1; i <= sample_size; ++i) {
    sample.push_back(static_cast<std::uint32_t>((i * multiplier) % count));
  }
  return sample;
}

// The predicted work of the two children; facets that straddle or touch the wall count in both.
double predicted_cost(const std::vector<ClippedFacet>& facets,
                      const std::vector<std::uint32_t>& sample, std::size_t axis, double position) {
  std::size_t below = 0;
  std::size_t above = 0;
  for (const std::uint32_t i : sample) {
    below += facets[i].lower[axis] <= position;
    above += facets[i].upper[axis] >= position;
  }
  const auto cost = [](std::size_t count) {
    const auto n = static_cast<double>(count);
    return n * std::log2(n + 1);
  };
  return cost(below) + cost(above);
}

// A position in a gap between middles of facets near the given rank, not at a face where it can be
// helped. Faces of models lie at round coordinates; the fraction is not round.
std::optional<double> position_near(std::vector<double>& middles, std::size_t rank,
                                    double fraction) {
  for (std::size_t reach = 0; reach < middles.size(); ++reach) {
    for (const std::size_t i : {rank + reach, rank - reach - 1}) {
      // Before the first one, i has wrapped round to the largest numbers.
      if (i < middles.size() - 1 && middles[i] < middles[i + 1]) {
        return middles[i] + fraction * (middles[i + 1] - middles[i]);
      }
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<Division> Decomposition::choose_division(const CellTask& task) const {
  struct Candidate {
    double cost;
    Division division;
  };
  const std::vector<std::uint32_t> sample = sample_of(task.facets.size());
  std::array<std::vector<double>, 3> middles;
  std::array<double, 3> least;
  std::array<double, 3> most;
  least.fill(std::numeric_limits<double>::infinity());
  most.fill(-std::numeric_limits<double>::infinity());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const std::uint32_t i : sample) {
      const ClippedFacet& facet = task.facets[i];
      middles[axis].push_back(facet.lower[axis] + (facet.upper[axis] - facet.lower[axis]) / 2);
      least[axis] = std::min(least[axis], facet.lower[axis]);
      most[axis] = std::max(most[axis], facet.upper[axis]);
    }
    std::sort(middles[axis].begin(), middles[axis].end());
  }
  std::vector<Candidate> candidates;
  for (const double fraction : {0.4609375, 0.55859375, 0.3671875, 0.640625}) {
    candidates.clear();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const std::optional<double> position :
           {position_near(middles[axis], middles[axis].size() / 2, fraction),
            std::optional<double>(least[axis] + fraction * (most[axis] - least[axis]))}) {
        if (!position) continue;
        const Division division{static_cast<Axis>(axis), round_wall_position(*position)};
        if (!(task.cell.lower[axis] < division.position &&
              division.position < task.cell.upper[axis])) {
          continue;
        }
        candidates.push_back(
            {predicted_cost(task.facets, sample, axis, division.position), division});
      }
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
    for (const Candidate& candidate : candidates) {
      if (!has_facet_in_wall(task, candidate.division)) return candidate.division;
    }
  }
  return std::nullopt;
}

bool Decomposition::has_facet_in_wall(const CellTask& task, const Division& division) const {
  const auto axis = static_cast<std::size_t>(division.axis);
  std::vector<Sign> signs;
  TierStatistics unused;
  const auto clearly_off = [&](const Corner& corner) {
    const double distance = std::abs(corner.vertex.coordinate(division.axis) - division.position);
    return distance > corner.vertex.error * (1 + 0x1p-40) + 0x1p-50 * std::abs(division.position);
  };
  return std::any_of(task.facets.begin(), task.facets.end(), [&](const ClippedFacet& facet) {
    if (facet.upper[axis] < division.position || facet.lower[axis] > division.position) {
      return false;
    }
    const std::span<const Corner> corners = corners_of(task, facet);
    return std::none_of(corners.begin(), corners.end(), clearly_off) &&
           wall_side(scene_.geometry, facet, corners, division, signs, unused) == WallSide::Within;
  });
}

std::vector<CellTask> Decomposition::divide(CellTask& task, const Division& division) const {
  return Divider(*this, task, division).divide();
}

void Decomposition::collect_facets(const CellTask& task, std::vector<CellFacet>& facets) const {
  facets.clear();
  facets.reserve(task.facets.size());
  for (const ClippedFacet& facet : task.facets) {
    const SceneFacet& original = scene_.facets[facet.facet];
    facets.push_back(
        {original.primitive, facet.facet, facet.share, {original.plane, corners_of(task, facet)}});
  }
}

}  // namespace exactcsg
