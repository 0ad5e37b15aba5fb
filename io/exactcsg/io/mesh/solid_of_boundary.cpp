// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/mesh/solid_of_boundary.hpp"

#include "exactcsg/io/mesh/mesh_file.hpp"

namespace exactcsg::io {

Solid solid_of_boundary(const Boundary& boundary) {
  if (boundary.empty()) return Solid::empty();
  Polyhedron polyhedron;
  polyhedron.vertices = to_vector(boundary.vertices);
  for (const auto& [a, b, c] : triangulate(boundary)) polyhedron.facets.push_back({a, b, c});
  // A canonical boundary does not cross itself, but it may touch itself: at an edge, or with a
  // vertex inside a face, which the test for crossings would refuse.
  return Solid::primitive({make_mesh_unchecked(std::move(polyhedron))});
}

}  // namespace exactcsg::io
