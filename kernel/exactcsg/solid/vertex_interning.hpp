// SPDX-License-Identifier: Apache-2.0
#pragma once

// Equal positions found among many vertices: one number for each distinct exact position. [Exact]

#include <cstdint>
#include <span>
#include <vector>

#include "exactcsg/number/geometry.hpp"

namespace exactcsg {

// An interval of keys that cannot be told apart from others that overlap it.
struct KeyInterval {
  double lower = 0;
  double upper = 0;
  std::uint32_t item = 0;
};

// Sorts by lower ends and calls visit(span of intervals) for each maximal run that is connected by
// overlaps. Intervals that are not finite form a run with everything.
template <class Visit>
void for_each_cluster(std::vector<KeyInterval>& intervals, Visit visit);

struct InternedVertices {
  std::vector<std::uint32_t> number;  // of each vertex given
  std::vector<Vertex> distinct;       // by number; an input point where one is among the equals
};

// LAW interning.1  number[i] == number[j] iff vertices i and j have equal exact positions.
// COST: O(n log n) doubles; exact only where certified positions overlap.
InternedVertices intern(const Geometry& geometry, std::span<const Vertex* const> vertices,
                        TierStatistics& statistics);

}  // namespace exactcsg

#include "exactcsg/solid/vertex_interning.inl"
