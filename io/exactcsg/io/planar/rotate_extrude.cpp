// SPDX-License-Identifier: GPL-3.0-or-later

// Why every quadrilateral is planar: the point (x, y) of the outline becomes (x u, y) for a ring's
// direction u, so two sides of the quadrilateral between rings u and v are multiples of v - u.

#include <algorithm>
#include <utility>

#include "exactcsg/io/planar/outline.hpp"
#include "exactcsg/io/planar/substitute.hpp"

namespace exactcsg::io {

namespace {

using Direction = std::array<Rational, 2>;

Sign turn(const Direction& a, const Direction& b) { return sign_of(cmp(a[0] * b[1], a[1] * b[0])); }

// The directions counter-clockwise, or nothing if they do not enclose any angle.
// THROWS Error(BadArgument) unless they go once round at most, to one side.
std::vector<Direction> counter_clockwise(std::span<const Direction> given, bool closed) {
  std::vector<Direction> directions(given.begin(), given.end());
  if (directions.size() < 2) return {};
  Sign side = turn(directions[0], directions[1]);
  if (side == Sign::Zero) {
    if (directions.size() == 2) return {};
    throw Error(ErrorId::BadArgument, {"a step of half a turn, or of none, between rings", ""});
  }
  if (side == Sign::Negative) {
    std::reverse(directions.begin(), directions.end());
    // A closed sequence starts anywhere; keep the first ring first.
    if (closed) std::rotate(directions.begin(), directions.end() - 1, directions.end());
  }
  // The angle from the first direction, in halves of the turn.
  const Direction& zero = directions[0];
  const auto second_half = [&](const Direction& d) {
    const Sign s = turn(zero, d);
    return s == Sign::Negative || (s == Sign::Zero && zero[0] * d[0] + zero[1] * d[1] < 0);
  };
  const auto angle_less = [&](const Direction& a, const Direction& b) {
    if (second_half(a) != second_half(b)) return second_half(b);
    return turn(a, b) == Sign::Positive;
  };
  bool once_round = true;
  for (std::size_t i = 0; i + 1 < directions.size(); ++i) {
    once_round = once_round && angle_less(directions[i], directions[i + 1]) &&
                 turn(directions[i], directions[i + 1]) == Sign::Positive;
  }
  if (closed) once_round = once_round && turn(directions.back(), zero) == Sign::Positive;
  if (!once_round) {
    throw Error(ErrorId::BadArgument,
                {"rings that do not go once round the axis, to one side", ""});
  }
  return directions;
}

bool strictly_convex_directions(const std::vector<Direction>& directions) {
  std::vector<Point2> polygon;
  for (const Direction& d : directions) polygon.push_back({d[0], d[1]});
  const auto convex = strictly_convex(polygon);
  return convex && convex->size() == directions.size();
}

class Revolution {
 public:
  Revolution(const Outline& outline, const OutlineComponent& component,
             const std::vector<Direction>& directions, bool closed)
      : outline_(outline), component_(component), directions_(directions), closed_(closed) {
    number_vertices();
  }

  Solid solid() {
    const bool convex = is_convex();
    for (const PlanarLoop& loop : component_.loops) {
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const std::uint32_t a = loop[i];
        const std::uint32_t b = loop[(i + 1) % loop.size()];
        if (convex && outline_.points[a].y == outline_.points[b].y) {
          add_disc(a, b);
        } else {
          add_band(a, b);
        }
      }
    }
    if (!closed_) add_ends();
    // The outline turned by different angles meets itself on the axis only: nothing can cross.
    if (convex) return Solid::primitive({make_convex_polytope_unchecked(polyhedron_)});
    return Solid::primitive({make_mesh_unchecked(std::move(polyhedron_))});
  }

 private:
  bool on_axis(std::uint32_t v) const { return outline_.points[v].x == 0; }

  void number_vertices() {
    first_.resize(outline_.points.size(), 0);
    std::vector<bool> seen(outline_.points.size());
    for (const PlanarLoop& loop : component_.loops) {
      for (const std::uint32_t v : loop) {
        if (seen[v]) continue;
        seen[v] = true;
        first_[v] = static_cast<std::uint32_t>(polyhedron_.vertices.size());
        const Point2& p = outline_.points[v];
        if (on_axis(v)) {
          polyhedron_.vertices.push_back({0, 0, p.y});
          continue;
        }
        for (const Direction& d : directions_) {
          polyhedron_.vertices.push_back({p.x * d[0], p.x * d[1], p.y});
        }
      }
    }
  }

  std::uint32_t vertex(std::uint32_t v, std::size_t ring) const {
    return on_axis(v) ? first_[v] : first_[v] + static_cast<std::uint32_t>(ring);
  }

  // A convex outline whose lowest and highest points lie on the axis, turned once round through a
  // convex polygon: the radius is a concave function of the height.
  bool is_convex() const {
    if (!closed_ || !component_.convex || !strictly_convex_directions(directions_)) return false;
    std::vector<Rational> heights;
    std::vector<Rational> axis_heights;
    for (const std::uint32_t v : component_.loops[0]) {
      heights.push_back(outline_.points[v].y);
      if (on_axis(v)) axis_heights.push_back(outline_.points[v].y);
    }
    const auto range = [](const std::vector<Rational>& values) {
      const auto [low, high] = std::minmax_element(values.begin(), values.end());
      return std::pair(*low, *high);
    };
    return axis_heights.size() == 2 && range(axis_heights) == range(heights);
  }

  // The outline has the set on its left; seen along the direction of turning, x to the left.
  void add_band(std::uint32_t a, std::uint32_t b) {
    if (on_axis(a) && on_axis(b)) return;
    const std::size_t rings = directions_.size();
    for (std::size_t i = 0; i + (closed_ ? 0 : 1) < rings; ++i) {
      const std::size_t next = (i + 1) % rings;
      Facet facet{vertex(a, i)};
      if (!on_axis(a)) facet.push_back(vertex(a, next));
      facet.push_back(vertex(b, next));
      if (!on_axis(b)) facet.push_back(vertex(b, i));
      polyhedron_.facets.push_back(std::move(facet));
    }
  }

  void add_disc(std::uint32_t a, std::uint32_t b) {
    const std::size_t rings = directions_.size();
    Facet facet;
    for (std::size_t i = 0; i < rings; ++i) {
      facet.push_back(on_axis(a) ? vertex(b, rings - 1 - i) : vertex(a, i));
    }
    polyhedron_.facets.push_back(std::move(facet));
  }

  void add_ends() {
    const std::size_t last = directions_.size() - 1;
    for (const PlanarLoop& part : convex_parts(outline_, component_)) {
      Facet start;
      Facet end;
      for (const std::uint32_t v : part) start.push_back(vertex(v, 0));
      for (auto v = part.rbegin(); v != part.rend(); ++v) end.push_back(vertex(*v, last));
      polyhedron_.facets.push_back(std::move(start));
      polyhedron_.facets.push_back(std::move(end));
    }
  }

  const Outline& outline_;
  const OutlineComponent& component_;
  const std::vector<Direction>& directions_;
  bool closed_;
  Polyhedron polyhedron_;
  std::vector<std::uint32_t> first_;  // vertex of a point of the outline on the first ring
};

}  // namespace

Solid rotate_extrude(const PlanarTree& tree, std::span<const std::array<Rational, 2>> directions,
                     bool closed) {
  const std::vector<Direction> rings = counter_clockwise(directions, closed);
  if (rings.empty()) return Solid::empty();
  Outline outline = outline_of(tree);
  bool left = false;
  bool right = false;
  for (const Point2& p : outline.points) {
    left = left || p.x < 0;
    right = right || p.x > 0;
  }
  if (left && right) {
    throw Error(ErrorId::BadArgument,
                {"an outline on both sides of the axis x = 0", "all x >= 0, or all x <= 0"});
  }
  if (left) {
    for (Point2& p : outline.points) p.x = -p.x;
    for (OutlineComponent& component : outline.components) {
      for (PlanarLoop& loop : component.loops) std::reverse(loop.begin(), loop.end());
    }
  }
  std::vector<Solid> members;
  for (const OutlineComponent& component : outline.components) {
    members.push_back(Revolution(outline, component, rings, closed).solid());
  }
  return unite_all(std::move(members));
}

}  // namespace exactcsg::io
