// SPDX-License-Identifier: Apache-2.0
#pragma once

// A tree with a whole tree of half-spaces in place of every primitive. [Exact]
//
// LAW substitution.1  function(primitive) is called once for every distinct primitive node, and
// what
//                     was shared is shared again. No recursion. COST: O(distinct nodes).

#include <span>

#include "exactcsg/csg/prune.hpp"
#include "exactcsg/domain/bounded_primitives.hpp"

namespace exactcsg::measure::detail {

// Without the Empty and Full that the function yields.
template <class P, class F>
domain::Solid3 substituted(const csg::BooleanTree<P>& tree, F&& function) {
  using domain::Solid3;
  return csg::simplify(csg::detail::rebuild<Solid3>(
      tree,
      [&](auto node) {
        if (node.kind() == csg::NodeKind::Primitive) return Solid3(function(node.primitive()));
        return node.kind() == csg::NodeKind::Full ? Solid3::full() : Solid3::empty();
      },
      [](auto node, std::span<Solid3> operands) {
        return Solid3::compose_from(node.operation(), operands);
      }));
}

}  // namespace exactcsg::measure::detail
