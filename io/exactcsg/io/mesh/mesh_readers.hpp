// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// One reader a format; what they promise is said in mesh_file.hpp. [Exact]
//
// Why not OpenMesh's readers: they store every coordinate as a float (0.1 becomes
// 0.10000000149011612), take OpenSCAD's own OFF header "OFF 8 6 0" for a mesh without vertices, and
// accept truncated files (docs/decisions/0021-mesh-files.md). The tests read what we write through
// OpenMesh as a second opinion.

#include <cstddef>
#include <string>
#include <string_view>
#include <unordered_map>

#include "exactcsg/io/mesh/mesh_file.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg::io {

PolygonSoup read_off(std::string_view text, const std::string& file);
PolygonSoup read_stl(std::string_view bytes, const std::string& file);  // ASCII or binary
PolygonSoup read_obj(std::string_view text, const std::string& file);
PolygonSoup read_ply(std::string_view bytes, const std::string& file);

// Equal coordinates get equal numbers.
class VertexTable {
 public:
  std::uint32_t number(const Point3& point, std::vector<Point3>& vertices);

 private:
  struct Hash {
    std::size_t operator()(const Point3& p) const;
  };
  std::unordered_map<Point3, std::uint32_t, Hash> numbers_;
};

}  // namespace exactcsg::io
