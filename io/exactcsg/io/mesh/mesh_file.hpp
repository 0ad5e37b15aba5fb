// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Polygon mesh files (OFF, STL ASCII and binary, OBJ, PLY): reading as a soup of polygons exactly
// as the file says, and writing a canonical boundary, triangulated without T-junctions.

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "exactcsg/solid/boundary.hpp"

namespace exactcsg::io {

enum class MeshFormat { Off, StlAscii, StlBinary, Obj, Ply };

// What the file says: coordinates as the exact values of the doubles (or, for decimal formats, of
// the decimals) in it. For STL, equal coordinates are one vertex; nothing else is merged or
// repaired.
struct PolygonSoup {
  MeshFormat format = MeshFormat::Off;
  std::vector<Point3> vertices;
  std::vector<std::vector<std::uint32_t>> facets;
  // Half a unit in the last place of the format at the largest coordinate: how far each coordinate
  // may be from the one that was written.
  Rational rounding_bound{0};
};

// THROWS Error(FileNotReadable | EmptyFile | UnknownFormat | TruncatedInput | UnexpectedText |
//              NumberOutOfRange | UnknownVertex)
PolygonSoup read_polygon_soup(const std::filesystem::path& file);

// Triangles of every face by constrained triangulation of its loops with exact predicates: no
// vertex is added, every boundary edge is an edge of triangles, so the surface is watertight.
// [Exact]
std::vector<std::array<std::uint32_t, 3>> triangulate(const Boundary& boundary);

struct WriteReport {
  std::size_t triangles = 0;
  double largest_rounding = 0;      // of a coordinate
  std::size_t merged_vertices = 0;  // distinct vertices that became equal by rounding
  std::size_t degenerate_triangles = 0;
};
// Format by ending: .off .stl (binary) .obj .ply. Doubles with 17 digits where the format is text.
WriteReport write_boundary(const Boundary& boundary, const std::filesystem::path& file);

// Triangles between points that the file's format can hold as they are.
struct RoundedSurface {
  std::vector<std::array<double, 3>> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};
// Whether the format of the file's ending holds coordinates in single precision, else in double.
// THROWS Error(UnknownFormat)
bool is_single_precision(const std::filesystem::path& file);
// THROWS Error(UnknownFormat | FileNotWritable)
void write_surface(const RoundedSurface& surface, const std::filesystem::path& file);

}  // namespace exactcsg::io
