// SPDX-License-Identifier: Apache-2.0
#pragma once

// What is known of one thing (a point, a cell) with respect to a tree of Boolean operators, from
// what is known of it with respect to the primitives. [Exact]
//
//   membership_of(tree, solve) -> Membership
//
// solve(primitive) -> Membership.
//
// LAW membership.1  membership_of(t, solve) == traverse(t, solve, combine, FullEmptyResult{In,
//                   Out}, absorbs).
// THROWS what solve throws. COST: O(nodes visited) calls; memory O(depth). No recursion.
//
// Source: Davy and Dew, section 3.2, example 1.

#include <concepts>
#include <type_traits>

#include "exactcsg/csg/boolean_operator.hpp"
#include "exactcsg/csg/traverse.hpp"
#include "exactcsg/csg/tree_concept.hpp"

namespace exactcsg::csg {

template <ReadableTree T, class Solve>
requires std::convertible_to<const typename T::Operator&, BooleanOperator> &&
    std::is_invocable_r_v<Membership, Solve&, const typename T::Primitive&>
        Membership membership_of(const T& tree, Solve&& solve) {
  // Lambdas, since a pointer to a function is not always inlined.
  return traverse(
      tree, solve, [](Membership a, BooleanOperator op, Membership b) { return combine(a, op, b); },
      FullEmptyResult{Membership::In, Membership::Out},
      [](Membership a, BooleanOperator op) { return absorbs(a, op); });
}

}  // namespace exactcsg::csg
