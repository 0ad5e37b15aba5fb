// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// A mesh file held against the exact boundary: closed? manifold? oriented? then volume, area,
// vertices and sharp edges, each within a bound computed from the format's rounding. [Certified]
//
// What is decided: is the file a triangulation of this boundary whose vertices were moved by no
// more than the rounding of the format? Vertices that rounding has welded, facets that it has
// flattened, and vertices in the middle of straight edges (T-junctions too) are allowed for.
//
// Bounds. Let every vertex be displaced by a vector of length at most t. Moving all vertices along
// straight lines sweeps a closed surface through a volume of at most t * (largest area on the way),
// and changes a triangle's area by at most (|e| + |f|) t + 2 t^2 where e, f are two of its sides.
// So
//   |difference of area|   <= sum over triangles of (|e| + |f|) t + 2 t^2
//   |difference of volume| <= t * (area + that sum).
//
// Edges. A side of a facet of the file is the image of sides of the triangulation, several if
// rounding has laid them into one; each is a piece of an edge of the boundary or a diagonal of a
// face. So, with t the largest displacement:
//  - A side of the file that has an edge of the boundary among them lies within t of that edge.
//    Rule: every point of it lies within 2 t of some edge of the boundary (a chain of edges, where
//    it is longer than one).
//  - A side that has only diagonals among them has pairs of facets on its two sides that were
//    coplanar before rounding; where facets between two of the diagonals have vanished, the pair is
//    that of their outer neighbours. Rule: its facets can be paired off, one from each side, so
//    that displacing their corners by t may make each pair coplanar. Slivers pair with everything.
//  A side of the file that satisfies neither rule is an edge that the model does not have.
//  - An edge of the boundary is a path of sides of the file within 2 t of it, from an image of its
//    one end to an image of the other, unless all its facets may have vanished: on each side of it
//    the face has a third corner within 2 t of an end. A vertex is in the file unless all its edges
//    may have vanished, or be shorter than 2 t.
//  - More than two facets meet at a side of the file only where rounding has joined vertices at one
//    of its ends, or where as many facets of the model meet: those at the edges along it, and two
//    of every other face in which it lies.

#include <filesystem>
#include <string>
#include <vector>

#include "exactcsg/io/mesh/mesh_file.hpp"
#include "exactcsg/solid/boundary.hpp"
#include "exactcsg/verify/facet_complex.hpp"
#include "exactcsg/verify/report.hpp"

namespace exactcsg::verify {

struct MeshComparisonOptions {
  std::string label;  // begins every check's name; empty: "against"
  std::string oracle = "against";
  // What every coordinate of the boundary may differ by from the one that was meant, besides the
  // rounding of the format (io::Model::rounding_bound).
  Rational model_rounding{0};
  // What the file holds besides the boundary: both sides of this complex's membranes. They are
  // held against it and left out. nullptr: nothing.
  const FacetComplex* membranes = nullptr;
};

std::vector<Check> compare_with_soup(const Boundary& boundary, const io::PolygonSoup& soup,
                                     const MeshComparisonOptions& options = {});

// Reads the file; one that cannot be read is one failed check with the reader's message.
std::vector<Check> compare_with_mesh_file(const Boundary& boundary,
                                          const std::filesystem::path& file,
                                          const MeshComparisonOptions& options = {});

}  // namespace exactcsg::verify
