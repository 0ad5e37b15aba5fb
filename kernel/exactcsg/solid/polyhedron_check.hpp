// SPDX-License-Identifier: Apache-2.0
#pragma once

// The parts of the checks of primitive.hpp, each a function of its own. All refuse by throwing
// Error with the numbers and coordinates of the facets to blame. [Exact]
//
// LAW check.1  no result, and no error, depends on the number of threads (as in EvaluateOptions).

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "exactcsg/solid/box_pairs.hpp"
#include "exactcsg/solid/polyhedron_signs.hpp"
#include "exactcsg/solid/primitive.hpp"

namespace exactcsg {

// "(0, 1/3, -2)"
std::string describe(const Point3& p);
// "facet 12 with (0, 0, 0), (1, 0, 0), (0, 1, 0)", cut short after six vertices
std::string describe_facet(const Polyhedron& polyhedron, std::size_t facet);

// Gives equal points one index and drops points that no facet uses. Keeps the order of facets and,
// of the first uses, that of vertices.
// THROWS Error(UnknownVertex)
Polyhedron with_distinct_vertices(Polyhedron polyhedron, unsigned threads = 1);

// Three vertices of a facet that span its plane, counter-clockwise from outside, and a coordinate
// along which the facet can be projected: its turns then have the sign given.
struct FacetFrame {
  std::array<std::uint32_t, 3> corners{};
  CoordinateIndex dropped = 0;
  Sign sign = Sign::Positive;
};

// THROWS Error(DegenerateFacet | NonPlanarFacet | NonConvexFacet)
std::vector<FacetFrame> check_facets(const Polyhedron& polyhedron, const PolyhedronSigns& signs,
                                     unsigned threads = 1);

// The two directed edges of a facet's side and of its neighbour's.
struct HalfEdge {
  std::uint32_t low = 0;  // the smaller vertex
  std::uint32_t high = 0;
  std::uint32_t facet = 0;
  bool ascending = true;  // walked from low to high
};
// Sorted by (low, high). COST: O(n log n)
std::vector<HalfEdge> half_edges(const Polyhedron& polyhedron, unsigned threads = 1);

// THROWS Error(OpenMesh) unless every edge is walked as often up as down.
void check_closed(const Polyhedron& polyhedron, const std::vector<HalfEdge>& edges);

// Fans of all facets.
std::vector<std::array<std::uint32_t, 3>> triangles_of(const Polyhedron& polyhedron);

// Boxes that hold the facets.
std::vector<DoubleBox> facet_boxes(const Polyhedron& polyhedron, const PolyhedronSigns& signs,
                                   unsigned threads = 1);

// Two facets meet in nothing but common vertices and common edges, and the winding number is 0 in
// front of every facet and 1 behind it.
// REQUIRES the hierarchy of facet_boxes
// THROWS Error(SelfIntersectingMesh | InvertedMesh)
void check_crossings(const Polyhedron& polyhedron, const PolyhedronSigns& signs,
                     const std::vector<FacetFrame>& frames, const BoxHierarchy& hierarchy,
                     unsigned threads = 1);
void check_winding(const Polyhedron& polyhedron, PolyhedronSigns& signs,
                   const std::vector<FacetFrame>& frames, const std::vector<HalfEdge>& edges,
                   const BoxHierarchy& hierarchy);

// The pairs of facets, the smaller number first, that meet in something else than common vertices
// and common edges. Sorted.
std::vector<std::array<std::uint32_t, 2>> improper_pairs(const Polyhedron& polyhedron,
                                                         const PolyhedronSigns& signs,
                                                         const std::vector<FacetFrame>& frames,
                                                         unsigned threads = 1);

// For every facet a number of the part it is connected to through edges that two facets alone have,
// the number of a facet of that part. Facets for which `usable` is false are parts of their own.
std::vector<std::uint32_t> manifold_parts(const Polyhedron& polyhedron,
                                          const std::vector<HalfEdge>& edges,
                                          const std::function<bool(std::uint32_t)>& usable);

}  // namespace exactcsg
