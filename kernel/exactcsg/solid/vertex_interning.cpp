// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/vertex_interning.hpp"

#include <algorithm>
#include <cmath>

namespace exactcsg {

namespace {

bool same_representation(const Vertex& v, const Vertex& w) {
  if (v.is_point != w.is_point) return false;
  if (v.is_point) return v.point == w.point;
  return std::equal(std::begin(v.planes), std::end(v.planes), std::begin(w.planes));
}

bool may_coincide(const Vertex& v, const Vertex& w) {
  const double reach = (v.error + w.error) * (1 + 0x1p-50);
  return !(std::abs(v.x - w.x) > reach || std::abs(v.y - w.y) > reach ||
           std::abs(v.z - w.z) > reach);
}

// A linear form in general position: different vertices of a model hardly ever have equal keys.
KeyInterval key_of(const Vertex& v, std::uint32_t item) {
  constexpr double alpha = 0.8414709848078965;
  constexpr double beta = 0.5403023058681398;
  constexpr double gamma = 0.2955202066613396;
  const double key = alpha * v.x + beta * v.y + gamma * v.z;
  // The coefficients sum to less than 1.68; three products and two sums round by at most
  // 4u (|x| + |y| + |z|) with u = 2^-53; doubled.
  const double spread =
      1.7 * v.error + 0x1p-50 * (std::abs(v.x) + std::abs(v.y) + std::abs(v.z)) + 0x1p-1000;
  return {key - spread, key + spread, item};
}

}  // namespace

InternedVertices intern(const Geometry& geometry, const CornerVertices& vertices,
                        TierStatistics& statistics) {
  const auto meeting_points = static_cast<std::uint32_t>(vertices.meeting_points.size());
  InternedVertices result;
  result.number_of_meeting_point.resize(meeting_points);
  result.number_of_point.resize(vertices.has_point.size());
  // Items below `meeting_points` are these, the others are points.
  std::vector<KeyInterval> keys;
  const auto occurring = [](const auto& items, auto absent) {
    return items.size() - static_cast<std::size_t>(std::count(items.begin(), items.end(), absent));
  };
  keys.reserve(occurring(vertices.meeting_points, nullptr) + occurring(vertices.has_point, false));
  for (std::uint32_t i = 0; i < meeting_points; ++i) {
    if (vertices.meeting_points[i] != nullptr)
      keys.push_back(key_of(*vertices.meeting_points[i], i));
  }
  for (std::uint32_t id = 0; id < vertices.has_point.size(); ++id) {
    if (!vertices.has_point[id]) continue;
    keys.push_back(key_of(geometry.vertex(PointId{id}), meeting_points + id));
  }
  result.distinct.reserve(keys.size());
  for_each_cluster(keys, [&](std::span<const KeyInterval> cluster) {
    const std::size_t first = result.distinct.size();
    for (const KeyInterval& key : cluster) {
      const bool is_point = key.item >= meeting_points;
      const Vertex vertex = is_point ? geometry.vertex(PointId{key.item - meeting_points})
                                     : *vertices.meeting_points[key.item];
      const auto find = [&](auto same) {
        return std::find_if(result.distinct.begin() + static_cast<std::ptrdiff_t>(first),
                            result.distinct.end(), same);
      };
      auto known = find([&](const Vertex& other) { return same_representation(vertex, other); });
      if (known == result.distinct.end()) {
        known = find([&](const Vertex& other) {
          return may_coincide(vertex, other) && geometry.same_position(vertex, other, statistics);
        });
      }
      const auto number = static_cast<std::uint32_t>(known - result.distinct.begin());
      if (is_point) {
        result.number_of_point[key.item - meeting_points] = number;
      } else {
        result.number_of_meeting_point[key.item] = number;
      }
      if (known == result.distinct.end()) {
        result.distinct.push_back(vertex);
      } else if (is_point && !known->is_point) {
        *known = vertex;
      }
    }
  });
  return result;
}

}  // namespace exactcsg
