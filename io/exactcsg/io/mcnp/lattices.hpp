// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The lattice that a lattice cell is an element of. [Exact]
//
// The sides of the cell are in pairs of opposite ones, in the order of its card: across the first
// is the element (1, 0, 0), across the second (-1, 0, 0), then (0, 1, 0) and (0, -1, 0). Of LAT = 1
// the third pair, if there is one, is that of (0, 0, 1). Of LAT = 2 it is that of (-1, 1, 0), and a
// fourth that of (0, 0, 1).
//
// LAW lattice_plan.1  with p' = frame(p), element (i, j, k) has in the lattice's coordinates the
//                     sides of the cell, moved; its universe's coordinates are inverse(frame)(q +
//                     centre) for q relative to the element's centre.
// Hexagons that are not the image of regular ones under a stretch along x or y are replaced by such
// of the same lattice, with a warning that says how far a corner moves.

#include <functional>

#include "exactcsg/io/mcnp/cells.hpp"
#include "exactcsg/io/openmc/model.hpp"

namespace exactcsg::io::mcnp {

// {x : normal x <= offset} is the side of the cell.
struct Wall {
  domain::Coordinates<3> normal;
  Rational offset;
};

using Ranges = std::array<std::array<std::int64_t, 2>, 3>;

struct LatticePlan {
  openmc::Lattice lattice;  // without elements
  std::size_t element_count = 0;
  AffineMap frame = AffineMap::identity();  // from the cell's coordinates to the lattice's
  domain::Coordinates<3> centre;            // of element (0, 0, 0), in the lattice's coordinates
  std::function<std::size_t(const std::array<std::int64_t, 3>&)> index_of;  // in elements
};

// Without ranges: of the one element (0, 0, 0).
// THROWS Error(WrongCount | BadArgument | UnsupportedNode | TooLarge) at the card
LatticePlan plan_lattice(const CellCard& cell, std::vector<Wall> walls,
                         std::vector<Warning>& warnings);

}  // namespace exactcsg::io::mcnp
