// SPDX-License-Identifier: Apache-2.0
#pragma once

// The exact planar evaluator: from a CSG tree of figures to the outline of the regularised set,
// split into its connected pieces. [Exact]
//
// The same method as the solid evaluator's, in two dimensions: the plane is divided into cells
// (an instance of skeleton::divacon), each with the edges that reach it and the tree pruned to it.
// A cell whose tree is a constant, or one convex figure, ends early; one with few edges is
// evaluated by two-sided classification: edges are cut where others meet them, and a piece is
// boundary if the tree's values to its left and to its right differ.
//
// LAW outline.1  points are distinct; a loop is simple, has the set on its left, and its first loop
// is the outer one (counter-clockwise), the others are holes (clockwise).
// LAW outline.2  the components' interiors are connected and pairwise disjoint; two loops, of one
// component or of two, meet in points of both only.
// LAW outline.3  a point where a loop goes straight on is kept only if another part of the outline
// touches it there.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "exactcsg/planar/figure.hpp"
#include "exactcsg/support/progress.hpp"

namespace exactcsg {

using PlanarLoop = std::vector<std::uint32_t>;  // indices of Outline::points

struct OutlineComponent {
  std::vector<PlanarLoop> loops;
  bool convex = false;  // one loop, strictly convex
};

struct Outline {
  std::vector<Point2> points;
  std::vector<OutlineComponent> components;
};

struct OutlineOptions {
  std::size_t edges_per_cell = 8;  // cells with at most so many edges are evaluated
  Progress* progress = nullptr;    // advanced and asked for cancellation, if given
};

// THROWS Error(UnboundedSolid) if the set is unbounded, Error(TooLarge) if the tree has more than
// csg::default_node_limit occurrences of nodes, and what Progress throws.
// COST: of n edges, O(n log n) in practice plus the square of the edges of every cell that is
// evaluated: divisions separate all edges but those that share a point. Cells that the tree makes
// all inside or all outside are not looked into, whatever crosses there. One node of a tree costs
// as much as one edge.
Outline outline_of(const PlanarTree& tree, const OutlineOptions& options = {});
Outline outline_of(const PlanarFigure& figure);

}  // namespace exactcsg
