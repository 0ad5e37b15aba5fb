// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/openscad/node_kind.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>
#include <vector>

namespace exactcsg::io::openscad {

namespace {

using enum NodeKind;

constexpr auto node_kinds = std::to_array<std::pair<std::string_view, NodeKind>>({
    {"circle", Circle},
    {"color", Group},
    {"cube", Cube},
    {"cylinder", Cylinder},
    {"difference", Difference},
    {"fill", Unsupported},
    {"group", Group},
    {"hull", Hull},
    {"import", Import},
    {"intersection", Intersection},
    {"linear_extrude", LinearExtrude},
    {"minkowski", Minkowski},
    {"multmatrix", Multmatrix},
    {"offset", Offset},
    {"polygon", Polygon},
    {"polyhedron", Polyhedron},
    {"projection", Projection},
    {"render", Group},
    {"resize", Resize},
    {"roof", Unsupported},
    {"rotate_extrude", RotateExtrude},
    {"sphere", Sphere},
    {"square", Square},
    {"surface", Surface},
    {"text", Text},
    {"union", Union},
});

constexpr auto source_words = std::to_array<std::string_view>(
    {"assert", "assign", "children", "echo", "else", "for", "function", "if", "include",
     "intersection_for", "let", "mirror", "module", "rotate", "scale", "translate", "use"});

// Levenshtein's distance by rows.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({substituted, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

}  // namespace

std::optional<NodeKind> find_node_kind(std::string_view name) {
  const auto found =
      std::lower_bound(node_kinds.begin(), node_kinds.end(), name,
                       [](const auto& entry, std::string_view text) { return entry.first < text; });
  if (found == node_kinds.end() || found->first != name) return std::nullopt;
  return found->second;
}

std::string suggest_node(std::string_view unknown_name) {
  if (std::find(source_words.begin(), source_words.end(), unknown_name) != source_words.end()) {
    return "a node of the .csg format ('" + std::string(unknown_name) +
           "' belongs to sources: name the file .scad, or export it as .csg)";
  }
  constexpr std::size_t longest = 64;  // no name is near to such a word
  if (unknown_name.size() > longest) return "a node of the .csg format";
  const auto nearest =
      std::min_element(node_kinds.begin(), node_kinds.end(), [&](const auto& a, const auto& b) {
        return edit_distance(unknown_name, a.first) < edit_distance(unknown_name, b.first);
      });
  if (edit_distance(unknown_name, nearest->first) >
      std::max<std::size_t>(1, unknown_name.size() / 3)) {
    return "a node of the .csg format";
  }
  return "a node of the .csg format, perhaps '" + std::string(nearest->first) + "'";
}

}  // namespace exactcsg::io::openscad
