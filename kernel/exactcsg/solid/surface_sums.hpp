// SPDX-License-Identifier: Apache-2.0
#pragma once

// Sums over the faces of a boundary from which volume, area and centre of mass follow. Internal to
// measures. [Certified]
//
// A loop v_0 ... v_n of a face is the fan of the triangles v_0, v_i, v_(i+1), signed: their cross
// products add up to the doubled vector area, and v_0 . (cross product) to six times the volume
// (divergence theorem, cones from the origin).

#include <array>
#include <cstdint>
#include <optional>

#include "exactcsg/solid/measures.hpp"
#include "exactcsg/solid/scaled_vertices.hpp"

namespace exactcsg {

// |true - value| <= error
struct Bounded {
  Integer value = 0;
  Integer error = 0;
};

// In powers of the vertices' unit, with ScaledVertices::origin as the origin.
struct SurfaceSums {
  Bounded six_volumes;
  Bounded two_areas;  // in parts of 2^-area_shift
  mp_bitcnt_t area_shift = 0;
  std::array<Bounded, 3> moments;  // 24 times the integral of the coordinate over the solid
};

// LAW sums.1  the errors of volume and moments are 0 if the vertices are exact, and that of the
// area is if it is an integer then. LAW sums.2  a root is off by at most 2^-bits times the larger
// of it and of the largest coordinate, `bits` at most 120 in short_surface_sums. COST: O(sides)
// products of integers as long as the coordinates
SurfaceSums long_surface_sums(const Boundary& boundary, const ScaledVertices& vertices,
                              Wanted wanted, int bits);
// The same by integers of fixed width: nullopt if the coordinates have more than two limbs, or 120
// bits of the roots are not enough. LAW sums.3  volume and moments are those of long_surface_sums.
std::optional<SurfaceSums> short_surface_sums(const Boundary& boundary,
                                              const ScaledVertices& vertices, Wanted wanted,
                                              int bits);

// For both: the errors that cut coordinates cause, added.
void add_errors_of_vertices(SurfaceSums& sums, const ScaledVertices& vertices, std::uint64_t sides);

}  // namespace exactcsg
