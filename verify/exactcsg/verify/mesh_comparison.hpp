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

#include <filesystem>
#include <string>
#include <vector>

#include "exactcsg/io/mesh/mesh_file.hpp"
#include "exactcsg/solid/boundary.hpp"
#include "exactcsg/verify/report.hpp"

namespace exactcsg::verify {

struct MeshComparisonOptions {
  std::string label;  // begins every check's name; empty: "against"
  std::string oracle = "against";
  // What every coordinate of the boundary may differ by from the one that was meant, besides the
  // rounding of the format (io::Model::rounding_bound).
  Rational model_rounding{0};
};

std::vector<Check> compare_with_soup(const Boundary& boundary, const io::PolygonSoup& soup,
                                     const MeshComparisonOptions& options = {});

// Reads the file; one that cannot be read is one failed check with the reader's message.
std::vector<Check> compare_with_mesh_file(const Boundary& boundary,
                                          const std::filesystem::path& file,
                                          const MeshComparisonOptions& options = {});

}  // namespace exactcsg::verify
