// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// A planar set grown or shrunk by a distance, as OpenSCAD's offset() means it.
//
// With the set's outline walked with the set on its left, every edge sweeps a rectangle to its
// right (distance > 0) or to its left (< 0), and every vertex that the rectangles leave a gap at
// sweeps the corner that `OffsetCorner` says. Growing is the union of the set, the rectangles and
// the corners; shrinking is the set less all of them. That is what the Clipper library, which
// OpenSCAD calls, means by its winding numbers; but here no coordinate is cut to a grid and the
// Booleans are exact.
//
// [Exact] given the displacement of each edge, its unit normal times the distance. That is exact
// where the edge's length is rational; elsewhere the normal is rounded to doubles, which moves the
// displaced edge, still exactly parallel, by at most 2^-50 times the distance. Vertices of arcs and
// chamfers are off by at most 2^-47 times the distance.
//
// LAW offset.1  grown by 0 a set is itself.
// LAW offset.2  with Sharp corners and rational edge lengths, growing a convex polygon by d and
// then by e is growing it by d + e.
// Source: A. Johnson, Clipper 6.4.2 (how many pieces an arc has, where it begins); OpenSCAD
// 2021.01, src/GeometryEvaluator.cc and src/clipper-utils.cc (its arguments).

#include "exactcsg/io/planar/planar.hpp"

namespace exactcsg::io {

enum class OffsetCorner : unsigned char {
  Round,    // an arc
  Sharp,    // the displaced edges are prolonged until they meet
  Chamfer,  // cut square, at the distance of the corner's bisector
};

struct Offset {
  Rational distance;
  OffsetCorner corner = OffsetCorner::Round;
  double arc_tolerance = 0.01;  // how far a piece of an arc may be from its circle
};

struct OffsetResult {
  PlanarFigure figure;  // resolved
  // How far a displaced vertex may be from the one meant by irrational normals.
  Rational rounding{0};
};

// THROWS Error(UnboundedSolid | TooLarge)
// COST: that of resolving a union of two figures for each edge of the outline.
OffsetResult offset(const PlanarTree& tree, const Offset& parameters);

}  // namespace exactcsg::io
