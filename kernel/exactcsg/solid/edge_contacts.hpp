// SPDX-License-Identifier: Apache-2.0
#pragma once

// Where edges touch that have no end in common: an end on another edge, or edges that cross.
// Internal to the evaluator. [Exact]

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "exactcsg/number/geometry.hpp"
#include "exactcsg/solid/vertex_row.hpp"
#include "exactcsg/support/progress.hpp"

namespace exactcsg {

// An edge between two vertices, given by their numbers.
struct EdgeSpan {
  static constexpr std::uint32_t no_primitive = std::numeric_limits<std::uint32_t>::max();

  std::array<PlaneRef, 2> planes;  // that it lies in; they meet in its line
  std::uint32_t line = 0;          // spans with the same number lie on one line
  std::uint32_t from = 0;
  std::uint32_t to = 0;
  std::uint32_t primitive = no_primitive;  // that it is an edge of, or a part of one
};

// A point that two spans, given by their places, have in common.
struct EdgeContact {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  Vertex point;
  std::optional<std::uint32_t> end;  // of one of them, if it is that; else it is in the middle
};

// LAW edge_contacts.1  the contacts of all pairs of spans that have neither their line's number nor
//                      a primitive nor an end's number in common, in an order that depends on the
//                      spans alone. Spans that overlap have no contact in these terms.
// REQUIRES vertices of different numbers have different positions; spans are sorted by primitive,
//          those of none last
// COST: expected O((n + pairs whose boxes meet) log n)
std::vector<EdgeContact> edge_contacts(const Geometry& geometry, const VertexRow& vertices,
                                       std::span<const EdgeSpan> spans, TierStatistics& statistics,
                                       unsigned threads, Progress* progress);

// Finds vertices by their exact positions.
class VertexFinder {
 public:
  // COST: O(n log n)
  VertexFinder(const Geometry& geometry, const VertexRow& vertices);
  // The number of a vertex that has the point's position: always the same one of them.
  // REQUIRES the same vertices, perhaps with more behind them, which are not looked at
  // COST: O(log n + vertices of nearly the same x)
  std::optional<std::uint32_t> find(const Vertex& point, const VertexRow& vertices,
                                    TierStatistics& statistics) const;

 private:
  const Geometry& geometry_;
  std::vector<std::uint32_t> by_x_;
  double widest_error_ = 0;
};

}  // namespace exactcsg
