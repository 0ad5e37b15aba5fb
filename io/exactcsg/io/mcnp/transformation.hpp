// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Transformations: TRn cards, and the lists in parentheses of TRCL and FILL. [Exact]
//
// O1 O2 O3 B1 ... B9 M: the rows (B1 B2 B3), (B4 B5 B6), (B7 B8 B9) are the axes x', y', z' of the
// auxiliary system in the main one; of a card with a star they are angles in degrees, of which the
// cosines are taken. With M = 1 (the default) O is the origin of the auxiliary system in the main
// one, with -1 that of the main system in the auxiliary one.
//
// LAW transformation.1  the linear part is orthogonal, exactly. It is the matrix as written if that
//                       is (quarter turns, 0.6 and 0.8). Otherwise is_rounded: the rows are
//                       normalised one after another, and rounded to an exactly orthogonal matrix
//                       within 1e-15.

#include "exactcsg/io/mcnp/deck.hpp"
#include "exactcsg/number/point.hpp"

namespace exactcsg::io::mcnp {

struct Transformation {
  AffineMap to_main;  // from the auxiliary system
  bool is_rounded = false;
};

// THROWS Error(WrongCount | BadArgument | NumberOutOfRange); Error(UnsupportedNode) of matrices of
// 3 or 5 numbers. REQUIRES entries are not empty.
Transformation transformation_of(const Card& card, const std::vector<Entry>& entries,
                                 bool is_in_degrees);

}  // namespace exactcsg::io::mcnp
