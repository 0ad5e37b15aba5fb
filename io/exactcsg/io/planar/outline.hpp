// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The outline of a regularised planar set, split into its connected pieces. [Exact]
//
// LAW outline.1  points are distinct; a loop is simple, has the set on its left, and its first loop
// is the outer one (counter-clockwise), the others are holes (clockwise).
// LAW outline.2  the components' interiors are connected and pairwise disjoint; two loops, of one
// component or of two, meet in points of both only.
// LAW outline.3  a point where a loop goes straight on is kept only if another part of the outline
// touches it there.

#include <cstdint>
#include <optional>
#include <vector>

#include "exactcsg/io/planar/planar.hpp"

namespace exactcsg::io {

using PlanarLoop = std::vector<std::uint32_t>;  // indices of Outline::points

struct OutlineComponent {
  std::vector<PlanarLoop> loops;
  bool convex = false;  // one loop, strictly convex
};

struct Outline {
  std::vector<Point2> points;
  std::vector<OutlineComponent> components;
};

// THROWS Error(UnboundedSolid) if the set is unbounded.
// COST: O((n + k) log n) for n edges that meet k times (a sweep), plus the tree once per cell in
// the worst case, in practice a few nodes per cell.
Outline outline_of(const PlanarTree& tree);
Outline outline_of(const PlanarFigure& figure);

// Convex polygons of the component's points, counter-clockwise, interior-disjoint, strictly convex
// at every vertex; every edge of the component's loops is an edge of one of them, every other edge
// of two. COST: O(n log n) expected.
std::vector<PlanarLoop> convex_parts(const Outline& outline, const OutlineComponent& component);

// Counter-clockwise vertices if the closed path is, after its repeated and straight-on vertices are
// dropped, a strictly convex polygon. Dropping them changes nothing: they bound no area.
std::optional<std::vector<Point2>> strictly_convex(const std::vector<Point2>& path);

}  // namespace exactcsg::io
