// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The rounding that OpenSCAD 2021.01 itself does before and during its exact Booleans, so that its
// exact export (.nef3) can be compared with ours as equal rationals (docs/openscad.md).
//
// A solid is either a *soup*, polygons with double coordinates, or *exact*. Leaves, extrusions and
// hulls are soups; maps move soups in double. As soon as a soup becomes an operand it is cut to the
// grid: every coordinate v becomes int64(v / G) * G with G = 2^-20, a point within one cell of an
// earlier one of the same soup becomes that one, and a convex soup becomes the hull of its corners.
// From there on all is exact; maps are those with the double entries.
// A union (group, multmatrix, color, render, the file itself) with one operand that is not empty is
// no operation and leaves a soup as it is; the last soup is cut, as the export does it. Planar
// figures are double polygons until an operation with two or more children, a mirror or a polygon()
// sends them through the clipping library (clipping.hpp).
//
// What cannot be foretold without being OpenSCAD is refused (Error(UnsupportedNode)), never
// guessed: which diagonals its triangulation takes in a polygon that is no longer planar once it is
// cut.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "exactcsg/solid/solid.hpp"

namespace exactcsg::io::openscad {

using DoublePoint = std::array<double, 3>;

// A polygon with holes that OpenSCAD triangulates: the cap of an extrusion.
struct Cap {
  std::vector<std::vector<DoublePoint>> loops;
};

struct Soup {
  enum class Convexity : std::uint8_t { Known, Unknown };
  Convexity convexity = Convexity::Unknown;
  std::vector<Cap> caps;  // come before the polygons
  std::vector<std::vector<DoublePoint>> polygons;

  bool is_empty() const { return caps.empty() && polygons.empty(); }
};

// Row by row, as OpenSCAD's matrices of doubles.
using DoubleMap = std::array<std::array<double, 4>, 3>;
double determinant(const DoubleMap& map);

// In double, in the order of operations of a 4 x 4 matrix by column; facets turned if it mirrors.
Soup transformed(const DoubleMap& map, Soup soup);

// The soup's corners, each once, as they are cut where it becomes an operand.
std::vector<DoublePoint> cut_corners(const Soup& soup);

// The operand that the soup becomes. Empty if nothing of it is left.
// THROWS Error(UnsupportedNode) as said above, and what make_mesh throws.
Solid cut_to_grid(const Soup& soup);

}  // namespace exactcsg::io::openscad
