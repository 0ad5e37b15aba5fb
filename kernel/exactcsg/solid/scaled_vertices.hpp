// SPDX-License-Identifier: Apache-2.0
#pragma once

// The vertices of a boundary as non-negative integers: exact where all coordinates have one short
// common denominator, else cut to a grid. [Certified]

#include <array>
#include <cstdint>
#include <vector>

#include "exactcsg/number/point.hpp"
#include "exactcsg/solid/boundary.hpp"

namespace exactcsg {

// LAW scaled.1  vertex v is origin + unit * (coordinates(v) + e), each e in [0, 1), and 0 if exact
// LAW scaled.2  0 <= coordinates(v) <= largest < 2^(60 width - 2)
struct ScaledVertices {
  std::size_t width = 1;         // limbs of a coordinate, few bits of which are not needed
  std::vector<mp_limb_t> limbs;  // by vertex and axis, the lowest first
  Integer largest;
  Point3 origin{0, 0, 0};
  Rational unit;
  bool exact = false;

  const mp_limb_t* of(std::uint32_t vertex) const { return limbs.data() + 3 * width * vertex; }
};

// Sets the three integers. COST: no allocation, if they have room
void set_coordinates(std::array<Integer, 3>& result, const ScaledVertices& vertices,
                     std::uint32_t vertex);

// `bits`: the number of bits of the largest coordinate, about, if a grid is needed.
// COST: O(vertices) integer divisions of the length of the input
ScaledVertices scale_vertices(const Boundary& boundary, int bits);

struct CoordinateRange {
  Rational lowest;
  Rational highest;
};

// The least and the greatest of the vertices' coordinates along an axis (0 ... 2).
// REQUIRES a vertex. COST: O(vertices) comparisons of doubles
CoordinateRange coordinate_range(const Boundary& boundary, std::size_t axis);

// Whether scale_vertices is exact, without a grid.
bool has_short_common_denominator(const Boundary& boundary);

}  // namespace exactcsg
