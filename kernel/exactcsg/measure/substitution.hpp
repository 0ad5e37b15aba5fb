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
template <class Result = domain::Solid3, class P, class F>
Result substituted(const csg::BooleanTree<P>& tree, F&& function) {
  return csg::simplify(csg::detail::rebuild<Result>(
      tree,
      [&](auto node) {
        if (node.kind() == csg::NodeKind::Primitive) return Result(function(node.primitive()));
        return node.kind() == csg::NodeKind::Full ? Result::full() : Result::empty();
      },
      [](auto node, std::span<Result> operands) {
        return Result::compose_from(node.operation(), operands);
      }));
}

}  // namespace exactcsg::measure::detail
