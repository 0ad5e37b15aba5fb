// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Two-dimensional geometry of OpenSCAD's planar nodes, exact, and the solids made from it.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "exactcsg/io/mesh/solid_of_mesh.hpp"
#include "exactcsg/planar/figure.hpp"
#include "exactcsg/solid/solid.hpp"

namespace exactcsg::io {

using exactcsg::PlanarFigure;
using exactcsg::PlanarTree;
using exactcsg::Point2;

// x -> M x + t: {{M00, M01, t0}, {M10, M11, t1}}.
struct AffineMap2 {
  std::array<std::array<Rational, 3>, 2> m;
};
PlanarTree apply(const AffineMap2& map, const PlanarTree& tree);  // singular maps give Empty

// The outline of the regularised set as simple loops, outer counter-clockwise, holes clockwise, no
// two touching except at vertices of both; collinear vertices removed unless another part of the
// outline touches there. [Exact]
// THROWS Error(UnboundedSolid) if the set is unbounded (Full, say).
// COST: that of outline_of (exactcsg/planar/outline.hpp).
PlanarFigure resolve(const PlanarTree& tree);

// The same of the set that closed paths with a direction wind round: where their winding number is
// not 0. Counter-clockwise counts 1; parts of a path where it turns back on itself count nothing.
// [Exact] COST: as resolve.
PlanarFigure resolve_winding(const std::vector<std::vector<Point2>>& paths);

// Convex, pairwise interior-disjoint polygons (counter-clockwise) that cover the figure;
// conforming: their union's boundary vertices are the vertices of resolve(figure), and no other
// vertex is used. [Exact]
std::vector<std::vector<Point2>> convex_parts(const PlanarFigure& figure);

// Counter-clockwise vertices of the convex hull; fewer than three: empty interior. [Exact]
std::vector<Point2> hull(const PlanarTree& tree);

struct LinearExtrusion {
  Rational lower, upper;                // z range
  std::array<Rational, 2> scale{1, 1};  // of the top, if there are no levels
  // One entry a level above the bottom, ascending and evenly spaced up to `upper`: how level j of s
  // is turned and then scaled (its own scale counts, not the one above). Empty: no twist (one
  // slice). The unit directions (cosine, sine) are rounded doubles made exact.
  struct Level {
    Rational cosine, sine;
    std::array<Rational, 2> scale;
  };
  std::vector<Level> levels;
};

// Without twist and scale: the tree itself with every figure as a prism (no Boolean is evaluated in
// two dimensions). Otherwise the resolved outline's swept mesh, one for each connected component,
// quadrilaterals split along the shorter diagonal in xy as OpenSCAD does; scale 0 ends in an apex
// or a ridge. Empty if lower >= upper.
//
// THROWS Error(BadArgument) for a negative scale, or a scale of 0 below the top; and, without a
// rule for the inside, Error(SelfIntersectingMesh) if the twist of a slice makes the sides cross.
Solid linear_extrude(const PlanarTree& tree, const LinearExtrusion& extrusion,
                     const InsideRule& inside = {});

// The outline turned about the z axis through the given directions, one per ring: its point (x, y)
// becomes (|x| u, y) for the direction u. The directions go once round at most, in either sense;
// `closed` joins the last ring to the first. One primitive for each connected component. Empty if
// two rings are all there is and they lie in one plane.
//
// THROWS Error(BadArgument) if the outline lies on both sides of x = 0, or if the directions turn
// back or go round more than once.
Solid rotate_extrude(const PlanarTree& tree, std::span<const std::array<Rational, 2>> directions,
                     bool closed);

// The convex hull of points, as one primitive; Empty if they are all in one plane. [Exact]
Solid hull(std::span<const Point3> points);

// The convex hull of a solid: of the primitives' vertices where it is a union of bounded
// primitives, otherwise of the vertices of its evaluated boundary.
Solid hull(const Solid& solid);

}  // namespace exactcsg::io
