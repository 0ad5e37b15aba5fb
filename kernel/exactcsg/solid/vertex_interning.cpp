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

// Every meeting point, and of each input point, of which there are many copies, the first one.
struct Candidates {
  std::vector<std::uint32_t> items;
  std::vector<std::uint32_t> first_of_point;  // by id; none: the point does not occur
  static constexpr std::uint32_t none = ~std::uint32_t{0};
};

Candidates candidates_of(const Geometry& geometry, std::span<const Vertex* const> vertices) {
  Candidates result;
  result.first_of_point.assign(geometry.point_count(), Candidates::none);
  for (std::uint32_t i = 0; i < vertices.size(); ++i) {
    if (vertices[i]->is_point) {
      std::uint32_t& first = result.first_of_point[static_cast<std::uint32_t>(vertices[i]->point)];
      if (first != Candidates::none) continue;
      first = i;
    }
    result.items.push_back(i);
  }
  return result;
}

}  // namespace

InternedVertices intern(const Geometry& geometry, std::span<const Vertex* const> vertices,
                        TierStatistics& statistics) {
  InternedVertices result;
  result.number.resize(vertices.size());
  const Candidates candidates = candidates_of(geometry, vertices);
  std::vector<KeyInterval> keys;
  keys.reserve(candidates.items.size());
  for (const std::uint32_t i : candidates.items) keys.push_back(key_of(*vertices[i], i));
  for_each_cluster(keys, [&](std::span<const KeyInterval> cluster) {
    const std::size_t first = result.distinct.size();
    for (const KeyInterval& key : cluster) {
      const Vertex& vertex = *vertices[key.item];
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
      result.number[key.item] = static_cast<std::uint32_t>(known - result.distinct.begin());
      if (known == result.distinct.end()) {
        result.distinct.push_back(vertex);
      } else if (vertex.is_point && !known->is_point) {
        *known = vertex;
      }
    }
  });
  for (std::uint32_t i = 0; i < vertices.size(); ++i) {
    if (!vertices[i]->is_point) continue;
    const auto id = static_cast<std::uint32_t>(vertices[i]->point);
    result.number[i] = result.number[candidates.first_of_point[id]];
  }
  return result;
}

}  // namespace exactcsg
