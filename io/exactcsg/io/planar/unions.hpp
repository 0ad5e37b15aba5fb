// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// What can be said of a tree without evaluating it, and hulls of planar points: shared by the
// algorithms that take a union apart. [Exact]

#include <vector>

#include "exactcsg/csg/walk.hpp"
#include "exactcsg/io/planar/planar.hpp"

namespace exactcsg::io {

// No operator but unions (and operators of one operand), and nothing Full: the set is the union of
// its primitives.
template <class Tree>
bool only_unites(const Tree& tree) {
  bool unions = true;
  csg::walk(
      tree.root(),
      [&](auto node) {
        unions = unions && (node.operation() == csg::BooleanOperator::Union ||
                            node.tree().children().size() == 1);
        return unions;
      },
      [&](auto node) { unions = unions && node.kind() != csg::NodeKind::Full; }, [](auto) {});
  return unions;
}

// No primitive is a half-space.
inline bool is_bounded(const Solid& solid) {
  bool bounded = true;
  csg::for_each_primitive(solid, [&](const Primitive& primitive) {
    bounded = bounded && polyhedron_of(primitive) != nullptr;
  });
  return bounded;
}

// Counter-clockwise and strictly convex; fewer than three: the points are collinear.
std::vector<Point2> planar_hull(const std::vector<Point2>& points);

}  // namespace exactcsg::io
