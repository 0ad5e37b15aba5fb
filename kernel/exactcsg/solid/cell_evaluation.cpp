// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/cell_evaluation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "exactcsg/number/side_bound.hpp"
#include "exactcsg/solid/polygon.hpp"

namespace exactcsg {

using csg::Membership;

namespace {

// That are kept from one facet to the next, lest cells with many facets take too much memory.
constexpr std::size_t most_vertices = 1U << 14U;

PlaneSplit outside_of(OrientedPlaneRef plane) {
  return plane.sense > 0 ? PlaneSplit::AllPositive : PlaneSplit::AllNegative;
}

[[noreturn]] void throw_undecided() {
  throw Error(ErrorId::InternalError, {"a facet that is still undecided", "a decided one"});
}

}  // namespace

Slice slice_of(const Cell& cell, CutWalls walls) {
  Slice slice;
  for (const Axis axis : {Axis::X, Axis::Y, Axis::Z}) {
    const auto i = static_cast<std::size_t>(axis);
    if (walls.lower(i)) slice.add({PlaneRef::of_wall(axis, cell.lower[i]), Sign::Positive});
    if (walls.upper(i)) slice.add({PlaneRef::of_wall(axis, cell.upper[i]), Sign::Negative});
  }
  return slice;
}

CellEvaluator::CellEvaluator(const Scene& scene, Progress* progress)
    : scene_(scene),
      progress_(progress),
      truth_(scene.primitives.size(), CombineSides(), AbsorbsSides(),
             {BothSides{Membership::In, Membership::In},
              BothSides{Membership::Out, Membership::Out}}) {}

void CellEvaluator::build_local_forms(std::span<const CellFacet> facets) {
  nodes_.clear();
  locals_.clear();
  set_planes(facets);
  for (std::size_t begin = 0; begin < facets.size();) {
    std::size_t end = begin;
    while (end < facets.size() && facets[end].primitive == facets[begin].primitive) ++end;
    const PrimitiveIndex primitive = facets[begin].primitive;
    const bool convex = scene_.primitives[primitive].convex;
    const LocalPlace root = convex ? LocalPlace::decided(Membership::Out)
                                   : local_form_of_mesh(facets.subspan(begin, end - begin));
    locals_.push_back({primitive, convex, root, static_cast<std::uint32_t>(begin),
                       static_cast<std::uint32_t>(end - begin), static_cast<std::uint32_t>(begin)});
    begin = end;
  }
}

// Of the cell's vertices none is farther from the origin than the farthest corner of a facet, but
// for the errors of either; one with a greater error than the limit is left to Geometry::side.
void CellEvaluator::set_planes(std::span<const CellFacet> facets) {
  double length = 0;
  double error = 0;
  for (const CellFacet& facet : facets) {
    facet.polygon.corners.for_each_vertex([&](std::size_t, const Vertex& v) {
      length = std::max(length, std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z));
      error = std::max(error, v.error);
    });
  }
  constexpr double growth = 16;  // of the error, from corners to the points where they are cut
  error_limit_ = growth * error + 0x1p-52 * length;
  const double length_limit = length * (1 + 0x1p-20) + 8 * error_limit_;
  planes_.clear();
  for (const CellFacet& facet : facets) {
    const OrientedPlaneRef plane = facet.polygon.plane;
    const Geometry::ApproximatePlane near = scene_.geometry.approximate(plane.plane);
    planes_.push_back(
        {plane, near.a, near.b, near.c, near.d, side_bound(near, length_limit, error_limit_)});
  }
}

LocalPlace CellEvaluator::local_form_of_mesh(std::span<const CellFacet> facets) {
  std::vector<FacetPolygon> polygons;
  polygons.reserve(facets.size());
  for (const CellFacet& facet : facets) polygons.push_back(facet.polygon);
  return append_mesh_form(scene_.geometry, polygons, nodes_, *statistics_);
}

void CellEvaluator::order_primitives_for(const CellFacet& facet) {
  order_.clear();
  not_coplanar_.clear();
  const auto has_coplanar_facet = [&](const LocalPrimitive& local) {
    const auto planes = std::span(planes_).subspan(local.first_facet, local.facet_count);
    return std::any_of(planes.begin(), planes.end(), [&](const NearPlane& near) {
      return near.oriented.plane == facet.polygon.plane.plane;
    });
  };
  for (std::uint32_t i = 0; i < locals_.size(); ++i) {
    if (locals_[i].primitive == facet.primitive) continue;
    (has_coplanar_facet(locals_[i]) ? order_ : not_coplanar_).push_back(i);
  }
  coplanar_count_ = order_.size();
  order_.insert(order_.end(), not_coplanar_.begin(), not_coplanar_.end());
}

bool CellEvaluator::evaluate(std::span<const CellFacet> facets, const Cell& cell,
                             const PrunedTree& tree, PieceCollector& result,
                             TierStatistics& statistics) {
  result_ = &result;
  cell_ = &cell;
  statistics_ = &statistics;
  in_general_position_ = true;
  build_local_forms(facets);
  truth_.assign(tree, {});
  store_.clear();
  for (const CellFacet& facet : facets) {
    if (progress_ != nullptr) progress_->check();
    facet_ = &facet;
    order_primitives_for(facet);
    if (coplanar_count_ > 0) in_general_position_ = false;
    const bool outward_front = facet.polygon.plane.sense > 0;
    truth_.change(facet.primitive, outward_front ? BothSides{Membership::Out, Membership::In}
                                                 : BothSides{Membership::In, Membership::Out});
    if (store_.vertex_count() > most_vertices) store_.clear();
    decided_.clear();
    crossings_.clear();
    const PieceCollector::Mark before = result.mark();
    if (facet.walls.any()) {
      classify_slice(facet);
    } else {
      for (std::uint32_t place = 0; place < order_.size(); ++place) {
        crossings_.push_back({place, {}, {}, false});
      }
      classify({append_polygon(facet.polygon.corners, store_), facet.share}, {0, order_.size()});
    }
    join_pieces(facet, before);
    store_.corners.clear();
    truth_.change(facet.primitive, {});
  }
  return in_general_position_;
}

void CellEvaluator::classify_slice(const CellFacet& facet) {
  const OrientedPlaneRef own = facet.polygon.plane;
  const std::size_t candidates = crossings_.size();
  const Outcome outcome = decide_whole(append_polygon(facet.polygon.corners, store_));
  if (outcome == Outcome::Boundary) {
    result_->add_slice({own.plane, *outward_sense()}, own.sense, facet.facet, facet.share,
                       slice_of(*cell_, facet.walls));
  } else if (outcome == Outcome::Undecided) {
    cut_slice_.clear();
    slicer_.append(scene_.geometry, facet.polygon.corners, own.plane, slice_of(*cell_, facet.walls),
                   cut_slice_);
    store_.corners.clear();
    classify({append_polygon(cut_slice_, store_), facet.share}, {candidates, crossings_.size()});
  }
  undo_decisions(0);
}

// Decides the primitives that surely do not cross the facet; the others are added to the crossings.
// Where a corner lies in a plane, it is asked again which of the corners in the cell do.
CellEvaluator::Outcome CellEvaluator::decide_whole(const CornerRun& polygon) {
  const std::size_t candidates = crossings_.size();
  bool coplanar_crosses = false;
  for (std::uint32_t place = 0; place < order_.size(); ++place) {
    Crossing crossing{place, {}, {}, false};
    if (const auto outward = outward_sense()) {
      if (*outward == 0) return Outcome::NoBoundary;
      if (!coplanar_crosses && !is_coplanar(crossing)) return Outcome::Boundary;
    }
    LocalPrimitive& other = locals_[order_[place]];
    Relation relation = Relation::Across;
    if (other.convex) {
      const bool before = std::exchange(in_general_position_, true);
      relation = relation_to_planes(polygon, other, crossing.inside);
      if (!std::exchange(in_general_position_, before)) relation = Relation::Across;
    }
    if (relation == Relation::Across) {
      coplanar_crosses |= is_coplanar(crossing);
      crossings_.push_back(crossing);
      continue;
    }
    const bool is_inside = relation == Relation::Inside;
    if (is_inside && is_left_to(other.primitive, crossing.inside)) return Outcome::NoBoundary;
    decide(other.primitive,
           is_inside ? crossing.inside : BothSides{Membership::Out, Membership::Out});
  }
  const auto outward = outward_sense();
  if (outward && *outward == 0) return Outcome::NoBoundary;
  if (outward && !coplanar_crosses) return Outcome::Boundary;
  if (crossings_.size() == candidates) throw_undecided();
  return Outcome::Undecided;
}

// Other primitives' planes may cut a facet that all of them leave alone in the end.
void CellEvaluator::join_pieces(const CellFacet& facet, const PieceCollector::Mark& before) {
  const std::span<const BoundaryPiece> pieces = result_->pieces_since(before);
  if (pieces.size() < 2 || facet.share == 0) return;
  std::uint64_t sum = 0;
  for (const BoundaryPiece& piece : pieces) {
    if (piece.plane != pieces.front().plane) return;
    sum += piece.share;
  }
  if (sum != facet.share) return;
  const BoundaryPiece joined = pieces.front();
  result_->take_back_to(before);
  if (facet.walls.any()) {
    result_->add_slice(joined.plane, joined.corner_sense, facet.facet, facet.share,
                       slice_of(*cell_, facet.walls));
  } else {
    result_->add(joined.plane, joined.corner_sense, facet.facet, facet.share,
                 facet.polygon.corners);
  }
}

void CellEvaluator::classify(Part part, Crossings candidates) {
  const std::size_t first_crossing = crossings_.size();
  const std::size_t first_decided = decided_.size();
  const std::size_t first_corner = store_.corners.size();
  switch (decide_uncrossed(part, candidates)) {
    case Outcome::NoBoundary:
      break;
    case Outcome::Boundary:
      emit(part.polygon, part.share, *outward_sense());
      break;
    case Outcome::Undecided:
      divide(part, candidates);
      break;
  }
  crossings_.resize(first_crossing);
  undo_decisions(first_decided);
  store_.corners.resize(first_corner);
}

// What the boundary's outward normal is along the plane's stored one, or 0: no boundary. nullopt:
// not known.
std::optional<signed char> CellEvaluator::outward_sense() const {
  const auto [front, behind] = truth_.value();
  if (front == Membership::Unknown || behind == Membership::Unknown) return std::nullopt;
  if (front == behind) return static_cast<signed char>(0);
  return static_cast<signed char>(behind == Membership::In ? 1 : -1);
}

bool CellEvaluator::is_no_boundary_if(PrimitiveIndex primitive, const BothSides& sides) {
  truth_.change(primitive, sides);
  const auto outward = outward_sense();
  truth_.change(primitive, {});
  return outward && *outward == 0;
}

// Decides all primitives that do not cross the part, as long as that matters; the others are the
// candidates that are left. A part of which only the section with a primitive can be boundary
// becomes that section.
CellEvaluator::Outcome CellEvaluator::decide_uncrossed(Part& part, Crossings& candidates) {
  const BothSides out{Membership::Out, Membership::Out};
  const std::size_t first_crossing = crossings_.size();
  bool coplanar_crosses = false;
  bool is_section = false;
  for (std::size_t i = candidates.begin; i < candidates.end; ++i) {
    Crossing crossing = crossings_[i];
    const bool is_known = std::exchange(crossing.is_known, false) && !is_section;
    if (const auto outward = outward_sense()) {
      if (*outward == 0) return Outcome::NoBoundary;
      if (!coplanar_crosses && !is_coplanar(crossing)) return Outcome::Boundary;
    }
    LocalPrimitive& other = locals_[order_[crossing.place]];
    const Relation relation = !other.convex ? Relation::Across
                              : is_known    ? relation_of(crossing.section)
                                            : relate(part.polygon, other, crossing);
    switch (relation) {
      case Relation::Outside:
        decide(other.primitive, out);
        break;
      case Relation::Inside:
        if (is_left_to(other.primitive, crossing.inside)) return Outcome::NoBoundary;
        decide(other.primitive, crossing.inside);
        break;
      case Relation::Across:
        if (other.convex && is_no_boundary_if(other.primitive, out)) {
          if (is_left_to(other.primitive, crossing.inside)) return Outcome::NoBoundary;
          decide(other.primitive, crossing.inside);
          part = {crossing.section, part.share / 2};
          forget_whole(part.polygon, store_);
          is_section = true;
          if (crossings_.size() == first_crossing) break;
          // What crossed the part as it was may not cross what is left of it.
          for (std::size_t later = i + 1; later < candidates.end; ++later) {
            crossings_.push_back(Crossing(crossings_[later]));
            crossings_.back().is_known = false;
          }
          candidates = {first_crossing, crossings_.size()};
          return decide_uncrossed(part, candidates);
        }
        coplanar_crosses |= is_coplanar(crossing);
        crossings_.push_back(crossing);
        break;
    }
  }
  candidates = {first_crossing, crossings_.size()};
  const auto outward = outward_sense();
  if (outward && *outward == 0) return Outcome::NoBoundary;
  if (outward && !coplanar_crosses) return Outcome::Boundary;
  if (candidates.begin == candidates.end) throw_undecided();
  return Outcome::Undecided;
}

// All planes are looked at before any of them cuts: one that leaves the polygon outside ends it,
// and is asked first of the next polygon, which mostly is a neighbour of this one. Those that cut
// are kept in cutting_.
CellEvaluator::Relation CellEvaluator::relation_to_planes(const CornerRun& polygon,
                                                          LocalPrimitive& local,
                                                          BothSides& inside) {
  const PlaneRef own = facet_->polygon.plane.plane;
  inside = {Membership::In, Membership::In};
  cutting_.clear();
  const std::uint32_t end = local.first_facet + local.facet_count;
  std::uint32_t i = local.separating;
  do {
    const OrientedPlaneRef plane = planes_[i].oriented;
    if (plane.plane == own) {
      inside = plane.sense > 0 ? BothSides{Membership::Out, Membership::In}
                               : BothSides{Membership::In, Membership::Out};
    } else {
      const PlaneSplit side = split_without_signs(polygon, planes_[i]);
      if (side == outside_of(plane)) {
        local.separating = i;
        return Relation::Outside;
      }
      if (side == PlaneSplit::Both) cutting_.push_back(i);
    }
    if (++i == end) i = local.first_facet;
  } while (i != local.separating);
  return cutting_.empty() ? Relation::Inside : Relation::Across;
}

CellEvaluator::Relation CellEvaluator::relate(const CornerRun& polygon, LocalPrimitive& local,
                                              Crossing& crossing) {
  const PlaneRef own = facet_->polygon.plane.plane;
  const Relation relation = relation_to_planes(polygon, local, crossing.inside);
  if (relation != Relation::Across) return relation;
  crossing.section = polygon;
  for (const std::uint32_t cutting : cutting_) {
    const OrientedPlaneRef plane = planes_[cutting].oriented;
    const PlaneSplit side = split(crossing.section, planes_[cutting]);
    if (side == outside_of(plane)) return Relation::Outside;
    if (side != PlaneSplit::Both) continue;
    const CuttingPlane cut{plane.plane, signs_};
    const auto crossed = append_crossings(scene_.geometry, own, crossing.section, cut, store_);
    const Sign inner = plane.sense > 0 ? Sign::Negative : Sign::Positive;
    crossing.section = append_part(crossing.section, cut, inner, crossed, store_);
  }
  return Relation::Across;
}

// Of a section with the part at hand.
CellEvaluator::Relation CellEvaluator::relation_of(const CornerRun& section) const {
  const std::span<const SectionCorner> corners = store_.of(section);
  const bool is_all = std::none_of(corners.begin(), corners.end(), [](const SectionCorner& corner) {
    return corner.side == SectionCorner::none;
  });
  return is_all ? Relation::Inside : Relation::Across;
}

// The sides of all corners into signs_.
PlaneSplit CellEvaluator::split(const CornerRun& polygon, PlaneRef plane) {
  return split_with(polygon, [&](const Vertex& vertex) { return side(vertex, plane); });
}

Sign CellEvaluator::side(const Vertex& vertex, PlaneRef plane) {
  const Sign sign = scene_.geometry.side(vertex, plane, *statistics_);
  if (sign == Sign::Zero && !is_made_by(vertex, plane)) in_general_position_ = false;
  return sign;
}

// The same by one bound for all of the cell's vertices; where it does not decide, by their own.
PlaneSplit CellEvaluator::split(const CornerRun& polygon, const NearPlane& near) {
  std::size_t decided = 0;
  const PlaneSplit result =
      split_with(polygon, [&](const Vertex& v) { return side(v, near, decided); });
  statistics_->answers[static_cast<std::size_t>(Tier::Double)] += decided;
  return result;
}

inline Sign CellEvaluator::side(const Vertex& v, const NearPlane& near, std::size_t& decided) {
  const double value = near.a * v.x + near.b * v.y + near.c * v.z + near.d;
  if (!(std::fabs(value) > near.bound && v.error <= error_limit_)) {
    return side(v, near.oriented.plane);
  }
  ++decided;
  return value > 0 ? Sign::Positive : Sign::Negative;
}

// Corners behind those that say Both are not asked: the plane cuts the polygon, and then its
// section is asked.
PlaneSplit CellEvaluator::split_without_signs(const CornerRun& polygon, const NearPlane& near) {
  std::size_t decided = 0;
  bool negative = false;
  bool positive = false;
  for (const SectionCorner& corner : store_.of(polygon)) {
    const Sign sign = side(store_.vertex(corner), near, decided);
    negative |= sign == Sign::Negative;
    positive |= sign == Sign::Positive;
    if (negative && positive) break;
  }
  statistics_->answers[static_cast<std::size_t>(Tier::Double)] += decided;
  return split_of(negative, positive);
}

PlaneSplit CellEvaluator::split_of(bool negative, bool positive) {
  if (negative && positive) return PlaneSplit::Both;
  if (!negative && !positive) {
    throw Error(ErrorId::InternalError, {"a facet in a plane that is not its own", ""});
  }
  return positive ? PlaneSplit::AllPositive : PlaneSplit::AllNegative;
}

template <class SideOf>
PlaneSplit CellEvaluator::split_with(const CornerRun& polygon, const SideOf& side_of) {
  const std::span<const SectionCorner> corners = store_.of(polygon);
  signs_.resize(corners.size());
  bool negative = false;
  bool positive = false;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Sign sign = side_of(store_.vertex(corners[i]));
    signs_[i] = sign;
    negative |= sign == Sign::Negative;
    positive |= sign == Sign::Positive;
  }
  return split_of(negative, positive);
}

void CellEvaluator::divide(const Part& part, Crossings crossings) {
  const auto first = crossings_.begin() + static_cast<std::ptrdiff_t>(crossings.begin);
  const auto mesh = std::find_if(first, crossings_.end(),
                                 [&](const Crossing& crossing) { return !local(crossing).convex; });
  if (mesh != crossings_.end()) {
    std::rotate(first, mesh, mesh + 1);
    const LocalPlace root = local(*first).root;
    descend(part, root, root, crossings);
  } else if (crossings.end - crossings.begin == 1) {
    emit_on_either_side(part, *first);
  } else {
    const PlaneRef plane = choose_plane(crossings);
    if (split(part.polygon, plane) != PlaneSplit::Both) {
      throw Error(ErrorId::InternalError, {"a section's side outside the polygon", ""});
    }
    const auto [positive, negative] = halves(part, plane);
    classify_half(positive, crossings, plane, PlaneSplit::AllNegative);
    classify_half(negative, crossings, plane, PlaneSplit::AllPositive);
  }
}

// Of the primitives that cross the whole, those with a section on the other side leave this half
// outside; of the others the section with the half is what it has of theirs.
void CellEvaluator::classify_half(const Part& half, Crossings crossings, PlaneRef plane,
                                  PlaneSplit other_side) {
  const std::size_t first_decided = decided_.size();
  const std::size_t first_candidate = crossings_.size();
  for (std::size_t i = crossings.begin; i < crossings.end; ++i) {
    Crossing crossing = crossings_[i];
    const PlaneSplit split_section = split(crossing.section, plane);
    if (split_section == other_side) {
      decide(local(crossing).primitive, {Membership::Out, Membership::Out});
      continue;
    }
    const CuttingPlane cut{plane, signs_};
    std::array<std::uint32_t, 2> crossed{};
    if (split_section == PlaneSplit::Both) {
      crossed = append_crossings(scene_.geometry, facet_->polygon.plane.plane, crossing.section,
                                 cut, store_);
    }
    const Sign kept = other_side == PlaneSplit::AllNegative ? Sign::Positive : Sign::Negative;
    crossing.section =
        append_part_of_half(crossing.section, cut, kept, crossed, half.polygon, store_);
    crossing.is_known = true;
    crossings_.push_back(crossing);
  }
  forget_whole(half.polygon, store_);
  classify(half, {first_candidate, crossings_.size()});
  crossings_.resize(first_candidate);
  undo_decisions(first_decided);
}

// The only primitive left is convex.
void CellEvaluator::emit_on_either_side(const Part& part, const Crossing& crossing) {
  const PrimitiveIndex primitive = local(crossing).primitive;
  const auto outward_if = [&](const BothSides& sides) -> signed char {
    if (is_left_to(primitive, sides)) return 0;
    truth_.change(primitive, sides);
    const auto outward = outward_sense();
    truth_.change(primitive, {});
    if (!outward) throw_undecided();
    return *outward;
  };
  const signed char outside = outward_if({Membership::Out, Membership::Out});
  const signed char inside = outward_if(crossing.inside);
  if (inside == outside) {
    if (inside != 0) emit(part.polygon, part.share, inside);
    return;
  }
  if (inside != 0) emit(crossing.section, part.share / 2, inside);
  if (outside != 0) emit_remainder(part, crossing.section, outside);
}

// A side of a section inside the part, with other sections beyond it where there is such a one.
PlaneRef CellEvaluator::choose_plane(Crossings crossings) {
  const CornerRun section = crossings_[crossings.begin].section;
  std::optional<PlaneRef> best;
  std::size_t most_beyond = 0;
  for (std::size_t i = section.begin; i < section.end; ++i) {
    if (store_.corners[i].side != SectionCorner::none) continue;
    const PlaneRef plane = store_.corners[i].side_plane;
    const auto side_of = [&](const SectionCorner& corner) {
      return side(store_.vertex(corner), plane);
    };
    Sign inner = Sign::Zero;
    for (const SectionCorner& corner : store_.of(section)) {
      inner = side_of(corner);
      if (inner != Sign::Zero) break;
    }
    std::size_t beyond = 0;
    for (std::size_t other = crossings.begin + 1; other < crossings.end; ++other) {
      const std::span<const SectionCorner> corners = store_.of(crossings_[other].section);
      if (std::none_of(corners.begin(), corners.end(),
                       [&](const SectionCorner& corner) { return side_of(corner) == inner; })) {
        ++beyond;
      }
    }
    if (!best || beyond > most_beyond) {
      best = plane;
      most_beyond = beyond;
    }
    if (most_beyond == crossings.end - crossings.begin - 1) break;
  }
  if (!best) throw Error(ErrorId::InternalError, {"a section that is the whole", "a part"});
  return *best;
}

// As append_part leaves them. REQUIRES the signs of split, which said Both
std::array<CellEvaluator::Part, 2> CellEvaluator::halves(const Part& part, PlaneRef plane) {
  const CuttingPlane cut{plane, signs_};
  const auto crossed =
      append_crossings(scene_.geometry, facet_->polygon.plane.plane, part.polygon, cut, store_);
  std::array<Part, 2> result;
  for (const Sign kept : {Sign::Positive, Sign::Negative}) {
    Part& half = result[kept == Sign::Positive ? 0 : 1];
    half = {append_part(part.polygon, cut, kept, crossed, store_), part.share / 2};
  }
  return result;
}

// Down the local form of the mesh that comes first.
void CellEvaluator::descend(Part part, LocalPlace front, LocalPlace behind, Crossings crossings) {
  const PlaneRef own = facet_->polygon.plane.plane;
  while (!front.is_decided() || !behind.is_decided()) {
    // A node in the facet's own plane divides front from behind, not the part.
    if (!front.is_decided() && nodes_[front.node()].plane == own) {
      front = nodes_[front.node()].positive;
      continue;
    }
    if (!behind.is_decided() && nodes_[behind.node()].plane == own) {
      behind = nodes_[behind.node()].negative;
      continue;
    }
    const LocalPlace place = front.is_decided() ? behind : front;
    const LocalNode& node = nodes_[place.node()];
    const auto follow = [&](LocalPlace at, bool positive) {
      if (!(at == place)) return at;
      return positive ? node.positive : node.negative;
    };
    const PlaneSplit side = split(part.polygon, node.plane);
    if (side == PlaneSplit::Both) {
      in_general_position_ = false;
      const auto [positive, negative] = halves(part, node.plane);
      forget_whole(positive.polygon, store_);
      forget_whole(negative.polygon, store_);
      descend(positive, follow(front, true), follow(behind, true), crossings);
      descend(negative, follow(front, false), follow(behind, false), crossings);
      return;
    }
    const bool positive = side == PlaneSplit::AllPositive;
    const LocalPlace next_front = follow(front, positive);
    behind = follow(behind, positive);
    front = next_front;
  }
  const PrimitiveIndex primitive = local(crossings_[crossings.begin]).primitive;
  const BothSides sides{front.membership(), behind.membership()};
  if (is_left_to(primitive, sides)) return;
  truth_.change(primitive, sides);
  classify(part, {crossings.begin + 1, crossings.end});
  truth_.change(primitive, {});
}

void CellEvaluator::decide(PrimitiveIndex primitive, const BothSides& sides) {
  truth_.change(primitive, sides);
  decided_.push_back(primitive);
}

void CellEvaluator::undo_decisions(std::size_t count) {
  while (decided_.size() > count) {
    truth_.change(decided_.back(), {});
    decided_.pop_back();
  }
}

void CellEvaluator::emit(const CornerRun& polygon, std::uint64_t share, signed char outward) {
  const OrientedPlaneRef own = facet_->polygon.plane;
  if (share == facet_share::whole) {
    result_->add({own.plane, outward}, own.sense, facet_->facet, share, {});
    return;
  }
  result_->begin({own.plane, outward}, own.sense, facet_->facet, share);
  for (const SectionCorner& corner : store_.of(polygon)) {
    result_->add_corner(store_.vertex(corner.vertex), corner.side_plane);
  }
}

void CellEvaluator::emit_remainder(const Part& part, const CornerRun& section,
                                   signed char outward) {
  const OrientedPlaneRef own = facet_->polygon.plane;
  const Remainder remainder(part.polygon, section, store_);
  const std::size_t regions = remainder.is_ring() ? 1 : remainder.loop_count();
  std::uint64_t share = part.share / 2;
  for (std::size_t i = 0; i < remainder.loop_count(); ++i) {
    if (i + 1 < regions) share /= 2;  // the last two regions have the same
    loop_.clear();
    remainder.append_loop(i, loop_);
    const bool is_hole = i >= regions;
    result_->begin({own.plane, outward}, own.sense, facet_->facet, is_hole ? 0 : share, is_hole);
    for (const LoopCorner& corner : loop_) {
      result_->add_corner(store_.vertex(corner.vertex), corner.side_plane);
    }
  }
}

}  // namespace exactcsg
