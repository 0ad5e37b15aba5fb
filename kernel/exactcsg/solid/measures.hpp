// SPDX-License-Identifier: Apache-2.0
#pragma once

// Volume, area, centre of mass and bounding box of a solid, from its canonical boundary.
// Exact where the value is a rational of moderate length, Certified enclosures always.

#include <array>
#include <optional>

#include "exactcsg/number/enclosure.hpp"
#include "exactcsg/solid/boundary.hpp"

namespace exactcsg {

// The exact volume, unless its numerator or denominator (or a common denominator needed on the way)
// exceeds `bit_limit` bits: then nullopt, found out before the work is done. [Exact]
std::optional<Rational> exact_volume(const Boundary& boundary, std::size_t bit_limit = 1U << 22U);

// The exact area, if it is rational and within the limit as above. It is rational only if every
// face has a normal of rational length, since square roots of different squarefree numbers do not
// cancel. [Exact]
std::optional<Rational> exact_area(const Boundary& boundary, std::size_t bit_limit = 1U << 22U);

// The exact centre of mass, within the limit as above. [Exact]
// THROWS Error(EmptySolid) if the boundary is empty.
std::optional<Point3> exact_centroid(const Boundary& boundary, std::size_t bit_limit = 1U << 22U);

// Enclosures computed with `bits` of working precision. [Certified]
// LAW measures.1  the widths are below 2^(8 - bits) times the volume, surface and side of a cube
// round the solid, respectively (the centroid's: as long as the volume is not tiny against that).
// LAW measures.2  if all coordinates have a common denominator of at most 512 bits, the enclosures
// of volume and centroid are single points, and that of the area is if it is rational.
// COST: O(edges) products of integers of about `bits` bits
Enclosure enclose_volume(const Boundary& boundary, int bits);
Enclosure enclose_area(const Boundary& boundary, int bits);
// THROWS Error(EmptySolid) if the boundary is empty.
std::array<Enclosure, 3> enclose_centroid(const Boundary& boundary, int bits);

// Everything: the centre of mass too.
enum class Wanted { VolumeAndArea, Everything };

// All of them at the price of one.
struct MeasureEnclosures {
  Enclosure volume;
  Enclosure area;
  std::optional<std::array<Enclosure, 3>> centroid;  // nullopt: empty, or not wanted
};
MeasureEnclosures enclose_measures(const Boundary& boundary, int bits,
                                   Wanted wanted = Wanted::Everything);

struct BoundingBox {
  Point3 lower;
  Point3 upper;
};
std::optional<BoundingBox> bounding_box(const Boundary& boundary);  // nullopt: empty

}  // namespace exactcsg
