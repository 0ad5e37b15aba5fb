// SPDX-License-Identifier: GPL-3.0-or-later

// Convex decomposition after Hertel and Mehlhorn, "Fast triangulation of simple polygons" (1983):
// from a triangulation, drop every diagonal that both its ends can spare. At most four times as
// many parts as the fewest possible.

#include <unordered_map>

#include "exactcsg/io/planar/constrained_triangulation.hpp"
#include "exactcsg/io/planar/exact_kernel.hpp"
#include "exactcsg/io/planar/outline.hpp"

namespace exactcsg::io {

namespace {

constexpr std::uint32_t none = ~std::uint32_t{0};

struct Side {
  std::uint32_t origin;
  std::uint32_t next;
  std::uint32_t previous;
  std::uint32_t opposite = none;
};

std::vector<Side> sides_of(const std::vector<TriangleIndices>& triangles) {
  std::vector<Side> sides;
  std::unordered_map<std::uint64_t, std::uint32_t> open;
  const auto key = [](std::uint64_t from, std::uint64_t to) { return (from << 32U) | to; };
  for (const TriangleIndices& triangle : triangles) {
    const auto first = static_cast<std::uint32_t>(sides.size());
    for (std::uint32_t i = 0; i < 3; ++i) {
      sides.push_back({triangle[i], first + (i + 1) % 3, first + (i + 2) % 3});
      const std::uint32_t to = triangle[(i + 1) % 3];
      if (const auto other = open.find(key(to, triangle[i])); other != open.end()) {
        sides[first + i].opposite = other->second;
        sides[other->second].opposite = first + i;
      } else {
        open.emplace(key(triangle[i], to), first + i);
      }
    }
  }
  return sides;
}

}  // namespace

std::vector<PlanarLoop> convex_parts(const Outline& outline, const OutlineComponent& component) {
  if (component.convex) return component.loops;
  // The component's points under numbers of their own: an outline may have many components.
  std::vector<PlanarLoop> loops = component.loops;
  std::vector<std::uint32_t> used;
  std::vector<Point2> coordinates;
  std::unordered_map<std::uint32_t, std::uint32_t> number;
  for (PlanarLoop& loop : loops) {
    for (std::uint32_t& v : loop) {
      const auto [at, added] = number.try_emplace(v, static_cast<std::uint32_t>(used.size()));
      if (added) {
        used.push_back(v);
        coordinates.push_back(outline.points[v]);
      }
      v = at->second;
    }
  }
  std::vector<ExactPoint2> points;
  for (const Point2& p : coordinates) points.push_back(exact_point(p));
  std::vector<Side> sides = sides_of(triangulate_loops(loops, coordinates));
  const auto origin_point = [&](std::uint32_t side) -> const ExactPoint2& {
    return points[sides[side].origin];
  };
  // Strictly convex at the origin of `side` once `side` and its opposite are gone.
  const auto spares = [&](std::uint32_t side) {
    const std::uint32_t after = sides[sides[side].opposite].next;  // leaves the same vertex
    return CGAL::left_turn(origin_point(sides[side].previous), origin_point(side),
                           origin_point(sides[after].next));
  };
  std::vector<bool> dropped(sides.size());
  for (std::uint32_t side = 0; side < sides.size(); ++side) {
    const std::uint32_t opposite = sides[side].opposite;
    if (opposite == none || dropped[side] || !spares(side) || !spares(opposite)) continue;
    const auto join = [&](std::uint32_t from, std::uint32_t to) {
      sides[from].next = to;
      sides[to].previous = from;
    };
    join(sides[side].previous, sides[opposite].next);
    join(sides[opposite].previous, sides[side].next);
    dropped[side] = dropped[opposite] = true;
  }
  std::vector<PlanarLoop> parts;
  for (std::uint32_t start = 0; start < sides.size(); ++start) {
    if (dropped[start]) continue;
    PlanarLoop& part = parts.emplace_back();
    for (std::uint32_t side = start; !dropped[side]; side = sides[side].next) {
      dropped[side] = true;
      part.push_back(used[sides[side].origin]);
    }
  }
  return parts;
}

std::vector<std::vector<Point2>> convex_parts(const PlanarFigure& figure) {
  const Outline outline = outline_of(figure);
  std::vector<std::vector<Point2>> result;
  for (const OutlineComponent& component : outline.components) {
    for (const PlanarLoop& part : convex_parts(outline, component)) {
      auto& polygon = result.emplace_back();
      for (const std::uint32_t v : part) polygon.push_back(outline.points[v]);
    }
  }
  return result;
}

}  // namespace exactcsg::io
