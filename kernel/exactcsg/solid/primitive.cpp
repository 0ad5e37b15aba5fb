// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/primitive.hpp"

#include <algorithm>
#include <utility>

#include "exactcsg/solid/polyhedron_check.hpp"
#include "exactcsg/solid/prepared_polyhedron.hpp"
#include "exactcsg/solid/primitive_in_parallel.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg {

namespace {

void require_outward(const Polyhedron& polyhedron, const PolyhedronSigns& signs) {
  if (signs.volume(triangles_of(polyhedron)) == Sign::Positive) return;
  throw Error(ErrorId::InvertedMesh, {"a volume that is not positive; " +
                                          describe_facet(polyhedron, 0) + " is the first one",
                                      "facets counter-clockwise seen from outside"});
}

}  // namespace

HalfSpace make_half_space(const Rational& a, const Rational& b, const Rational& c,
                          const Rational& d) {
  return {make_plane(a, b, c, d)};
}

ConvexPolytope make_convex_polytope_unchecked(const Polyhedron& polyhedron) {
  return {store_polytope(polyhedron)};
}

ConvexPolytope make_convex_polytope_unchecked(std::span<const Point3> vertices,
                                              const ConvexFacets& facets) {
  return {store_image(vertices, facets.planes())};
}

ConvexPolytope make_box(const Point3& lower, const Point3& upper) {
  if (lower.x >= upper.x || lower.y >= upper.y || lower.z >= upper.z) {
    throw Error(ErrorId::FlatPolytope,
                {"the box from " + describe(lower) + " to " + describe(upper),
                 "a lower corner below the upper one in each coordinate"});
  }
  Polyhedron box;
  for (unsigned corner = 0; corner < 8; ++corner) {
    box.vertices.push_back({(corner & 1U) != 0 ? upper.x : lower.x,
                            (corner & 2U) != 0 ? upper.y : lower.y,
                            (corner & 4U) != 0 ? upper.z : lower.z});
  }
  box.facets = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  return make_convex_polytope_unchecked(box);
}

PolyhedralMesh make_mesh(Polyhedron polyhedron) { return make_mesh(std::move(polyhedron), 1); }

PolyhedralMesh make_mesh(Polyhedron polyhedron, unsigned threads) {
  polyhedron = with_distinct_vertices(std::move(polyhedron), threads);
  PolyhedronSigns signs(polyhedron.vertices);
  const std::vector<FacetFrame> frames = check_facets(polyhedron, signs, threads);
  const std::vector<HalfEdge> edges = half_edges(polyhedron, threads);
  check_closed(polyhedron, edges);
  require_outward(polyhedron, signs);
  const BoxHierarchy hierarchy(facet_boxes(polyhedron, signs, threads));
  check_crossings(polyhedron, signs, frames, hierarchy, threads);
  check_winding(polyhedron, signs, frames, edges, hierarchy);
  return {store_mesh(polyhedron, threads)};
}

PolyhedralMesh make_mesh_unchecked(Polyhedron polyhedron) {
  polyhedron = with_distinct_vertices(std::move(polyhedron));
  const PolyhedronSigns signs(polyhedron.vertices);
  check_facets(polyhedron, signs);
  check_closed(polyhedron, half_edges(polyhedron));
  require_outward(polyhedron, signs);
  return {store_mesh(polyhedron)};
}

}  // namespace exactcsg
