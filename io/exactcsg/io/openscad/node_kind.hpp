// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The nodes of the .csg format, and what is said of a name that is none of them.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace exactcsg::io::openscad {

enum class NodeKind : std::uint8_t {
  Group,  // group, color, render: a union, the rest of the arguments does not matter
  Union,
  Difference,
  Intersection,
  Hull,
  Multmatrix,
  LinearExtrude,
  RotateExtrude,
  Offset,
  Projection,
  Resize,
  Minkowski,
  Cube,
  Sphere,
  Cylinder,
  Polyhedron,
  Import,
  Surface,
  Square,
  Circle,
  Polygon,
  Text,
  Unsupported,  // known to OpenSCAD, refused by name here (docs/limits.md)
};

constexpr bool is_planar_leaf(NodeKind kind) {
  using enum NodeKind;
  return kind == Square || kind == Circle || kind == Polygon || kind == Text;
}

constexpr bool is_leaf(NodeKind kind) {
  using enum NodeKind;
  return kind == Cube || kind == Sphere || kind == Cylinder || kind == Polyhedron ||
         kind == Import || kind == Surface || is_planar_leaf(kind);
}

// Their children are in a frame of their own: what they make does not commute with matrices.
constexpr bool has_own_frame(NodeKind kind) {
  using enum NodeKind;
  return kind == LinearExtrude || kind == RotateExtrude || kind == Offset || kind == Projection ||
         kind == Resize || kind == Minkowski;
}

// nullopt: no release of OpenSCAD writes such a node.
std::optional<NodeKind> find_node_kind(std::string_view name);

// What the writer may have meant: the known name with the smallest edit distance ("a node of the
// .csg format, perhaps 'cube'"), or how to come by a .csg from the source language ("'translate'
// belongs to .scad sources ...").
std::string suggest_node(std::string_view unknown_name);

}  // namespace exactcsg::io::openscad
