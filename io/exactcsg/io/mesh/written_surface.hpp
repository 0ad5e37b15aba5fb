// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Whether the surface in a mesh file still bounds a solid after its coordinates were rounded.
// [Exact], of the numbers in the file.

#include <cstddef>
#include <optional>
#include <span>

#include "exactcsg/io/mesh/mesh_file.hpp"
#include "exactcsg/solid/primitive.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg::io {

struct SurfaceFinding {
  // nullopt: the facets are closed and oriented, none is flat, they neither cross nor overlap, and
  // what is behind them is bounded. Otherwise the first fault that was found, with the facets to
  // blame.
  std::optional<Error> fault;
  // Without a fault: facets touch others elsewhere than in common corners and sides.
  bool touches_itself = false;
};

// Facets with two equal corners are no facets. REQUIRES triangles. COST: O(n log n) expected
SurfaceFinding examine(const PolygonSoup& soup);
SurfaceFinding examine(const Polyhedron& polyhedron);
inline std::optional<Error> fault_of(const PolygonSoup& soup) { return examine(soup).fault; }

// How many pieces the facets make that have no corner in common, equal points being one.
// COST: O(n log n)
std::size_t count_pieces(const PolygonSoup& soup);
// The same of a boundary, by its vertices.
std::size_t count_pieces(const Boundary& boundary);

}  // namespace exactcsg::io
