// SPDX-License-Identifier: Apache-2.0
// The checked constructor of convex polytopes from facets.
//
// A closed surface whose edges are all convex bounds a convex polytope if a point lies strictly
// inside of every facet's plane and one ray from it through the interior of a facet meets no other
// facet (K. Mehlhorn et al., "Checking geometric programs or verification of geometric structures",
// Computational Geometry 12, 1999, section 2). O(edges) signs instead of vertices times facets.

#include <algorithm>
#include <numeric>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>

#include "exactcsg/solid/polyhedron_check.hpp"
#include "exactcsg/solid/primitive.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg {

namespace {

using Index = std::uint32_t;

[[noreturn]] void refuse(const Polyhedron& polyhedron, std::size_t facet, const std::string& why) {
  throw Error(ErrorId::NotConvex,
              {describe_facet(polyhedron, facet) + ", " + why, "the boundary of a convex set"});
}

// Four vertices that are not in one plane.
std::array<Index, 4> independent_vertices(const Polyhedron& polyhedron,
                                          const PolyhedronSigns& signs,
                                          const std::vector<FacetFrame>& frames) {
  const auto [a, b, c] = frames.front().corners;
  for (Index v = 0; v < polyhedron.vertices.size(); ++v) {
    if (v == a || v == b || v == c) continue;
    if (signs.orientation(a, b, c, v) != Sign::Zero) return {a, b, c, v};
  }
  throw Error(ErrorId::FlatPolytope,
              {"all vertices in the plane of " + describe_facet(polyhedron, 0), "a solid"});
}

void require_outward(const Polyhedron& polyhedron, const PolyhedronSigns& signs) {
  const Sign volume = signs.volume(triangles_of(polyhedron));
  if (volume == Sign::Positive) return;
  if (volume == Sign::Zero) refuse(polyhedron, 0, "in a surface that encloses no volume");
  throw Error(ErrorId::InvertedMesh,
              {"a negative volume; " + describe_facet(polyhedron, 0) + " is the first one",
               "facets counter-clockwise seen from outside"});
}

// Disjoint sets of facets.
class FacetGroups {
 public:
  explicit FacetGroups(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }
  Index find(Index f) {
    while (parent_[f] != f) f = parent_[f] = parent_[parent_[f]];
    return f;
  }
  // The smaller number becomes the group's name: the result keeps the facets' order.
  void join(Index f, Index g) {
    f = find(f);
    g = find(g);
    parent_[std::max(f, g)] = std::min(f, g);
  }

 private:
  std::vector<Index> parent_;
};

// Joins coplanar neighbours; refuses edges that are not convex.
FacetGroups check_edges(const Polyhedron& polyhedron, const PolyhedronSigns& signs,
                        const std::vector<FacetFrame>& frames, const std::vector<HalfEdge>& edges) {
  FacetGroups groups(polyhedron.facets.size());
  for (std::size_t k = 0; k + 1 < edges.size(); k += 2) {
    const HalfEdge& e = edges[k];
    const HalfEdge& opposite = edges[k + 1];
    const bool again =
        k + 2 < edges.size() && edges[k + 2].low == e.low && edges[k + 2].high == e.high;
    if (again) {
      refuse(polyhedron, e.facet,
             "whose edge from " + describe(polyhedron.vertices[e.low]) + " to " +
                 describe(polyhedron.vertices[e.high]) + " carries more than two facets");
    }
    const auto [a, b, c] = frames[e.facet].corners;
    const auto [p, q, r] = frames[opposite.facet].corners;
    // The neighbour lies in one half-plane from the edge on: its strongest sign tells.
    Sign sign = Sign::Zero;
    for (const Index v : {p, q, r}) {
      if (v == e.low || v == e.high || v == a || v == b || v == c) continue;
      sign = signs.orientation(a, b, c, v);
      if (sign != Sign::Zero) break;
    }
    const bool folded =
        sign == Sign::Zero && signs.turn(frames[e.facet].dropped, p, q, r) != frames[e.facet].sign;
    if (sign == Sign::Positive || folded) {
      refuse(polyhedron, e.facet,
             "over which " + describe_facet(polyhedron, opposite.facet) + " rises");
    }
    if (sign == Sign::Zero) groups.join(e.facet, opposite.facet);
  }
  return groups;
}

// The point is strictly inside of all planes, and the ray from it through the middle of facet 0
// meets facet 0 only.
void check_star(const Polyhedron& polyhedron, PolyhedronSigns& signs,
                const std::vector<FacetFrame>& frames, const std::array<Index, 4>& simplex) {
  const auto [a, b, c, d] = simplex;
  const Index inside = signs.add_mean(
      std::array<std::pair<Index, unsigned>, 4>{{{a, 1U}, {b, 1U}, {c, 1U}, {d, 1U}}});
  // Unequal weights keep the ray off the symmetries of common input.
  const auto [p, q, r] = frames.front().corners;
  const Index target =
      signs.add_mean(std::array<std::pair<Index, unsigned>, 3>{{{p, 5U}, {q, 7U}, {r, 11U}}});
  for (Index f = 0; f < polyhedron.facets.size(); ++f) {
    const auto [x, y, z] = frames[f].corners;
    if (signs.orientation(x, y, z, inside) != Sign::Negative) {
      refuse(polyhedron, f, "outside of which other vertices lie");
    }
    if (f == 0) continue;
    const Facet& facet = polyhedron.facets[f];
    bool met = true;
    for (std::size_t k = 0; met && k < facet.size(); ++k) {
      met = signs.orientation(inside, facet[k], facet[(k + 1) % facet.size()], target) !=
            Sign::Negative;
    }
    if (met) refuse(polyhedron, f, "behind which lies " + describe_facet(polyhedron, 0));
  }
}

Facet without_straight_vertices(const PolyhedronSigns& signs, const Facet& facet) {
  Facet corners;
  for (std::size_t k = 0; k < facet.size(); ++k) {
    const Index before = corners.empty() ? facet.back() : corners.back();
    const Index after = facet[(k + 1) % facet.size()];
    if (!signs.collinear(before, facet[k], after)) corners.push_back(facet[k]);
  }
  return corners;
}

// The outlines of groups of coplanar facets: the directed edges whose opposite is in no facet of
// the group. After check_star each group is one convex polygon.
std::vector<Facet> outlines(const Polyhedron& polyhedron, const PolyhedronSigns& signs,
                            const std::vector<HalfEdge>& edges, FacetGroups& groups) {
  std::vector<std::unordered_map<Index, Index>> next(polyhedron.facets.size());
  for (std::size_t k = 0; k + 1 < edges.size(); k += 2) {
    const Index f = groups.find(edges[k].facet);
    const Index g = groups.find(edges[k + 1].facet);
    if (f == g) continue;
    for (const HalfEdge& e : {edges[k], edges[k + 1]}) {
      next[e.facet == edges[k].facet ? f : g][e.ascending ? e.low : e.high] =
          e.ascending ? e.high : e.low;
    }
  }
  std::vector<Facet> facets;
  for (Index f = 0; f < polyhedron.facets.size(); ++f) {
    if (next[f].empty()) continue;
    const Index start = std::min_element(next[f].begin(), next[f].end())->first;
    Facet loop;
    Index v = start;
    do {
      loop.push_back(v);
      const auto found = next[f].find(v);
      if (found == next[f].end() || loop.size() > next[f].size()) {
        refuse(polyhedron, f, "whose coplanar neighbours do not form a convex polygon");
      }
      v = found->second;
    } while (v != start);
    facets.push_back(without_straight_vertices(signs, loop));
  }
  return facets;
}

}  // namespace

ConvexPolytope make_convex_polytope(Polyhedron polyhedron) {
  polyhedron = with_distinct_vertices(std::move(polyhedron));
  PolyhedronSigns signs(polyhedron.vertices);
  const std::vector<FacetFrame> frames = check_facets(polyhedron, signs);
  const std::vector<HalfEdge> edges = half_edges(polyhedron);
  check_closed(polyhedron, edges);
  const std::array<Index, 4> simplex = independent_vertices(polyhedron, signs, frames);
  require_outward(polyhedron, signs);
  FacetGroups groups = check_edges(polyhedron, signs, frames, edges);
  check_star(polyhedron, signs, frames, simplex);
  polyhedron.facets = outlines(polyhedron, signs, edges, groups);
  return make_convex_polytope_unchecked(with_distinct_vertices(std::move(polyhedron)));
}

}  // namespace exactcsg
