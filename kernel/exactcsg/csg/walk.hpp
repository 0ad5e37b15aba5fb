// SPDX-License-Identifier: Apache-2.0
#pragma once

// Visits the nodes of a CSG tree in order, without recursion. [Exact]
//
// enter(cursor) -> bool is asked at a composed node: false skips its children and its leave.
// leaf(cursor) is told every other node, leave(cursor) a composed node after its children.
// COST: O(nodes visited) calls, memory O(depth).

#include <concepts>
#include <vector>

#include "exactcsg/csg/tree_concept.hpp"

namespace exactcsg::csg {

template <class Cursor, class Enter, class Leaf, class Leave>
requires std::predicate<Enter&, Cursor> && std::invocable<Leaf&, Cursor> &&
    std::invocable<Leave&, Cursor>
void walk(Cursor node, Enter&& enter, Leaf&& leaf, Leave&& leave) {
  struct Open {
    Cursor self;
    Cursor child;
  };
  std::vector<Open> open;
  for (;;) {
    if (node.kind() != NodeKind::Compose) {
      leaf(node);
    } else if (enter(node)) {
      open.push_back({node, node.first_child()});
      node = node.first_child();
      continue;
    }
    for (;;) {
      if (open.empty()) return;
      Open& top = open.back();
      top.child = top.child.next_sibling();
      if (!(top.child == top.self.children_end())) {
        node = top.child;
        break;
      }
      leave(top.self);
      open.pop_back();
    }
  }
}

// visit(primitive) for every occurrence of a primitive, from left to right.
template <ReadableTree T, std::invocable<const typename T::Primitive&> Visit>
void for_each_primitive(const T& tree, Visit&& visit) {
  using Cursor = typename T::Cursor;
  walk(
      tree.root(), [](Cursor) { return true; },
      [&](Cursor leaf) {
        if (leaf.kind() == NodeKind::Primitive) visit(leaf.primitive());
      },
      [](Cursor) {});
}

}  // namespace exactcsg::csg
