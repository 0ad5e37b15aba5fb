// SPDX-License-Identifier: Apache-2.0
#pragma once

// The leaves of a solid: half-spaces, convex polytopes and closed polyhedral meshes, with exact
// coordinates. Immutable; copying a Primitive copies a handle. Points are rounded and planes found
// where primitives are made, once for all evaluations. [Exact]
//
// LAW primitive.1  a primitive is a regular closed set (the closure of its interior) with non-empty
// interior and complement.

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "exactcsg/number/point.hpp"
#include "exactcsg/solid/polyhedron.hpp"

namespace exactcsg {

struct HalfSpace {
  Plane plane;  // {x : a x + b y + c z + d <= 0}
};

// Both are handles of immutable polyhedra; equal handles are equal primitives.
struct ConvexPolytope {
  std::shared_ptr<const StoredPolyhedron> polyhedron;
};
struct PolyhedralMesh {
  std::shared_ptr<const StoredPolyhedron> polyhedron;
};

using PrimitiveShape = std::variant<HalfSpace, ConvexPolytope, PolyhedralMesh>;

struct Primitive {
  PrimitiveShape shape;
  // Where it was written ("part.csg:12:3"), for messages; not part of its value.
  std::string origin{};
};

// Null for a half-space; else what the primitive is a handle of.
inline const StoredPolyhedron* polyhedron_of(const Primitive& primitive) noexcept {
  if (const auto* polytope = std::get_if<ConvexPolytope>(&primitive.shape)) {
    return polytope->polyhedron.get();
  }
  if (const auto* mesh = std::get_if<PolyhedralMesh>(&primitive.shape)) {
    return mesh->polyhedron.get();
  }
  return nullptr;
}

HalfSpace make_half_space(const Rational& a, const Rational& b, const Rational& c,
                          const Rational& d);

// The polytope with these facets. Checks: every facet planar, convex, not degenerate; closed; every
// vertex inside every facet's half-space; not inside out. Coplanar neighbouring facets are merged.
// THROWS Error(DegenerateFacet | NonPlanarFacet | NonConvexFacet | OpenMesh | InvertedMesh |
//              NotConvex | FlatPolytope | UnknownVertex)
// COST: O(vertices * facets) signs for the check.
ConvexPolytope make_convex_polytope(Polyhedron polyhedron);

// The same without the global checks, for generators whose output is convex by construction (box,
// sphere, cylinder). Facets must be planar, convex, and pairwise not coplanar.
ConvexPolytope make_convex_polytope_unchecked(const Polyhedron& polyhedron);
// Likewise, of many polytopes with the same facets. COST: less time, and no memory for the facets
ConvexPolytope make_convex_polytope_unchecked(std::span<const Point3> vertices,
                                              const ConvexFacets& facets);

// The intersection of half-spaces. THROWS Error(UnboundedSolid | FlatPolytope)
// COST: O(n^4) signs; meant for small n.
ConvexPolytope make_convex_polytope(std::span<const HalfSpace> half_spaces);

// The axis-parallel box [lower, upper]. REQUIRES lower < upper in each coordinate, else
// THROWS Error(FlatPolytope).
ConvexPolytope make_box(const Point3& lower, const Point3& upper);

// A closed, oriented polyhedron that does not intersect itself. Facets may be non-convex or not
// quite triangulated only if they are planar and convex (see Facet); a reader splits others first.
// Checks: facets as above; every directed edge matched by its opposite (an edge may carry 2, 4, ...
// facets); the interior is bounded (positive volume); no two facets cross or overlap.
// THROWS Error(DegenerateFacet | NonPlanarFacet | NonConvexFacet | OpenMesh | InvertedMesh |
//              SelfIntersectingMesh | UnknownVertex)
// COST: O(n log n) expected for the crossing test.
PolyhedralMesh make_mesh(Polyhedron polyhedron);

// The same without the crossing test, for generators that cannot cross by construction.
PolyhedralMesh make_mesh_unchecked(Polyhedron polyhedron);

// The image under an invertible map (facets are turned round if it mirrors).
// THROWS Error(SingularMap)
Primitive apply(const AffineMap& map, const Primitive& primitive);

}  // namespace exactcsg
