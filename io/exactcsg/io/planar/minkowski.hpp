// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Minkowski sums of planar sets and of solids: { a + b : a in A, b in B }. [Exact]
//
// Convex operands: the hull of the sums of their vertices. A union is taken apart, because the sum
// distributes over it. Of any other solid no convex decomposition is made. It is enough to move its
// surface, since for a connected B and any b0 in B
//
//     A + B  =  (A + b0)  or  (surface of A + B):
//
// join b to b0 by a path in B; if x = a + b is not in A + b0, then x minus the path begins in A and
// ends outside it, so it crosses the surface. Used for A, and for the surface of A in the role of
// B, this leaves translated operands, and hulls of sums of one convex piece of a face with a
// polytope or with another such piece.
//
// LAW minkowski.1  commutative and associative; (A or B) + C = (A + C) or (B + C).
// LAW minkowski.2  with a convex polytope and its own multiples: P + t P = (1 + t) P, t >= 0.
// REQUIRES non-empty operands; the sum with an empty set is empty.
// Source: the convolution argument behind L. Guibas, L. Ramshaw and J. Stolfi (1983).

#include "exactcsg/io/planar/planar.hpp"

namespace exactcsg::io {

// No sum may ask for hulls of more points than this, all of them together.
constexpr std::size_t minkowski_point_limit = 20'000'000;

// THROWS Error(UnboundedSolid | TooLarge)
// COST: the union of the hulls of all pairs of convex parts.
PlanarTree minkowski_sum(const PlanarTree& a, const PlanarTree& b);

// THROWS Error(UnboundedSolid | TooLarge)
// COST: an evaluation of every operand that is no union of polytopes; a hull for each pair of
// convex parts, or of pieces of faces with them.
Solid minkowski_sum(const Solid& a, const Solid& b);

}  // namespace exactcsg::io
