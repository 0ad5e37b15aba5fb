// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The files that `import` and `surface` of a .csg text name: found in the model's folder, read
// once, and turned into solids. [Exact]
//
// import: .off, .stl and .obj as read_polygon_soup reads them, which is what make_polyhedron makes
// a solid of; other formats are refused. surface: a text of numbers in rows, the height at the
// point (column, row); blank lines and those that begin with '#' do not count, and missing numbers
// at the end of a row are 0. Every square of four heights is four triangles round its middle, whose
// height is their mean; the floor is the plane z = min(0, least height - 1).

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "exactcsg/io/mesh/mesh_file.hpp"
#include "exactcsg/io/openscad/polyhedron.hpp"
#include "exactcsg/io/openscad/shapes.hpp"

namespace exactcsg::io::openscad {

class NamedFiles {
 public:
  explicit NamedFiles(std::optional<std::filesystem::path> folder) : folder_(std::move(folder)) {}

  // THROWS Error(FileNotReadable | UnsupportedNode) at the name; what read_polygon_soup throws.
  const PolygonSoup& mesh(const FileShape& shape);

  // A closed surface that does not cross itself, by construction. No points: fewer than two rows
  // or columns, hence empty. THROWS Error(FileNotReadable | UnsupportedNode) at the name;
  // Error(UnexpectedText | NumberOutOfRange | TooLarge) in the file.
  FacedPoints height_field(const SurfaceShape& shape) const;

 private:
  std::filesystem::path find(const FileShape& shape) const;

  std::optional<std::filesystem::path> folder_;
  std::map<std::filesystem::path, PolygonSoup> meshes_;
};

}  // namespace exactcsg::io::openscad
