// SPDX-License-Identifier: Apache-2.0
#pragma once

// Finds planes that coincide. Private to number/. [Exact]

#include <cstdint>
#include <vector>

#include "exactcsg/number/plane_table.hpp"
#include "exactcsg/number/prepared_plane.hpp"

namespace exactcsg {

PlaneKey key_of(const ApproximatePlane& plane);

struct PlaneClass {
  std::uint32_t first = 0;  // the plane of the class that was added first
  signed char sense = 1;    // of this plane relative to that one
};

// For each added plane its class. LAW coincidence.1  two planes have the same `first` iff they are
// the same point set. Exact coefficients are computed only where doubles cannot tell planes apart.
std::vector<PlaneClass> coincidence_classes(AddedPlanes& planes, const PointTable& points,
                                            unsigned threads = 1);

}  // namespace exactcsg
