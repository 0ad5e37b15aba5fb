// SPDX-License-Identifier: Apache-2.0
#pragma once

// Lines given as the meeting lines of two planes, and equal lines found among many. [Exact]

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "exactcsg/number/geometry.hpp"
#include "exactcsg/solid/vertex_row.hpp"

namespace exactcsg {

// REQUIRES the planes meet in a line, on which the two (different) vertices lie.
struct LineSample {
  PlaneRef first;
  PlaneRef second;         // first < second
  std::uint32_t from = 0;  // numbers of vertices
  std::uint32_t to = 0;
};

struct InternedLines {
  std::vector<std::uint32_t> number;  // of each sample given
  std::vector<LineSample> distinct;   // by number
};

// LAW lines.1  number[i] == number[j] iff samples i and j lie on one line.
// COST: O(n log n) doubles; exact only where certified keys overlap.
InternedLines intern(const Geometry& geometry, const VertexRow& vertices,
                     std::span<const LineSample> samples, TierStatistics& statistics,
                     unsigned threads = 1);

// An axis along which positions on the line certainly differ; nullopt where doubles cannot tell.
std::optional<Axis> axis_along(const Geometry& geometry, const LineSample& line);

}  // namespace exactcsg
