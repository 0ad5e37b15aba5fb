// SPDX-License-Identifier: Apache-2.0
#pragma once

// Many vertices, by number: of input points only the id is kept, four bytes for each. Internal to
// the evaluator. [Exact]
//
// LAW vertex_row.1  row[i] is the vertex that was added as number i.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "exactcsg/number/geometry.hpp"
#include "exactcsg/support/in_parallel.hpp"

namespace exactcsg {

// Refers to the geometry, which must outlive it. REQUIRES fewer than 2^31 points and meeting points
class VertexRow {
 public:
  explicit VertexRow(const Geometry& geometry) : geometry_(&geometry) {}
  VertexRow(const Geometry& geometry, std::span<const Vertex> vertices) : VertexRow(geometry) {
    for (const Vertex& vertex : vertices) push_back(vertex);
  }

  std::size_t size() const { return places_.size(); }
  bool empty() const { return places_.empty(); }
  bool is_point(std::size_t i) const { return (places_[i] & meeting) == 0; }
  // REQUIRES is_point(i)
  PointId point(std::size_t i) const { return PointId{places_[i]}; }
  Vertex operator[](std::size_t i) const {
    return is_point(i) ? geometry_->vertex(point(i)) : meeting_points_[places_[i] & ~meeting];
  }
  // Asks for what [i] reads before it is wanted.
  void prefetch_place(std::size_t i) const { __builtin_prefetch(&places_[i]); }
  void prefetch(std::size_t i) const {
    if (is_point(i)) {
      __builtin_prefetch(&geometry_->approximate(point(i)));
    } else {
      const Vertex* const vertex = &meeting_points_[places_[i] & ~meeting];
      __builtin_prefetch(vertex);
      __builtin_prefetch(reinterpret_cast<const char*>(vertex + 1) - 1);
    }
  }

  void push_back(const Vertex& vertex) {
    if (vertex.is_point) {
      places_.push_back(static_cast<std::uint32_t>(vertex.point));
    } else {
      places_.push_back(static_cast<std::uint32_t>(meeting_points_.size()) | meeting);
      meeting_points_.push_back(vertex);
    }
  }

  // How many vertices, and how many of these are meeting points.
  struct Counts {
    std::size_t vertices = 0;
    std::size_t meeting_points = 0;
  };
  // Room for vertices that several threads may set() then, each once.
  void grow(unsigned threads, const Counts& more) {
    resize(threads, places_, places_.size() + more.vertices);
    resize(threads, meeting_points_, meeting_points_.size() + more.meeting_points);
  }
  // Sets the vertex at `next`, which goes on to the place behind it.
  void set(const Vertex& vertex, Counts& next) {
    if (vertex.is_point) {
      places_[next.vertices++] = static_cast<std::uint32_t>(vertex.point);
    } else {
      places_[next.vertices++] = static_cast<std::uint32_t>(next.meeting_points) | meeting;
      meeting_points_[next.meeting_points++] = vertex;
    }
  }

 private:
  static constexpr std::uint32_t meeting = std::uint32_t{1} << 31U;

  const Geometry* geometry_;
  std::vector<std::uint32_t> places_;  // an id, or a place in meeting_points_ with the bit
  std::vector<Vertex> meeting_points_;
};

}  // namespace exactcsg
