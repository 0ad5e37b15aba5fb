// SPDX-License-Identifier: Apache-2.0
#pragma once

// What can be said of a polyhedron by itself before it becomes part of a scene: found where it is
// made, once for all evaluations. Internal to primitives and scenes.

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "exactcsg/number/geometry.hpp"
#include "exactcsg/number/prepared_plane.hpp"
#include "exactcsg/solid/polyhedron.hpp"

namespace exactcsg {

using Triple = std::array<std::uint32_t, 3>;

// A plane through the side from one vertex to another, not the facet's own: it contains the axis
// that the facet's normal leans to most.
struct PlaneAcross {
  std::uint32_t from;
  std::uint32_t to;
  Axis axis;
};

// The images of a convex polytope under maps that do not mirror, and those of a mesh under
// translations, have these in common. Planes are numbered within the polyhedron, those of facets
// first.
struct FacetPlanes {
  FlatFacets facets;
  bool convex = true;
  std::vector<std::uint32_t> of_facets;  // empty: facet f has plane f
  // Of the side from each corner to the next: a plane that meets the facet's plane in it.
  std::vector<std::uint32_t> of_sides;
  std::vector<Triple> triples;      // of facets' planes: corners that span the plane
  std::vector<PlaneAcross> across;  // sides between coplanar facets

  std::uint32_t facet_count() const { return static_cast<std::uint32_t>(facets.size()); }
  std::uint32_t plane_count() const {
    return static_cast<std::uint32_t>(triples.size() + across.size());
  }
  std::uint32_t of_facet(std::uint32_t facet) const {
    return of_facets.empty() ? facet : of_facets[facet];
  }
};

struct PreparedPolyhedron {
  struct Bounds {
    double lower = std::numeric_limits<double>::infinity();
    double upper = -std::numeric_limits<double>::infinity();
  };

  std::shared_ptr<const FacetPlanes> facets;
  std::vector<HashedPoint> points;
  std::array<Bounds, 3> bounds;  // along each axis, of the rounded points
  std::vector<PreparedPlane> planes;
  std::vector<Triple> own_triples;  // empty: those of `facets`

  const std::vector<Triple>& triples() const {
    return own_triples.empty() ? facets->triples : own_triples;
  }
};

// threads: as in EvaluateOptions; the result does not depend on it.
// REQUIRES facets that are planar and convex, and that close up
// THROWS Error(DegenerateFacet | InternalError) if that is not so, and it is found out
std::shared_ptr<const StoredPolyhedron> store_polytope(const Polyhedron& polyhedron);
std::shared_ptr<const StoredPolyhedron> store_mesh(const Polyhedron& polyhedron,
                                                   unsigned threads = 1);
// An image of what has these planes: of a convex polytope under a map that does not mirror, of a
// mesh under a translation.
std::shared_ptr<const StoredPolyhedron> store_image(
    std::span<const Point3> vertices, const std::shared_ptr<const FacetPlanes>& planes,
    unsigned threads = 1);

}  // namespace exactcsg
