// SPDX-License-Identifier: Apache-2.0
// The winding number of a mesh is 0 in front of every facet and 1 behind it.
//
// Across an edge of two facets the winding number in front is the same, so one facet of each
// manifold-connected part decides for all. From a point of it a ray runs along a coordinate axis,
// to the facet's front, and the facets that it passes are counted with their signs.

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "exactcsg/solid/box_pairs.hpp"
#include "exactcsg/solid/polyhedron_check.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg {

namespace {

using Index = std::uint32_t;

// The sign of the normal's component along the axis: Zero for a facet that is upright.
Sign upward(const PolyhedronSigns& signs, CoordinateIndex axis, const FacetFrame& frame) {
  const auto [a, b, c] = frame.corners;
  return axis == frame.dropped ? frame.sign : signs.turn(axis, a, b, c);
}

enum class Shadow { Off, On, Edge };

// Where a point lies in the projection of a convex facet along the axis.
Shadow shadow(const PolyhedronSigns& signs, CoordinateIndex axis, const Facet& facet, Sign up,
              Index point) {
  for (std::size_t k = 0; k < facet.size(); ++k) {
    const Sign turn = signs.turn(axis, facet[k], facet[(k + 1) % facet.size()], point) * up;
    if (turn == Sign::Negative) return Shadow::Off;
    if (turn == Sign::Zero) return Shadow::Edge;
  }
  return Shadow::On;
}

// The winding number in front of facet f from a point of it; nullopt if the ray meets an edge.
std::optional<int> winding_in_front(const Polyhedron& polyhedron, const PolyhedronSigns& signs,
                                    const std::vector<FacetFrame>& frames,
                                    const BoxHierarchy& hierarchy, Index f, Index point) {
  const CoordinateIndex axis = frames[f].dropped;
  const Sign direction = frames[f].sign;
  DoubleBox ray{signs.approximate(point), signs.approximate(point)};
  for (std::size_t i = 0; i < 3; ++i) {
    ray.lower[i] -= 2 * signs.coordinate_error();
    ray.upper[i] += 2 * signs.coordinate_error();
  }
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (direction == Sign::Positive) {
    ray.upper[axis] = infinity;
  } else {
    ray.lower[axis] = -infinity;
  }
  std::optional<int> winding = 0;
  hierarchy.for_each_meeting(ray, [&](Index g) {
    if (g == f || !winding) return;
    const Sign up = upward(signs, axis, frames[g]);
    // An upright facet is met in its outline only, which is seen at its neighbours.
    if (up == Sign::Zero) return;
    const Shadow where = shadow(signs, axis, polyhedron.facets[g], up, point);
    if (where == Shadow::Off) return;
    const auto [a, b, c] = frames[g].corners;
    // Positive: the point is above the facet if it faces up, else below.
    const Sign above = signs.orientation(a, b, c, point) * up;
    if (above == direction) return;
    if (where == Shadow::Edge || above == Sign::Zero) {
      winding.reset();
      return;
    }
    *winding += static_cast<int>(up * direction);
  });
  return winding;
}

}  // namespace

std::vector<std::uint32_t> manifold_parts(const Polyhedron& polyhedron,
                                          const std::vector<HalfEdge>& edges,
                                          const std::function<bool(std::uint32_t)>& usable) {
  std::vector<Index> parent(polyhedron.facets.size());
  std::iota(parent.begin(), parent.end(), 0U);
  const auto find = [&](Index f) {
    while (parent[f] != f) f = parent[f] = parent[parent[f]];
    return f;
  };
  for (std::size_t k = 0; k < edges.size();) {
    std::size_t end = k + 1;
    while (end < edges.size() && edges[end].low == edges[k].low &&
           edges[end].high == edges[k].high) {
      ++end;
    }
    const bool joins = end == k + 2 && usable(edges[k].facet) && usable(edges[k + 1].facet);
    if (joins) parent[find(edges[k].facet)] = find(edges[k + 1].facet);
    k = end;
  }
  for (Index f = 0; f < parent.size(); ++f) parent[f] = find(f);
  return parent;
}

void check_winding(const Polyhedron& polyhedron, PolyhedronSigns& signs,
                   const std::vector<FacetFrame>& frames, const std::vector<HalfEdge>& edges,
                   const BoxHierarchy& hierarchy) {
  const std::vector<Index> part = manifold_parts(polyhedron, edges, [](Index) { return true; });
  std::vector<bool> decided(polyhedron.facets.size(), false);
  constexpr unsigned attempts = 64;
  for (Index f = 0; f < polyhedron.facets.size(); ++f) {
    if (decided[part[f]]) continue;
    const auto [a, b, c] = frames[f].corners;
    std::optional<int> winding;
    for (unsigned k = 0; !winding && k < attempts; ++k) {
      // Other weights at each attempt, without a pattern that a regular mesh could follow.
      const std::array<std::pair<Index, unsigned>, 3> weights{
          {{a, 97 + 31 * k}, {b, 101 + 17 * k * k}, {c, 89 + 7 * k * k * k}}};
      winding = winding_in_front(polyhedron, signs, frames, hierarchy, f, signs.add_mean(weights));
    }
    if (!winding) {
      throw Error(ErrorId::InternalError,
                  {"no ray in general position from " + describe_facet(polyhedron, f),
                   "one in 64 attempts"});
    }
    if (*winding != 0) {
      throw Error(ErrorId::InvertedMesh,
                  {"winding number " + std::to_string(*winding) + " in front of " +
                       describe_facet(polyhedron, f),
                   "outer shells that face outwards, shells of cavities that face inwards"});
    }
    decided[part[f]] = true;
  }
}

}  // namespace exactcsg
