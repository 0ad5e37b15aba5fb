// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Whether the surface in a mesh file still bounds a solid after its coordinates were rounded.
// [Exact], of the numbers in the file.

#include <cstddef>
#include <optional>
#include <span>

#include "exactcsg/io/mesh/mesh_file.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg::io {

// nullopt: the facets are closed and oriented, none is flat, none meets another but in common
// corners and sides, and the inside is bounded. Otherwise the first fault that was found, with the
// facets to blame. Facets with two equal corners are no facets.
// REQUIRES triangles. COST: O(n log n) expected
std::optional<Error> fault_of(const PolygonSoup& soup);

// How many pieces the facets make that have no corner in common, equal points being one.
// COST: O(n log n)
std::size_t count_pieces(const PolygonSoup& soup);
// The same of a boundary, by its vertices.
std::size_t count_pieces(const Boundary& boundary);

}  // namespace exactcsg::io
