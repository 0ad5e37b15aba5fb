// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/decomposition.hpp"

#include <algorithm>
#include <cmath>

#include <boost/container/static_vector.hpp>

#include "exactcsg/csg/prune.hpp"
#include "exactcsg/solid/mesh_membership.hpp"
#include "exactcsg/solid/per_thread.hpp"
#include "exactcsg/solid/polygon.hpp"

namespace exactcsg {

namespace {

using csg::Membership;

constexpr std::uint32_t depth_limit = 4000;
constexpr std::size_t sample_size = 128;
constexpr std::size_t sample_of_middles = 16;  // of it

// How many divisions in a row may hardly separate anything before the cell is evaluated as it is.
// Evaluation costs at least the square of the facets (measured: bevel gears of 240 meshes went from
// more than a minute to half a second with 8 chances for 2), so large cells are given more of them.
constexpr std::uint32_t stall_limit(std::size_t facets) {
  return facets <= 48 ? 2 : facets <= 96 ? 4 : facets <= 512 ? 8 : 12;
}

// Facets in at most three planes share a point: no division will ever separate them (MEG's rule).
constexpr std::size_t inseparable_planes = 3;

// Where a facet is with respect to a wall.
enum class WallSide : unsigned char { Below, Above, Both, Within };

// signs: of all corners, appended.
WallSide exact_wall_side(const Geometry& geometry, const CornerView& corners,
                         const Division& division, std::vector<Sign>& signs,
                         TierStatistics& statistics) {
  const std::size_t first = signs.size();
  signs.resize(first + corners.size());
  bool below = false;
  bool above = false;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto [value, error] = corners.coordinate(i, division.axis);
    const double difference = value - division.position;
    // The filter of compare_coordinate, without the vertex.
    if (std::abs(difference) > error * (1 + 0x1p-50)) {
      signs[first + i] = difference > 0 ? Sign::Positive : Sign::Negative;
      statistics.record(Tier::Double, false);
    } else {
      signs[first + i] = geometry.compare_coordinate(corners.vertex(i), division.axis,
                                                     division.position, statistics);
    }
    below |= signs[first + i] == Sign::Negative;
    above |= signs[first + i] == Sign::Positive;
  }
  if (below && above) return WallSide::Both;
  if (below) return WallSide::Below;
  return above ? WallSide::Above : WallSide::Within;
}

// As far as the bounds tell; Both: they do not.
WallSide wall_side(const Range& bounds, const Division& division) {
  if (bounds.upper < division.position) return WallSide::Below;
  if (bounds.lower > division.position) return WallSide::Above;
  return WallSide::Both;
}

bool reaches(WallSide side, WallSide child) { return side == child || side == WallSide::Both; }

}  // namespace

// Indexed by primitive; reset after use.
struct Decomposition::Scratch {
  explicit Scratch(std::size_t primitives)
      : status(primitives, Membership::Unknown), in_tree(primitives, 0) {}
  std::vector<Membership> status;
  std::vector<unsigned char> in_tree;  // a bit for either child
  csg::PruneScratch<PrunedTree> prune;
  std::vector<WallSide> sides;
  std::vector<Sign> signs;  // of the corners of facets that are cut
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
      : scene_(decomposition.scene_),
        task_(task),
        division_(division),
        axis_(static_cast<std::size_t>(division.axis)),
        scratch_(decomposition.scratch_->local()),
        children_(2) {}

  std::vector<CellTask> divide() {
    find_sides();
    prepare_child(0);
    prepare_child(1);
    distribute();
    for (CellTask& child : children_) mark_tree(child.tree, 0);
    finish_children();
    return std::move(children_);
  }

 private:
  // Where the facets of one primitive are.
  struct PrimitiveSides {
    WallSide side = WallSide::Within;  // of all; Both: of some only, or unknown
    std::size_t first = 0;       // of its facets' in Scratch::sides, if they are not on one side
    std::size_t first_sign = 0;  // likewise in Scratch::signs
    std::array<std::uint32_t, 2> counts{};  // that reach each child
    // Of these, facets that will be clipped ones there, and how many corners they have at most.
    std::array<std::uint32_t, 2> clipped_counts{};
    std::array<std::uint32_t, 2> corner_counts{};
  };

  static WallSide side_of_child(std::size_t child) {
    return child == 0 ? WallSide::Below : WallSide::Above;
  }

  const Range& bounds_of(FacetIndex whole) const { return scene_.bounds.facets[axis_][whole]; }

  void find_sides() {
    scratch_.sides.clear();
    scratch_.signs.clear();
    primitive_sides_.reserve(task_.primitives.size());
    for (const PrimitiveFacets& facets : task_.primitives) {
      primitive_sides_.push_back(sides_of(facets));
    }
  }

  PrimitiveSides sides_of(const PrimitiveFacets& facets) {
    PrimitiveSides result;
    const Range& bounds = scene_.bounds.primitives[axis_][facets.primitive];
    result.side = wall_side(bounds, division_);
    const auto count = static_cast<std::uint32_t>(facets.count());
    if (result.side != WallSide::Both) {
      const std::size_t child = result.side == WallSide::Above ? 1 : 0;
      result.counts[child] = count;
      result.clipped_counts[child] = facets.clipped_count;
      for (const ClippedFacet& facet : task_.clipped_of(facets)) {
        result.corner_counts[child] += facet.corner_count;
      }
      return result;
    }
    result.first = scratch_.sides.size();
    result.first_sign = scratch_.signs.size();
    // A cut adds a corner to a part at most.
    const auto add = [&](WallSide side, bool is_clipped, std::size_t corner_count) {
      scratch_.sides.push_back(side);
      const bool is_cut = side == WallSide::Both;
      for (std::size_t child = 0; child < 2; ++child) {
        if (!reaches(side, side_of_child(child))) continue;
        ++result.counts[child];
        if (!is_clipped && !is_cut) continue;
        ++result.clipped_counts[child];
        result.corner_counts[child] += static_cast<std::uint32_t>(corner_count) + (is_cut ? 1 : 0);
      }
    };
    for (std::uint32_t i = 0; i < facets.whole_count; ++i) {
      const FacetIndex facet = task_.whole_facet(scene_, facets, i);
      const WallSide side = wall_side(bounds_of(facet), division_);
      add(side == WallSide::Both ? exact_side(scene_.corners_of(facet)) : side, false,
          scene_.facets[facet].corner_count);
    }
    for (const ClippedFacet& facet : task_.clipped_of(facets)) {
      const WallSide side = wall_side(facet.bounds[axis_], division_);
      add(side == WallSide::Both ? exact_side(task_.corners_of(facet)) : side, true,
          facet.corner_count);
    }
    return result;
  }

  // Keeps the signs if the wall cuts the facet.
  WallSide exact_side(const CornerView& corners) {
    const std::size_t before = scratch_.signs.size();
    const WallSide side =
        exact_wall_side(scene_.geometry, corners, division_, scratch_.signs, task_.statistics);
    if (side != WallSide::Both) scratch_.signs.resize(before);
    return side;
  }

  void prepare_child(std::size_t which) {
    CellTask& child = children_[which];
    child.cell = task_.cell;
    (which == 0 ? child.cell.upper : child.cell.lower)[axis_] = division_.position;
    child.depth = task_.depth + 1;
    settle_lost_primitives(which);
    csg::prune_into(
        task_.tree, [&](PrimitiveIndex primitive) { return scratch_.status[primitive]; },
        child.tree, scratch_.prune);
    for (const PrimitiveFacets& facets : task_.primitives) {
      scratch_.status[facets.primitive] = Membership::Unknown;
    }
    mark_tree(child.tree, which == 0 ? 1 : 2);
    reserve(which);
  }

  // mark: a bit to be set, or 0 to clear all.
  void mark_tree(const PrunedTree& tree, unsigned char mark) {
    auto node = tree.root();
    const auto end = node.next_sibling();
    for (; !(node == end); node = node.first_child()) {
      if (node.kind() != csg::NodeKind::Primitive) continue;
      unsigned char& marks = scratch_.in_tree[node.primitive()];
      marks = mark == 0 ? 0 : static_cast<unsigned char>(marks | mark);
    }
  }

  bool is_in_tree(std::size_t which, PrimitiveIndex primitive) const {
    return (scratch_.in_tree[primitive] >> which & 1U) != 0;
  }

  void reserve(std::size_t which) {
    CellTask& child = children_[which];
    std::size_t primitives = 0;
    std::size_t whole = 0;
    std::size_t clipped = 0;
    std::size_t corners = 0;
    for (std::size_t i = 0; i < task_.primitives.size(); ++i) {
      const PrimitiveFacets& facets = task_.primitives[i];
      const std::uint32_t count = primitive_sides_[i].counts[which];
      if (count == 0 || !is_in_tree(which, facets.primitive)) continue;
      ++primitives;
      if (!(facets.all && primitive_sides_[i].side != WallSide::Both)) {
        whole += std::min(count, facets.whole_count);
      }
      clipped += primitive_sides_[i].clipped_counts[which];
      corners += primitive_sides_[i].corner_counts[which];
    }
    child.primitives.reserve(primitives);
    child.whole.reserve(whole);
    child.clipped.reserve(clipped);
    child.corners.reserve(corners);
  }

  // A primitive none of whose facets reaches the child is Full or Empty there: an inner point of
  // the child decides.
  void settle_lost_primitives(std::size_t which) {
    inner_point_.reset();
    for (std::size_t i = 0; i < task_.primitives.size(); ++i) {
      if (primitive_sides_[i].counts[which] != 0) continue;
      const PrimitiveFacets& facets = task_.primitives[i];
      scratch_.status[facets.primitive] =
          status_at_inner_point(children_[which].cell, facets, primitive_sides_[i]);
    }
  }

  Membership status_at_inner_point(const Cell& cell, const PrimitiveFacets& facets,
                                   const PrimitiveSides& sides) {
    // The child lies beyond the primitive's bounds.
    if (sides.side != WallSide::Both && is_bounded(facets.primitive)) return Membership::Out;
    if (!inner_point_) inner_point_ = inner_point(cell);
    if (!scene_.primitives[facets.primitive].convex) return status_of_mesh(facets);
    const auto is_outside = [&](FacetIndex facet) {
      const OrientedPlaneRef plane = scene_.facets[facet].plane;
      const Sign side = scene_.geometry.side(*inner_point_, plane.plane, task_.statistics);
      return side * sign_of(static_cast<int>(plane.sense)) != Sign::Negative;
    };
    for (std::uint32_t i = 0; i < facets.whole_count; ++i) {
      if (is_outside(task_.whole_facet(scene_, facets, i))) return Membership::Out;
    }
    for (const ClippedFacet& facet : task_.clipped_of(facets)) {
      if (is_outside(facet.facet)) return Membership::Out;
    }
    return Membership::In;
  }

  // Not a half-space, whose facet is cut off by the root cell's walls.
  bool is_bounded(PrimitiveIndex primitive) const {
    return !scene_.facets[scene_.primitives[primitive].first_facet].is_half_space;
  }

  Membership status_of_mesh(const PrimitiveFacets& facets) const {
    std::vector<FacetPolygon> polygons;
    polygons.reserve(facets.count());
    for (std::uint32_t i = 0; i < facets.whole_count; ++i) {
      const FacetIndex facet = task_.whole_facet(scene_, facets, i);
      polygons.push_back({scene_.facets[facet].plane, scene_.corners_of(facet)});
    }
    for (const ClippedFacet& facet : task_.clipped_of(facets)) {
      polygons.push_back({scene_.facets[facet.facet].plane, task_.corners_of(facet)});
    }
    return mesh_membership(scene_.geometry, *inner_point_, polygons, task_.statistics);
  }

  Vertex inner_point(const Cell& cell) const {
    std::array<double, 3> middle{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      middle[axis] = cell.lower[axis] + (cell.upper[axis] - cell.lower[axis]) / 2;
    }
    return between_walls(scene_.geometry, middle);
  }

  void distribute() {
    for (std::size_t i = 0; i < task_.primitives.size(); ++i) {
      const PrimitiveFacets& facets = task_.primitives[i];
      const PrimitiveSides& sides = primitive_sides_[i];
      for (std::size_t which = 0; which < 2; ++which) {
        open_[which] = sides.counts[which] != 0 && is_in_tree(which, facets.primitive);
        if (open_[which]) begin_primitive(children_[which], facets);
      }
      if (sides.side != WallSide::Both) {
        const std::size_t which = sides.side == WallSide::Below ? 0 : 1;
        if (open_[which]) take_all(children_[which], facets);
      } else if (open_[0] || open_[1]) {
        distribute_facets(facets, sides);
      }
      for (std::size_t which = 0; which < 2; ++which) {
        if (open_[which]) end_primitive(children_[which]);
      }
    }
  }

  static void begin_primitive(CellTask& child, const PrimitiveFacets& facets) {
    child.primitives.push_back({facets.primitive, false,
                                static_cast<std::uint32_t>(child.whole.size()), 0,
                                static_cast<std::uint32_t>(child.clipped.size()), 0});
  }

  static void end_primitive(CellTask& child) {
    PrimitiveFacets& facets = child.primitives.back();
    if (!facets.all) {
      facets.whole_count = static_cast<std::uint32_t>(child.whole.size()) - facets.first_whole;
    }
    facets.clipped_count = static_cast<std::uint32_t>(child.clipped.size()) - facets.first_clipped;
    child.facet_count += facets.count();
  }

  void take_all(CellTask& child, const PrimitiveFacets& facets) const {
    if (facets.all) {
      child.primitives.back().all = true;
      child.primitives.back().whole_count = facets.whole_count;
      return;
    }
    const auto first = task_.whole.begin() + facets.first_whole;
    child.whole.insert(child.whole.end(), first, first + facets.whole_count);
    for (const ClippedFacet& facet : task_.clipped_of(facets)) take(child, facet);
  }

  void take(CellTask& child, const ClippedFacet& facet) const {
    const std::span<const Corner> corners = task_.corners_of(facet);
    child.clipped.push_back(facet);
    child.clipped.back().first_corner = static_cast<std::uint32_t>(child.corners.size());
    child.corners.insert(child.corners.end(), corners.begin(), corners.end());
  }

  void distribute_facets(const PrimitiveFacets& facets, const PrimitiveSides& sides) {
    const WallSide* side = scratch_.sides.data() + sides.first;
    next_sign_ = sides.first_sign;
    for (std::uint32_t i = 0; i < facets.whole_count; ++i, ++side) {
      const FacetIndex facet = task_.whole_facet(scene_, facets, i);
      if (*side == WallSide::Both) {
        cut(facet, facet_share::whole, scene_.corners_of(facet));
      } else if (const std::size_t which = *side == WallSide::Below ? 0 : 1; open_[which]) {
        children_[which].whole.push_back(facet);
      }
    }
    for (const ClippedFacet& facet : task_.clipped_of(facets)) {
      if (*side == WallSide::Both) {
        cut(facet.facet, facet.share, task_.corners_of(facet));
      } else if (const std::size_t which = *side == WallSide::Below ? 0 : 1; open_[which]) {
        take(children_[which], facet);
      }
      ++side;
    }
  }

  void cut(FacetIndex facet, std::uint64_t share, const CornerView& corners) {
    const auto signs = std::span(scratch_.signs).subspan(next_sign_, corners.size());
    next_sign_ += corners.size();
    const PolygonCut cut(scene_.geometry, corners, scene_.facets[facet].plane.plane,
                         PlaneRef::of_wall(division_.axis, division_.position), signs);
    for (std::size_t which = 0; which < 2; ++which) {
      if (!open_[which]) continue;
      CellTask& child = children_[which];
      ClippedFacet part{facet, static_cast<std::uint32_t>(child.corners.size()), 0, share / 2, {}};
      cut.append_part(corners, signs, which == 0 ? Sign::Negative : Sign::Positive, child.corners);
      part.corner_count = static_cast<std::uint32_t>(child.corners.size()) - part.first_corner;
      widen(part.bounds, std::span(child.corners).subspan(part.first_corner));
      child.clipped.push_back(part);
    }
  }

  void finish_children() {
    const auto square = [](std::size_t n) {
      return static_cast<double>(n) * static_cast<double>(n);
    };
    const bool separates = square(children_[0].facet_count) + square(children_[1].facet_count) <
                           0.9 * square(task_.facet_count);
    for (CellTask& child : children_) child.stalled = separates ? 0 : task_.stalled + 1;
    children_[0].statistics = task_.statistics;
  }

  const Scene& scene_;
  CellTask& task_;
  const Division& division_;
  std::size_t axis_;
  Scratch& scratch_;
  std::vector<CellTask> children_;
  std::vector<PrimitiveSides> primitive_sides_;
  std::array<bool, 2> open_{};  // the children that take facets of the primitive at hand
  std::optional<Vertex> inner_point_;
  std::size_t next_sign_ = 0;  // that of the facet to be cut next
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
  const auto is_one_too_many = [&](FacetIndex facet) {
    const PlaneRef plane = scene_.facets[facet].plane.plane;
    const auto end = planes.begin() + static_cast<std::ptrdiff_t>(count);
    if (std::find(planes.begin(), end, plane) != end) return false;
    if (count == planes.size()) return true;
    planes[count++] = plane;
    return false;
  };
  for (const PrimitiveFacets& facets : task.primitives) {
    for (std::uint32_t i = 0; i < facets.whole_count; ++i) {
      if (is_one_too_many(task.whole_facet(scene_, facets, i))) return false;
    }
    for (const ClippedFacet& facet : task.clipped_of(facets)) {
      if (is_one_too_many(facet.facet)) return false;
    }
  }
  return true;
}

CellTask Decomposition::root() const {
  // Simplified, so that LAW decomposition.1 holds of the root as well.
  PrunedTree tree;
  csg::prune_into(
      scene_.tree, [](PrimitiveIndex) { return Membership::Unknown; }, tree);
  return task_of(scene_.root, tree);
}

CellTask Decomposition::task_of(const Cell& cell, const PrunedTree& tree) const {
  CellTask task;
  task.cell = cell;
  task.tree = tree;
  std::vector<PrimitiveIndex> primitives;
  csg::for_each_primitive(tree, [&](PrimitiveIndex p) { primitives.push_back(p); });
  std::sort(primitives.begin(), primitives.end());
  primitives.erase(std::unique(primitives.begin(), primitives.end()), primitives.end());
  for (const PrimitiveIndex primitive : primitives) {
    const std::uint32_t count = scene_.primitives[primitive].facet_count;
    task.primitives.push_back({primitive, true, 0, count, 0, 0});
    task.facet_count += count;
  }
  return task;
}

bool Decomposition::is_leaf(const CellTask& task) const {
  if (progress_ != nullptr) progress_->check();
  return task.facet_count == 0 || task.facet_count <= facets_per_cell_ ||
         task.stalled >= stall_limit(task.facet_count) || task.depth >= depth_limit ||
         inseparable(task);
}

namespace {

// Bounds of facets spread over all of them, at most sample_size.
class FacetSample {
 public:
  FacetSample(const Scene& scene, const CellTask& task)
      : stride_(std::max(1.0, static_cast<double>(task.facet_count) / sample_size)) {
    std::size_t passed = 0;
    std::size_t wanted = next_wanted();
    for (const PrimitiveFacets& facets : task.primitives) {
      for (; wanted < passed + facets.count(); wanted = next_wanted()) {
        const auto i = static_cast<std::uint32_t>(wanted - passed);
        if (i < facets.whole_count) {
          const FacetIndex facet = task.whole_facet(scene, facets, i);
          for (std::size_t axis = 0; axis < 3; ++axis) set(axis, scene.bounds.facets[axis][facet]);
        } else {
          const ClippedFacet& facet = task.clipped_of(facets)[i - facets.whole_count];
          for (std::size_t axis = 0; axis < 3; ++axis) set(axis, facet.bounds[axis]);
        }
        if (++count_ == sample_size) return;
      }
      passed += facets.count();
    }
  }

  std::span<const double> lower(std::size_t axis) const { return {lower_[axis].data(), count_}; }
  std::span<const double> upper(std::size_t axis) const { return {upper_[axis].data(), count_}; }
  // From the least lower end to the greatest upper end.
  const Range& extent(std::size_t axis) const { return extents_[axis]; }

 private:
  // One of each stretch of facets, not at a fixed place in it: a fixed stride would pick the same
  // facet of every primitive.
  std::size_t next_wanted() {
    noise_ = noise_ * 6364136223846793005U + 1442695040888963407U;
    const double place = static_cast<double>(noise_ >> 40U) * 0x1p-24;
    const double offset = stride_ > 1 ? place : 0;
    return static_cast<std::size_t>((static_cast<double>(count_) + offset) * stride_);
  }

  void set(std::size_t axis, const Range& bounds) {
    lower_[axis][count_] = bounds.lower;
    upper_[axis][count_] = bounds.upper;
    extents_[axis].lower = std::min(extents_[axis].lower, bounds.lower);
    extents_[axis].upper = std::max(extents_[axis].upper, bounds.upper);
  }

  double stride_;
  std::size_t count_ = 0;
  std::uint64_t noise_ = 0x9e3779b97f4a7c15U;
  std::array<std::array<double, sample_size>, 3> lower_;
  std::array<std::array<double, sample_size>, 3> upper_;
  std::array<Range, 3> extents_;
};

// The predicted work of the two children; facets that straddle or touch the wall count in both.
double predicted_cost(const FacetSample& sample, std::size_t axis, double position) {
  const auto below =
      std::ranges::count_if(sample.lower(axis), [=](double lower) { return lower <= position; });
  const auto above =
      std::ranges::count_if(sample.upper(axis), [=](double upper) { return upper >= position; });
  const auto cost = [](std::ptrdiff_t count) {
    const auto n = static_cast<double>(count);
    return n * std::log2(n + 1);
  };
  return cost(below) + cost(above);
}

// Two successive different middles of facets, near the median.
std::optional<Range> gap_at_median(std::span<const double> lower, std::span<const double> upper) {
  boost::container::static_vector<double, sample_of_middles> middles;
  const std::size_t step = (lower.size() + sample_of_middles - 1) / sample_of_middles;
  for (std::size_t i = 0; i < lower.size(); i += step) {
    middles.push_back(lower[i] + (upper[i] - lower[i]) / 2);
  }
  const auto median = middles.begin() + static_cast<std::ptrdiff_t>(middles.size() / 2);
  std::nth_element(middles.begin(), median, middles.end());
  const auto next = std::min_element(median + 1, middles.end());
  if (next != middles.end() && *median < *next) return Range{*median, *next};
  const auto last = std::max_element(middles.begin(), median);
  if (last != median && *last < *median) return Range{*last, *median};
  std::sort(middles.begin(), middles.end());
  const std::size_t rank = middles.size() / 2;
  for (std::size_t reach = 0; reach < middles.size(); ++reach) {
    for (const std::size_t i : {rank + reach, rank - reach - 1}) {
      // Before the first one, i has wrapped round to the largest numbers.
      if (i < middles.size() - 1 && middles[i] < middles[i + 1]) {
        return Range{middles[i], middles[i + 1]};
      }
    }
  }
  return std::nullopt;
}

}  // namespace

// In a gap between facets or the middle of all, and not at a face where it can be helped. Faces of
// models lie at round coordinates; the fractions are not round.
std::optional<Division> Decomposition::choose_division(const CellTask& task) const {
  struct Gap {
    std::size_t axis;
    Range range;
  };
  struct Candidate {
    double cost;
    Division division;
  };
  const FacetSample sample(scene_, task);
  boost::container::static_vector<Gap, 6> gaps;  // in one of which to divide
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (const auto gap = gap_at_median(sample.lower(axis), sample.upper(axis))) {
      gaps.push_back({axis, *gap});
    }
    gaps.push_back({axis, sample.extent(axis)});
  }
  boost::container::static_vector<Candidate, 6> candidates;
  for (const double fraction : {0.4609375, 0.55859375, 0.3671875, 0.640625}) {
    candidates.clear();
    for (const auto& [axis, gap] : gaps) {
      const Division division{static_cast<Axis>(axis),
                              round_wall_position(gap.lower + fraction * (gap.upper - gap.lower))};
      if (task.cell.lower[axis] < division.position && division.position < task.cell.upper[axis]) {
        candidates.push_back({predicted_cost(sample, axis, division.position), division});
      }
    }
    const auto is_cheaper = [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; };
    while (!candidates.empty()) {
      const auto best = std::min_element(candidates.begin(), candidates.end(), is_cheaper);
      if (!has_facet_in_wall(task, best->division)) return best->division;
      candidates.erase(best);
    }
  }
  return std::nullopt;
}

bool Decomposition::has_facet_in_wall(const CellTask& task, const Division& division) const {
  const auto axis = static_cast<std::size_t>(division.axis);
  std::vector<Sign> signs;
  TierStatistics unused;
  const auto any_is_clearly_off = [&](const CornerView& corners) {
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const auto [value, error] = corners.coordinate(i, division.axis);
      const double distance = std::abs(value - division.position);
      if (distance > error * (1 + 0x1p-40) + 0x1p-50 * std::abs(division.position)) return true;
    }
    return false;
  };
  const auto is_in_wall = [&](const Range& bounds, const CornerView& corners) {
    if (wall_side(bounds, division) != WallSide::Both) return false;
    signs.clear();
    return !any_is_clearly_off(corners) &&
           exact_wall_side(scene_.geometry, corners, division, signs, unused) == WallSide::Within;
  };
  for (const PrimitiveFacets& facets : task.primitives) {
    if (wall_side(scene_.bounds.primitives[axis][facets.primitive], division) != WallSide::Both) {
      continue;
    }
    for (std::uint32_t i = 0; i < facets.whole_count; ++i) {
      const FacetIndex facet = task.whole_facet(scene_, facets, i);
      const Range& bounds = scene_.bounds.facets[axis][facet];
      if (wall_side(bounds, division) != WallSide::Both) continue;
      if (is_in_wall(bounds, scene_.corners_of(facet))) return true;
    }
    for (const ClippedFacet& facet : task.clipped_of(facets)) {
      if (is_in_wall(facet.bounds[axis], task.corners_of(facet))) return true;
    }
  }
  return false;
}

std::vector<CellTask> Decomposition::divide(CellTask& task, const Division& division) const {
  return Divider(*this, task, division).divide();
}

void Decomposition::collect_facets(const CellTask& task, std::vector<CellFacet>& result) const {
  result.clear();
  result.reserve(task.facet_count);
  for (const PrimitiveFacets& facets : task.primitives) {
    for (std::uint32_t i = 0; i < facets.whole_count; ++i) {
      const FacetIndex facet = task.whole_facet(scene_, facets, i);
      result.push_back({facets.primitive,
                        facet,
                        facet_share::whole,
                        {scene_.facets[facet].plane, scene_.corners_of(facet)}});
    }
    for (const ClippedFacet& facet : task.clipped_of(facets)) {
      result.push_back({facets.primitive,
                        facet.facet,
                        facet.share,
                        {scene_.facets[facet.facet].plane, task.corners_of(facet)}});
    }
  }
}

}  // namespace exactcsg
