// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// A polygon soup with equal vertices welded, its edges counted, and T-junctions closed.

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "exactcsg/io/mesh/mesh_file.hpp"
#include "exactcsg/verify/plain_vector.hpp"

namespace exactcsg::verify {

using MeshEdge = std::array<std::uint32_t, 2>;  // [0] < [1]

struct EdgeUse {
  std::vector<std::uint32_t> forward;   // facets that walk it from [0] to [1]
  std::vector<std::uint32_t> backward;  // facets that walk it from [1] to [0]
  std::size_t count() const { return forward.size() + backward.size(); }
};

struct WeldedMesh {
  std::vector<Point3> points;
  std::vector<PlainVector> positions;  // nearest doubles
  // How far each coordinate may be from the one that was written, by the format's rounding.
  std::vector<std::array<double, 3>> rounding;
  std::vector<double> displacement;  // of each vertex: a bound of the length of its displacement
  std::vector<std::vector<std::uint32_t>> facets;
  std::map<MeshEdge, EdgeUse> edges;
  std::size_t dropped_facets = 0;  // fewer than three different corners
  std::size_t junctions = 0;       // vertices put into sides of facets to close T-junctions
};

// How far a coordinate written in the format may be from the exact one: half a unit in the last
// place, of the file's number of digits (at least six) where it is text.
std::vector<std::array<double, 3>> format_rounding(const io::PolygonSoup& soup);

WeldedMesh weld(const io::PolygonSoup& soup, double model_rounding);

// Counts mesh.edges anew from mesh.facets.
void count_edges(WeldedMesh& mesh);

// Half the sum of the cross products of a facet's sides: normal to it, as long as its area.
PlainVector area_vector(const WeldedMesh& mesh, const std::vector<std::uint32_t>& facet);

// The largest displacement of a corner.
double largest_displacement(const WeldedMesh& mesh, const std::vector<std::uint32_t>& facet);

// What vertices displaced by at most t can add to or take from the area vector of a polygon: each
// displacement d_i contributes d_i x (p_(i+1) - p_(i-1)) / 2 and products of two displacements.
double area_slack(const WeldedMesh& mesh, const std::vector<std::uint32_t>& facet);

// Can the format have rounded this point to vertex v?
bool may_stand_for(const WeldedMesh& mesh, std::uint32_t v, const Point3& exact);

}  // namespace exactcsg::verify
