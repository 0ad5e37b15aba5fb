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

// Enclosures computed with `bits` of working precision. [Certified]
Enclosure enclose_volume(const Boundary& boundary, int bits);
Enclosure enclose_area(const Boundary& boundary, int bits);
// THROWS Error(EmptySolid) if the boundary is empty.
std::array<Enclosure, 3> enclose_centroid(const Boundary& boundary, int bits);

struct BoundingBox {
  Point3 lower;
  Point3 upper;
};
std::optional<BoundingBox> bounding_box(const Boundary& boundary);  // nullopt: empty

}  // namespace exactcsg
