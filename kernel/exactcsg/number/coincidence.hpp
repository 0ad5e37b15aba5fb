// SPDX-License-Identifier: Apache-2.0
#pragma once

// Finds planes that coincide. Private to number/. [Exact]

#include <cstdint>
#include <vector>

#include "exactcsg/number/plane_table.hpp"

namespace exactcsg {

// A number of a plane that depends neither on its scale nor on its sense, between two bounds:
// planes whose enclosures are disjoint are different. [Certified]
struct PlaneKey {
  double lower;
  double upper;
};
PlaneKey key_of(const ApproximatePlane& plane);

struct PlaneClass {
  std::uint32_t first = 0;  // the plane of the class that was added first
  signed char sense = 1;    // of this plane relative to that one
};

// For each added plane its class. LAW coincidence.1  two planes have the same `first` iff they are
// the same point set. Exact coefficients are computed only where doubles cannot tell planes apart.
std::vector<PlaneClass> coincidence_classes(AddedPlanes& planes, const PointTable& points);

}  // namespace exactcsg
