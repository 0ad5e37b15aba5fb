// SPDX-License-Identifier: Apache-2.0
#pragma once

// The vertices of a boundary: exact positions in lexicographic order. Internal to the evaluator.
// [Exact]

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "exactcsg/number/exact_points.hpp"
#include "exactcsg/number/geometry.hpp"
#include "exactcsg/solid/vertex_row.hpp"

namespace exactcsg {

struct OrderedVertices {
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

  ExactPoints exact;
  std::vector<std::array<double, 3>> nearest;  // doubles
  std::vector<std::uint32_t> number;           // of each vertex given; none: not wanted
};

// LAW order.1  exact[number[v]] is the position of vertex v, if that is wanted, and
// nearest[number[v]] its coordinates rounded to nearest. LAW order.2  the exact positions are
// ascending. REQUIRES one `is_wanted` for each vertex; the positions of those that are wanted
// differ. COST: O(n log n) doubles; exact comparisons only of coordinates that have the same
// nearest double.
OrderedVertices ordered_vertices(const Geometry& geometry, const VertexRow& vertices,
                                 std::span<const unsigned char> is_wanted, unsigned threads);

}  // namespace exactcsg
