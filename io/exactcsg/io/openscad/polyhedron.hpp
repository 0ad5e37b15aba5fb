// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// A polyhedron as users write it (points and faces of any shape) as one primitive. [Exact]
//
// 1. Equal points are one vertex; repeated vertices of a face are dropped, and faces with fewer
// than
//    three different vertices with a warning.
// 2. A planar convex face is kept. A planar non-convex one is split into convex pieces. One that is
//    not quite planar (six digits cannot hold most rotated quadrilaterals) is split into triangles,
//    with a warning: a quadrilateral along its shorter diagonal, others by the triangulation of
//    their projection along the largest component of their normal.
// 3. If the result is exactly convex it becomes a ConvexPolytope, otherwise a PolyhedralMesh.
//
// LAW polyhedron.1  no vertex is moved and none added.
// Not promised: repair. A mesh that is open, inside out, or meets itself is refused by name, unless
// there is a rule for its inside.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "exactcsg/io/mesh/solid_of_mesh.hpp"
#include "exactcsg/solid/primitive.hpp"

namespace exactcsg::io::openscad {

struct FacedPoints {
  std::vector<Point3> points;
  // Counter-clockwise from outside (OpenSCAD's own order is the reverse).
  std::vector<std::vector<std::uint32_t>> faces;
};

// `warn` is told of faces that were dropped or split. threads: as in EvaluateOptions.
// THROWS Error(DegenerateFacet | OpenMesh | InvertedMesh | SelfIntersectingMesh | UnknownVertex |
//              FlatPolytope)
// COST: O(n log n) expected, O(m^2) signs for a non-convex face of m vertices.
Primitive make_polyhedron(const FacedPoints& input,
                          const std::function<void(const std::string&)>& warn,
                          unsigned threads = 1);

// The same with a rule for the inside, if one is given: then a polyhedron that meets itself or is
// inside out is decided by it, and faces whose outlines cross themselves are split round a point
// that is added. Empty if the rule holds nowhere. `origin` is what messages call the primitive.
// THROWS as make_polyhedron; with a rule neither InvertedMesh nor SelfIntersectingMesh
Solid solid_of_polyhedron(const FacedPoints& input, const InsideRule& inside,
                          const std::string& origin);

}  // namespace exactcsg::io::openscad
