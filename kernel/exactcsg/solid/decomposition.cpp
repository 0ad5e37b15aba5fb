// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/decomposition.hpp"

#include <algorithm>
#include <cmath>

#include <boost/container/small_vector.hpp>
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

// signs: of all corners.
WallSide exact_wall_side(const Geometry& geometry, const CornerView& corners,
                         const Division& division, std::vector<Sign>& signs,
                         TierStatistics& statistics) {
  switch (wall_signs(geometry, corners, division.axis, division.position, signs, statistics)) {
    case PlaneSplit::AllNegative:
      return WallSide::Below;
    case PlaneSplit::AllPositive:
      return WallSide::Above;
    case PlaneSplit::Both:
      return WallSide::Both;
    case PlaneSplit::InPlane:
      break;
  }
  return WallSide::Within;
}

// As far as the bounds tell; Both: they do not.
WallSide wall_side(const Range& bounds, const Division& division) {
  if (bounds.upper < division.position) return WallSide::Below;
  if (bounds.lower > division.position) return WallSide::Above;
  return WallSide::Both;
}

bool reaches(WallSide side, WallSide child) { return side == child || side == WallSide::Both; }

// A convex polygon seen along an axis, in doubles with a bound of their errors.
class FlatPolygon {
 public:
  using Point = std::array<double, 2>;
  enum class Place : unsigned char { Inside, Outside, Unknown };

  FlatPolygon(const CornerView& corners, Axis first, Axis second) {
    points_.reserve(corners.size());
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const auto [x, error] = corners.coordinate(i, first);
      points_.push_back({x, corners.coordinate(i, second).value});
      error_ = std::max(error_, error);
    }
  }

  // Of the open polygon; outside is not on its rim.
  Place place_of(const Point& point) const {
    bool any_left = false;
    bool any_right = false;
    bool any_unknown = false;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Sign side = side_of(i, point);
      any_left |= side == Sign::Positive;
      any_right |= side == Sign::Negative;
      any_unknown |= side == Sign::Zero;
    }
    if (any_left && any_right) return Place::Outside;
    return any_unknown ? Place::Unknown : Place::Inside;
  }

  // Surely. axis: 0 or 1 of the two
  bool is_between(std::size_t i, std::size_t axis, double lower, double upper) const {
    const double margin = error_ * (1 + 0x1p-50);
    return points_[i][axis] - lower > margin && upper - points_[i][axis] > margin;
  }

  // A side's line surely separates it from a rectangle.
  bool is_off(const Range& first, const Range& second) const {
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Sign side = side_of(i, {first.lower, second.lower});
      if (side == Sign::Zero || side_of(i, {first.lower, second.upper}) != side ||
          side_of(i, {first.upper, second.lower}) != side ||
          side_of(i, {first.upper, second.upper}) != side) {
        continue;
      }
      for (const Point& corner : points_) {
        if (side_of(i, corner) == -side) return true;
      }
    }
    return false;
  }

 private:
  // Of the line from corner i to the next; zero: it may be on it. The point may be as far off as
  // the corners. With e the error of coordinates and u the unit roundoff, a difference d is off by
  // at most 2 e + u |d|, a product of two by the sum of each operand times the other's error and
  // the product of both errors, and products and their difference are rounded.
  Sign side_of(std::size_t i, const Point& point) const {
    const Point& from = points_[i];
    const Point& to = points_[i + 1 == points_.size() ? 0 : i + 1];
    const double along_x = to[0] - from[0];
    const double along_y = to[1] - from[1];
    const double x = point[0] - from[0];
    const double y = point[1] - from[1];
    const double left = along_x * y;
    const double right = along_y * x;
    const double lengths = std::fabs(along_x) + std::fabs(along_y) + std::fabs(x) + std::fabs(y);
    const double bound = error_ * (3 * lengths + 8 * error_) +
                         0x1p-50 * (std::fabs(left) + std::fabs(right)) + 0x1p-1000;
    const double value = left - right;
    return value > bound ? Sign::Positive : value < -bound ? Sign::Negative : Sign::Zero;
  }

  boost::container::small_vector<Point, 8> points_;
  double error_ = 0;
};

// What a division does to a facet, or to the part of it that the cell has.
struct Fate {
  enum class Part : unsigned char { AsItIs, Sliced, Clipped };
  WallSide side = WallSide::Both;
  Part part = Part::AsItIs;  // of what a child has

  bool is_cut() const { return side == WallSide::Both && part == Part::Clipped; }
};

}  // namespace

// Indexed by primitive; reset after use.
struct Decomposition::Scratch {
  explicit Scratch(std::size_t primitives)
      : status(primitives, Membership::Unknown), in_tree(primitives, 0) {}
  std::vector<Membership> status;
  std::vector<unsigned char> in_tree;  // a bit for either child
  csg::PruneScratch<PrunedTree> prune;
  std::vector<Fate> fates;
  std::vector<Sign> signs;  // of the corners of facets that are cut
  std::vector<Sign> signs_of_one;
  Slicer slicer;
  std::vector<Corner> cut_slices;  // the corners of slices that are clipped facets from now on
  std::vector<std::uint32_t> cut_slice_sizes;
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
    // Of its facets' in the scratch memory, if they are not on one side.
    std::size_t first_fate = 0;
    std::size_t first_sign = 0;
    std::size_t first_slice_corner = 0;
    std::size_t first_slice_size = 0;
    std::array<std::uint32_t, 2> counts{};  // that reach each child
    // Of these, facets that will be sliced or clipped ones there, and how many corners the latter
    // have at most.
    std::array<std::uint32_t, 2> sliced_counts{};
    std::array<std::uint32_t, 2> clipped_counts{};
    std::array<std::uint32_t, 2> corner_counts{};
  };

  static WallSide side_of_child(std::size_t child) {
    return child == 0 ? WallSide::Below : WallSide::Above;
  }

  const Range& bounds_of(FacetIndex whole) const { return scene_.bounds.facets[axis_][whole]; }

  void find_sides() {
    scratch_.fates.clear();
    scratch_.signs.clear();
    scratch_.cut_slices.clear();
    scratch_.cut_slice_sizes.clear();
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
      result.sliced_counts[child] = facets.sliced_count;
      result.clipped_counts[child] = facets.clipped_count;
      for (const ClippedFacet& facet : task_.clipped_of(facets)) {
        result.corner_counts[child] += facet.corner_count;
      }
      return result;
    }
    result.first_fate = scratch_.fates.size();
    result.first_sign = scratch_.signs.size();
    result.first_slice_corner = scratch_.cut_slices.size();
    result.first_slice_size = scratch_.cut_slice_sizes.size();
    // A cut adds a corner to a part at most.
    const auto add = [&](const Fate& fate, Fate::Part present, std::size_t corner_count) {
      scratch_.fates.push_back(fate);
      const Fate::Part part = fate.part == Fate::Part::AsItIs ? present : fate.part;
      for (std::size_t child = 0; child < 2; ++child) {
        if (!reaches(fate.side, side_of_child(child))) continue;
        ++result.counts[child];
        if (part == Fate::Part::Sliced) ++result.sliced_counts[child];
        if (part != Fate::Part::Clipped) continue;
        ++result.clipped_counts[child];
        result.corner_counts[child] +=
            static_cast<std::uint32_t>(corner_count) + (fate.is_cut() ? 1 : 0);
      }
    };
    const bool may_slice =
        scene_.primitives[facets.primitive].convex && is_bounded(facets.primitive);
    for (std::uint32_t i = 0; i < facets.whole_count; ++i) {
      const FacetIndex facet = task_.whole_facet(scene_, facets, i);
      Fate fate{wall_side(bounds_of(facet), division_)};
      if (fate.side == WallSide::Both) {
        fate = exact_fate(scene_.corners_of(facet),
                          may_slice && is_short(facet) && is_inside_along_others(facet));
      }
      add(fate, Fate::Part::AsItIs, scene_.facets[facet].corner_count);
    }
    for (const SlicedFacet& facet : task_.sliced_of(facets)) {
      const Fate fate = fate_of(facet);
      const bool is_clipped = fate.part == Fate::Part::Clipped;
      add(fate, Fate::Part::Sliced, is_clipped ? scratch_.cut_slice_sizes.back() : 0);
    }
    for (const ClippedFacet& facet : task_.clipped_of(facets)) {
      Fate fate{wall_side(facet.bounds[axis_], division_)};
      if (fate.side == WallSide::Both) fate = exact_fate(task_.corners_of(facet), false);
      add(fate, Fate::Part::Clipped, facet.corner_count);
    }
    return result;
  }

  // Of a facet that is long beside the cells, the part in a cell says more than the whole does.
  bool is_short(FacetIndex facet) const {
    const Range& bounds = bounds_of(facet);
    return 4 * (bounds.upper - bounds.lower) < task_.cell.upper[axis_] - task_.cell.lower[axis_];
  }

  // LAW decomposition.3.
  bool is_inside_along_others(FacetIndex facet) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (axis == axis_) continue;
      const Range& bounds = scene_.bounds.facets[axis][facet];
      if (!(bounds.lower > task_.cell.lower[axis] && bounds.upper < task_.cell.upper[axis])) {
        return false;
      }
    }
    return true;
  }

  // Keeps the signs if the wall cuts the facet now.
  Fate exact_fate(const CornerView& corners, bool may_slice) {
    std::vector<Sign>& signs = scratch_.signs_of_one;
    const WallSide side =
        exact_wall_side(scene_.geometry, corners, division_, signs, task_.statistics);
    if (side != WallSide::Both) return {side};
    if (may_slice && std::find(signs.begin(), signs.end(), Sign::Zero) == signs.end()) {
      return {side, Fate::Part::Sliced};
    }
    scratch_.signs.insert(scratch_.signs.end(), signs.begin(), signs.end());
    return {side, Fate::Part::Clipped};
  }

  Fate fate_of(const SlicedFacet& facet) {
    const CornerView corners = scene_.corners_of(facet.facet);
    const WallSide side = wall_side(bounds_of(facet.facet), division_);
    if (side != WallSide::Both) return {side};
    if (is_short(facet.facet)) {
      if (const std::optional<Fate> fate = fate_of_slice(facet, corners)) return *fate;
    }
    std::vector<Corner>& cut = scratch_.cut_slices;
    const std::size_t first = cut.size();
    scratch_.slicer.append(scene_.geometry, corners, scene_.facets[facet.facet].plane.plane,
                           slice_of(task_.cell, facet.walls), cut);
    scratch_.cut_slice_sizes.push_back(static_cast<std::uint32_t>(cut.size() - first));
    return {exact_fate(std::span(cut).subspan(first), false).side, Fate::Part::Clipped};
  }

  // Unless its part in the cell has to be cut out.
  std::optional<Fate> fate_of_slice(const SlicedFacet& facet, const CornerView& corners) {
    boost::container::static_vector<std::size_t, 3> others;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (axis != axis_ && facet.walls.across(axis)) others.push_back(axis);
    }
    if (others.size() > 1) return std::nullopt;
    std::vector<Sign>& signs = scratch_.signs_of_one;
    const WallSide side =
        exact_wall_side(scene_.geometry, corners, division_, signs, task_.statistics);
    if (side != WallSide::Both) {
      if (facet.walls.across(axis_)) return Fate{side};
      return std::nullopt;
    }
    if (std::find(signs.begin(), signs.end(), Sign::Zero) != signs.end()) return std::nullopt;
    if (others.empty()) return Fate{side, Fate::Part::Sliced};
    const std::optional<WallSide> parts = side_of_parts(facet, corners, others.front());
    if (!parts) return std::nullopt;
    return Fate{*parts, Fate::Part::Sliced};
  }

  // Which children surely have a part of the facet in common with the task, or surely not: seen
  // along the third axis, where no wall cuts it. nullopt: not known, or a side of the facet may
  // pass through the point where the wall meets one of the walls across the other axis.
  std::optional<WallSide> side_of_parts(const SlicedFacet& facet, const CornerView& corners,
                                        std::size_t other) {
    const FlatPolygon flat(corners, static_cast<Axis>(other), division_.axis);
    const Cell& cell = task_.cell;
    bool is_crossing_inside = false;
    for (const bool upper : {false, true}) {
      if (!(upper ? facet.walls.upper(other) : facet.walls.lower(other))) continue;
      const double wall = upper ? cell.upper[other] : cell.lower[other];
      const FlatPolygon::Place place = flat.place_of({wall, division_.position});
      if (place == FlatPolygon::Place::Unknown) return std::nullopt;
      is_crossing_inside |= place == FlatPolygon::Place::Inside;
    }
    if (is_crossing_inside) return WallSide::Both;
    std::array<bool, 2> has_corner{};
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if (flat.is_between(i, 0, cell.lower[other], cell.upper[other]) &&
          flat.is_between(i, 1, cell.lower[axis_], cell.upper[axis_])) {
        has_corner[scratch_.signs_of_one[i] == Sign::Negative ? 0 : 1] = true;
      }
    }
    if (has_corner[0] && has_corner[1]) return WallSide::Both;
    if (!has_corner[0] && !has_corner[1]) return std::nullopt;
    const Range& along = scene_.bounds.facets[other][facet.facet];
    const Range& across = bounds_of(facet.facet);
    const Range between{std::max(along.lower, cell.lower[other]),
                        std::min(along.upper, cell.upper[other])};
    const Range beyond = has_corner[0]
                             ? Range{division_.position, std::min(across.upper, cell.upper[axis_])}
                             : Range{std::max(across.lower, cell.lower[axis_]), division_.position};
    if (!flat.is_off(between, beyond)) return std::nullopt;
    return has_corner[0] ? WallSide::Below : WallSide::Above;
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
    std::size_t sliced = 0;
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
      sliced += primitive_sides_[i].sliced_counts[which];
      clipped += primitive_sides_[i].clipped_counts[which];
      corners += primitive_sides_[i].corner_counts[which];
    }
    child.primitives.reserve(primitives);
    child.whole.reserve(whole);
    child.sliced.reserve(sliced);
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
    for (const SlicedFacet& facet : task_.sliced_of(facets)) {
      if (is_outside(facet.facet)) return Membership::Out;
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
                                static_cast<std::uint32_t>(child.sliced.size()), 0,
                                static_cast<std::uint32_t>(child.clipped.size()), 0});
  }

  static void end_primitive(CellTask& child) {
    PrimitiveFacets& facets = child.primitives.back();
    if (!facets.all) {
      facets.whole_count = static_cast<std::uint32_t>(child.whole.size()) - facets.first_whole;
    }
    facets.sliced_count = static_cast<std::uint32_t>(child.sliced.size()) - facets.first_sliced;
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
    const std::span<const SlicedFacet> sliced = task_.sliced_of(facets);
    child.sliced.insert(child.sliced.end(), sliced.begin(), sliced.end());
    for (const ClippedFacet& facet : task_.clipped_of(facets)) take(child, facet);
  }

  void take(CellTask& child, const ClippedFacet& facet) const {
    const std::span<const Corner> corners = task_.corners_of(facet);
    child.clipped.push_back(facet);
    child.clipped.back().first_corner = static_cast<std::uint32_t>(child.corners.size());
    child.corners.insert(child.corners.end(), corners.begin(), corners.end());
  }

  void distribute_facets(const PrimitiveFacets& facets, const PrimitiveSides& sides) {
    const Fate* fate = scratch_.fates.data() + sides.first_fate;
    next_sign_ = sides.first_sign;
    for (std::uint32_t i = 0; i < facets.whole_count; ++i, ++fate) {
      const FacetIndex facet = task_.whole_facet(scene_, facets, i);
      if (fate->part == Fate::Part::Sliced) {
        slice({facet, {}, facet_share::whole}, WallSide::Both);
      } else if (fate->is_cut()) {
        cut(facet, facet_share::whole, scene_.corners_of(facet));
      } else if (const std::size_t which = child_on(fate->side); open_[which]) {
        children_[which].whole.push_back(facet);
      }
    }
    distribute_slices(facets, sides, fate);
    for (const ClippedFacet& facet : task_.clipped_of(facets)) {
      if (fate->is_cut()) {
        cut(facet.facet, facet.share, task_.corners_of(facet));
      } else if (const std::size_t which = child_on(fate->side); open_[which]) {
        take(children_[which], facet);
      }
      ++fate;
    }
  }

  static std::size_t child_on(WallSide side) { return side == WallSide::Below ? 0 : 1; }

  // fate: of the first one; past that of the last one afterwards.
  void distribute_slices(const PrimitiveFacets& facets, const PrimitiveSides& sides,
                         const Fate*& fate) {
    std::size_t first_corner = sides.first_slice_corner;
    const std::uint32_t* size = scratch_.cut_slice_sizes.data() + sides.first_slice_size;
    for (const SlicedFacet& facet : task_.sliced_of(facets)) {
      const std::size_t which = child_on(fate->side);
      if (fate->part == Fate::Part::Sliced) {
        slice(facet, fate->side);
      } else if (fate->part == Fate::Part::Clipped) {
        const auto corners =
            std::span<const Corner>(scratch_.cut_slices).subspan(first_corner, *size);
        first_corner += *size++;
        if (fate->is_cut()) {
          cut(facet.facet, facet.share, corners);
        } else if (open_[which]) {
          CellTask& child = children_[which];
          ClippedFacet part = begin_part(child, facet.facet, facet.share);
          child.corners.insert(child.corners.end(), corners.begin(), corners.end());
          end_part(child, part);
        }
      } else if (open_[which]) {
        children_[which].sliced.push_back(facet);
      }
      ++fate;
    }
  }

  // The wall cuts the facet, and the part that the task has if both children get one.
  void slice(SlicedFacet facet, WallSide side) {
    if (side == WallSide::Both) facet.share /= 2;
    if (open_[0] && reaches(side, WallSide::Below)) {
      children_[0].sliced.push_back(facet);
      children_[0].sliced.back().walls.add_upper(axis_);
    }
    if (open_[1] && reaches(side, WallSide::Above)) {
      children_[1].sliced.push_back(facet);
      children_[1].sliced.back().walls.add_lower(axis_);
    }
  }

  static ClippedFacet begin_part(const CellTask& child, FacetIndex facet, std::uint64_t share) {
    return {facet, static_cast<std::uint32_t>(child.corners.size()), 0, share, {}};
  }

  static void end_part(CellTask& child, ClippedFacet& part) {
    part.corner_count = static_cast<std::uint32_t>(child.corners.size()) - part.first_corner;
    widen(part.bounds, std::span(child.corners).subspan(part.first_corner));
    child.clipped.push_back(part);
  }

  void cut(FacetIndex facet, std::uint64_t share, const CornerView& corners) {
    const auto signs = std::span(scratch_.signs).subspan(next_sign_, corners.size());
    next_sign_ += corners.size();
    const PolygonCut cut(scene_.geometry, corners, scene_.facets[facet].plane.plane,
                         PlaneRef::of_wall(division_.axis, division_.position), signs);
    for (std::size_t which = 0; which < 2; ++which) {
      if (!open_[which]) continue;
      CellTask& child = children_[which];
      ClippedFacet part = begin_part(child, facet, share / 2);
      cut.append_part(corners, signs, which == 0 ? Sign::Negative : Sign::Positive, child.corners);
      end_part(child, part);
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
    for (const SlicedFacet& facet : task.sliced_of(facets)) {
      if (is_one_too_many(facet.facet)) return false;
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
    task.primitives.push_back({primitive, true, 0, count, 0, 0, 0, 0});
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
        } else if (i < facets.whole_count + facets.sliced_count) {
          add(scene, task.cell, task.sliced_of(facets)[i - facets.whole_count]);
        } else {
          const ClippedFacet& facet =
              task.clipped_of(facets)[i - facets.whole_count - facets.sliced_count];
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

  void add(const Scene& scene, const Cell& cell, const SlicedFacet& facet) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Range& bounds = scene.bounds.facets[axis][facet.facet];
      set(axis,
          {std::max(bounds.lower, cell.lower[axis]), std::min(bounds.upper, cell.upper[axis])});
    }
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
    for (const SlicedFacet& facet : task.sliced_of(facets)) {
      if (is_in_wall(scene_.bounds.facets[axis][facet.facet], scene_.corners_of(facet.facet))) {
        return true;
      }
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
                        {scene_.facets[facet].plane, scene_.corners_of(facet)},
                        {}});
    }
    for (const SlicedFacet& facet : task.sliced_of(facets)) {
      result.push_back({facets.primitive,
                        facet.facet,
                        facet.share,
                        {scene_.facets[facet.facet].plane, scene_.corners_of(facet.facet)},
                        facet.walls});
    }
    for (const ClippedFacet& facet : task.clipped_of(facets)) {
      result.push_back({facets.primitive,
                        facet.facet,
                        facet.share,
                        {scene_.facets[facet.facet].plane, task.corners_of(facet)},
                        {}});
    }
  }
}

}  // namespace exactcsg
