// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/planar/cell_evaluation.hpp"

#include <algorithm>
#include <limits>

#include "exactcsg/csg/boolean_operator.hpp"
#include "exactcsg/csg/traverse.hpp"

namespace exactcsg::planar {

namespace {

using csg::BooleanOperator;
using csg::Membership;

PieceEnd end_of(const ClipEnd& clip, PointIndex point) {
  PieceEnd end;
  if (clip.wall) {
    end.kind = PieceEnd::Kind::Wall;
    end.wall = *clip.wall;
    end.along = clip.along;
  } else {
    end.kind = PieceEnd::Kind::Point;
    end.first = point;
  }
  return end;
}

bool are_apart(const ClippedEdge& a, const ClippedEdge& b) {
  return a.upper[0] < b.lower[0] || b.upper[0] < a.lower[0] || a.upper[1] < b.lower[1] ||
         b.upper[1] < a.lower[1];
}

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

}  // namespace

CellEvaluator::CellEvaluator(const Scene& scene)
    : scene_(scene),
      number_of_(scene.segment_count(), none),
      left_(scene.figures().size(), 0),
      right_(scene.figures().size(), 0) {}

void CellEvaluator::find_segments() {
  segments_.clear();
  next_.assign(cell_->edges.size(), none);
  for (std::uint32_t e = 0; e < cell_->edges.size(); ++e) {
    std::uint32_t& number = number_of_[scene_.edges()[cell_->edges[e].edge].segment];
    if (number == none) {
      number = static_cast<std::uint32_t>(segments_.size());
      segments_.push_back({e, e});
    } else {
      next_[segments_[number].last] = e;
      segments_[number].last = e;
    }
  }
  for (const ClippedEdge& edge : cell_->edges) number_of_[scene_.edges()[edge.edge].segment] = none;
}

void CellEvaluator::flip(std::vector<unsigned char>& sides, std::uint32_t i) const {
  for (std::uint32_t e = segments_[i].lowest; e != none; e = next_[e]) {
    sides[scene_.edges()[cell_->edges[e].edge].figure] ^= 1U;
  }
}

// The tree's value where the figures are inside or not as `sides` says.
bool CellEvaluator::is_inside(const std::vector<unsigned char>& sides) {
  return csg::traverse(
      cell_->tree, [&](FigureIndex figure) { return sides[figure] != 0; },
      [](bool a, BooleanOperator operation, bool b) {
        const auto membership = [](bool in) { return in ? Membership::In : Membership::Out; };
        return csg::combine(membership(a), operation, membership(b)) == Membership::In;
      },
      csg::FullEmptyResult{true, false},
      [](bool a, BooleanOperator operation) {
        return csg::absorbs(a ? Membership::In : Membership::Out, operation);
      },
      traverse_);
}

void CellEvaluator::emit_convex(const Cell& cell, std::vector<Piece>& pieces) {
  cell_ = &cell;
  const FigureIndex figure = cell.figures[0].figure;
  left_[figure] = 0;
  const bool outside = is_inside(left_);
  left_[figure] = 1;
  const bool inside = is_inside(left_);
  if (outside == inside) return;
  const bool left_is_inside = scene_.figures()[figure].shape == Shape::ConvexCounterClockwise;
  const bool forward = left_is_inside == inside;
  for (const ClippedEdge& clipped : cell.edges) {
    const Edge& edge = scene_.edges()[clipped.edge];
    Piece& piece = pieces.emplace_back();
    piece.edge = clipped.edge;
    piece.way = forward ? Sign::Positive : Sign::Negative;
    piece.start = end_of(clipped.from, edge.from);
    piece.end = end_of(clipped.to, edge.to);
    if (!forward) std::swap(piece.start, piece.end);
  }
}

void CellEvaluator::evaluate(const Cell& cell, std::vector<Piece>& pieces) {
  cell_ = &cell;
  find_segments();
  const auto count = static_cast<std::uint32_t>(segments_.size());
  if (events_.size() < count) events_.resize(count);
  for (std::uint32_t i = 0; i < count; ++i) events_[i].clear();
  for (std::uint32_t i = 0; i < count; ++i) {
    for (std::uint32_t j = i + 1; j < count; ++j) relate(i, j);
  }
  for (std::uint32_t i = 0; i < count; ++i) walk(i, pieces);
}

bool CellEvaluator::has_end(std::uint32_t i, PointIndex p) const {
  return data(i).from == p || data(i).to == p;
}

// What the edges are to each other in the interiors of both.
void CellEvaluator::relate(std::uint32_t i, std::uint32_t j) {
  if (are_apart(clipped(i), clipped(j))) return;
  const Edge& e = data(i);
  const Edge& g = data(j);
  const auto side = [&](std::uint32_t of, PointIndex p) {
    return has_end(of, p) ? Sign::Zero : scene_.orientation(edge_at(of), p);
  };
  const Sign from_side = side(i, g.from);
  const Sign to_side = side(i, g.to);
  if (from_side == to_side) {
    return from_side == Sign::Zero ? relate_collinear(i, j) : void();
  }
  if (from_side == Sign::Zero || to_side == Sign::Zero) {
    const bool at_from = from_side == Sign::Zero;
    if (has_end(i, at_from ? g.from : g.to)) return;
    const Sign a = side(j, e.from);
    if (a != Sign::Zero && a == side(j, e.to)) return;
    return add_touch(i, j, at_from, at_from ? to_side : from_side);
  }
  const Sign e_from_side = side(j, e.from);
  const Sign e_to_side = side(j, e.to);
  if (e_from_side == e_to_side) return;
  if (e_from_side == Sign::Zero) return add_touch(j, i, true, e_to_side);
  if (e_to_side == Sign::Zero) return add_touch(j, i, false, e_from_side);
  add_crossing(i, j);
}

void CellEvaluator::relate_collinear(std::uint32_t i, std::uint32_t j) {
  const auto add_ends = [&](std::uint32_t on, std::uint32_t of) {
    const Edge& e = data(on);
    const Edge& g = data(of);
    const std::size_t axis = e.long_axis;
    const ClippedEdge& part = clipped(of);
    for (const bool at_from : {true, false}) {
      const PointIndex p = at_from ? g.from : g.to;
      if ((at_from ? part.from : part.to).wall || has_end(on, p)) continue;
      if (scene_.compare(p, e.from, axis) == scene_.compare(p, e.to, axis)) continue;
      Event event;
      event.at = scene_.point(p)[axis];
      event.point = p;
      event.other = of;
      const bool same_direction = e.direction[axis] == g.direction[axis];
      if (edge_at(of) < edge_at(on)) event.cover = at_from == same_direction ? 1 : -1;
      events_[on].push_back(event);
    }
  };
  add_ends(i, j);
  add_ends(j, i);
}

// An end of j is in the interior of i.
void CellEvaluator::add_touch(std::uint32_t i, std::uint32_t j, bool at_from,
                              Sign side_of_other_end) {
  if ((at_from ? clipped(j).from : clipped(j).to).wall) return;  // not in this cell
  Event event;
  event.point = at_from ? data(j).from : data(j).to;
  event.at = scene_.point(*event.point)[data(i).long_axis];
  event.other = j;
  event.left = side_of_other_end == Sign::Positive;
  event.right = !event.left;
  events_[i].push_back(event);
}

void CellEvaluator::add_crossing(std::uint32_t i, std::uint32_t j) {
  const CertifiedPoint near = scene_.crossing(edge_at(i), edge_at(j));
  const bool whole = clipped(i).is_whole() && clipped(j).is_whole();
  if (!whole && !is_in_cell(i, j, near)) return;
  const auto add = [&](std::uint32_t on, std::uint32_t other) {
    Event event;
    event.at = near[data(on).long_axis];
    event.other = other;
    event.left = event.right = true;
    events_[on].push_back(event);
  };
  add(i, j);
  add(j, i);
}

// Walls are displaced upwards: a point at the lower one is not in the cell, one at the upper is.
bool CellEvaluator::is_in_cell(std::uint32_t i, std::uint32_t j, const CertifiedPoint& near) const {
  std::optional<Point2> exact;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto is_above = [&](double position) {
      if (const auto sign = certain_sign(near[axis] - CertifiedDouble{position, 0})) {
        return *sign == Sign::Positive;
      }
      if (!exact) exact = scene_.exact_crossing(edge_at(i), edge_at(j));
      return (axis == x_axis ? exact->x : exact->y) > Rational(position);
    };
    if (!is_above(cell_->lower[axis]) || is_above(cell_->upper[axis])) return false;
  }
  return true;
}

void CellEvaluator::reset_sides() {
  for (const CellFigure& figure : cell_->figures) {
    left_[figure.figure] = right_[figure.figure] = figure.corner_inside ? 1 : 0;
  }
}

CellEvaluator::Start CellEvaluator::start(std::uint32_t i) {
  if (clipped(i).from.wall) return start_at_wall(i, true);
  if (clipped(i).to.wall) return start_at_wall(i, false);
  return start_at_point(i);
}

// From the lower left corner along the walls to the edge's crossing.
CellEvaluator::Start CellEvaluator::start_at_wall(std::uint32_t i, bool at_from) {
  reset_sides();
  const ClipEnd& here = at_from ? clipped(i).from : clipped(i).to;
  const Wall& wall = *here.wall;
  const bool is_upper_wall = wall.position == cell_->upper[wall.axis];
  // The upper wall is reached along the lower wall of the other axis.
  const Wall base{1 - wall.axis, cell_->lower[1 - wall.axis]};
  Start start;
  start.way = at_from ? Sign::Positive : Sign::Negative;
  start.end = end_of(here, 0);
  // Going upwards along x = c, what lies before is to the right of an edge that goes on rightwards;
  // going rightwards along y = d, to the left of one that goes on upwards. From upper walls, edges
  // go the other way.
  const bool before_is_left = (wall.axis == y_axis) != is_upper_wall;
  auto& after = before_is_left ? right_ : left_;
  const auto count = static_cast<std::uint32_t>(segments_.size());
  for (std::uint32_t j = 0; j < count; ++j) {
    for (const ClipEnd* end : {&clipped(j).from, &clipped(j).to}) {
      if (!end->wall) continue;
      if (is_upper_wall && *end->wall == base) {
        flip(left_, j);
        flip(right_, j);
      } else if (*end->wall == wall) {
        const Sign order =
            j == i ? Sign::Zero
                   : scene_.order_at_wall(edge_at(j), end->along, edge_at(i), here.along, wall);
        if (order == Sign::Positive) continue;
        flip(after, j);
        if (order == Sign::Negative) {
          flip(before_is_left ? left_ : right_, j);
        } else if (edge_at(j) < edge_at(i)) {
          ++start.covering;
        }
      }
    }
  }
  return start;
}

// Where an edge crosses the lower wall of y, compared with p's x.
Sign CellEvaluator::compare_crossing(std::uint32_t i, const Wall& wall,
                                     const CertifiedDouble& along, PointIndex p) const {
  if (const auto sign = certain_sign(along - scene_.point(p)[x_axis])) return *sign;
  return sign_of(cmp(scene_.exact_at_wall(edge_at(i), wall), scene_.exact_point(p).x));
}

// From the lower left corner along the lower wall to just right of the edge's first point, upwards
// to just below it, and round it counter-clockwise to the edge.
CellEvaluator::Start CellEvaluator::start_at_point(std::uint32_t i) {
  reset_sides();
  const PointIndex p = data(i).from;
  Start start;
  start.end = end_of({}, p);
  const Wall base{y_axis, cell_->lower[y_axis]};
  const auto count = static_cast<std::uint32_t>(segments_.size());
  rays_.clear();
  for (std::uint32_t j = 0; j < count; ++j) {
    const ClippedEdge& part = clipped(j);
    const Edge& edge = data(j);
    const Sign x_way = edge.direction[x_axis];
    const Sign y_way = edge.direction[y_axis];
    bool crossed = false;
    // Along the base. A tie is crossed unless the edge leans to the right.
    std::optional<bool> crosses_base;
    for (const ClipEnd* end : {&part.from, &part.to}) {
      if (end->wall != base) continue;
      const Sign order = compare_crossing(j, base, end->along, p);
      crosses_base =
          order == Sign::Negative || (order == Sign::Zero && x_way * y_way != Sign::Positive);
    }
    if (crosses_base.value_or(false)) crossed = true;
    // Upwards.
    if (edge.from == p) {
      rays_.push_back({j, Sign::Positive});
    } else if (edge.to == p) {
      rays_.push_back({j, Sign::Negative});
    } else {
      const CertifiedPoint& near = scene_.point(p);
      const bool apart = part.lower[x_axis] > near[x_axis].upper() ||
                         part.upper[x_axis] < near[x_axis].lower() ||
                         part.lower[y_axis] > near[y_axis].upper();
      const Sign from_order = apart ? Sign::Zero : scene_.compare(edge.from, p, x_axis);
      const Sign to_order = apart ? Sign::Zero : scene_.compare(edge.to, p, x_axis);
      if (!apart && !(from_order == to_order && from_order != Sign::Zero)) {
        const Sign side = scene_.orientation(edge_at(j), p);
        if (side == Sign::Zero) {
          // In the interior, or beyond the ends.
          const std::size_t axis = edge.long_axis;
          if (scene_.compare(edge.from, p, axis) != scene_.compare(edge.to, p, axis)) {
            rays_.push_back({j, Sign::Positive});
            rays_.push_back({j, Sign::Negative});
          }
        } else {
          const bool spans = (from_order == Sign::Positive) != (to_order == Sign::Positive);
          const bool is_below = side == x_way;
          const bool is_above_base =
              !crosses_base || (x_way * y_way == Sign::Positive ? *crosses_base : !*crosses_base);
          if (spans && is_below && is_above_base) crossed = !crossed;
        }
      }
    }
    if (crossed) {
      flip(left_, j);
      flip(right_, j);
    }
  }
  // Rays by their angle, counter-clockwise, from just past straight down.
  const auto half = [&](const Ray& ray) {
    const Sign x = data(ray.segment).direction[x_axis] * ray.way;
    const Sign y = data(ray.segment).direction[y_axis] * ray.way;
    return x == Sign::Positive || (x == Sign::Zero && y == Sign::Positive) ? 0 : 1;
  };
  const Ray own{i, Sign::Positive};
  const int own_half = half(own);
  for (const Ray& ray : rays_) {
    Sign turn = Sign::Zero;  // of the edge from the ray, within the half
    if (ray.segment != i) {
      const int ray_half = half(ray);
      turn = ray_half != own_half ? (ray_half < own_half ? Sign::Positive : Sign::Negative)
                                  : scene_.turn(edge_at(ray.segment), edge_at(i)) * ray.way;
    }
    if (turn == Sign::Negative) continue;
    flip(left_, ray.segment);
    if (turn == Sign::Positive) {
      flip(right_, ray.segment);
    } else if (edge_at(ray.segment) < edge_at(i)) {
      ++start.covering;
    }
  }
  return start;
}

Rational CellEvaluator::exact_position(std::uint32_t i, const Event& event) const {
  const bool along_x = data(i).long_axis == x_axis;
  if (event.point) {
    const Point2& p = scene_.exact_point(*event.point);
    return along_x ? p.x : p.y;
  }
  Point2 p = scene_.exact_crossing(edge_at(i), edge_at(event.other));
  return along_x ? std::move(p.x) : std::move(p.y);
}

// Along the edge's long axis.
Sign CellEvaluator::order(std::uint32_t i, const Event& a, const Event& b) const {
  if (a.point && b.point) {
    return *a.point == *b.point ? Sign::Zero
                                : scene_.compare(*a.point, *b.point, data(i).long_axis);
  }
  if (const auto sign = certain_sign(a.at - b.at)) return *sign;
  if (!a.point && !b.point && a.other == b.other) return Sign::Zero;
  return sign_of(cmp(exact_position(i, a), exact_position(i, b)));
}

// The point where all of these happen.
PieceEnd CellEvaluator::name(std::uint32_t i, const Event* begin, const Event* end) const {
  PieceEnd result;
  for (const Event* event = begin; event != end; ++event) {
    if (!event->point) continue;
    result.first = *event->point;
    return result;
  }
  // Only crossings: of one line, under the number of its lowest edge, or of several.
  EdgeIndex other = edge_at(begin->other);
  result.kind = PieceEnd::Kind::Crossing;
  for (const Event* event = begin + 1; event != end; ++event) {
    const EdgeIndex edge = edge_at(event->other);
    if (scene_.turn(edge_at(begin->other), edge) != Sign::Zero) {
      result.kind = PieceEnd::Kind::SharedCrossing;
    }
    other = std::min(other, edge);
  }
  result.first = std::min(edge_at(i), other);
  result.second = std::max(edge_at(i), other);
  return result;
}

void CellEvaluator::walk(std::uint32_t i, std::vector<Piece>& pieces) {
  Start at = start(i);
  // Sides are those of the walker, who may go against the edge's direction.
  const bool forward = at.way == Sign::Positive;
  std::vector<Event>& events = events_[i];
  if (events.size() > 1) {
    const Sign ahead = data(i).direction[data(i).long_axis] * at.way;
    std::sort(events.begin(), events.end(), [&](const Event& a, const Event& b) {
      return order(i, a, b) * ahead == Sign::Negative;
    });
  }
  const auto emit_up_to = [&](const PieceEnd& end) {
    if (at.covering != 0) return;
    const bool left = is_inside(left_);
    const bool right = is_inside(right_);
    if (left == right) return;
    Piece& piece = pieces.emplace_back();
    piece.edge = edge_at(i);
    piece.way = left ? at.way : -at.way;
    piece.start = left ? at.end : end;
    piece.end = left ? end : at.end;
  };
  const Event* const last = events.data() + events.size();
  for (const Event* event = events.data(); event != last;) {
    const Event* next = event + 1;
    while (next != last && order(i, *event, *next) == Sign::Zero) ++next;
    const PieceEnd here = name(i, event, next);
    emit_up_to(here);
    for (; event != next; ++event) {
      if (forward ? event->left : event->right) flip(left_, event->other);
      if (forward ? event->right : event->left) flip(right_, event->other);
      at.covering += static_cast<std::uint32_t>(forward ? event->cover : -event->cover);
    }
    at.end = here;
  }
  emit_up_to(forward ? end_of(clipped(i).to, data(i).to) : end_of(clipped(i).from, data(i).from));
}

}  // namespace exactcsg::planar
