// SPDX-License-Identifier: Apache-2.0
#pragma once

// The general reduction of a CSG tree: all results of a node's children at once, where traverse
// folds them two at a time. For operators of one operand, or whose operands are not taken in turn.
// [Exact]
//
//   reduce(tree, solve, combine [, special]) -> R
//
// solve(primitive) -> R; combine(const O&, span<R>) -> R: the results, in order, at least one; they
// belong to combine, which may move them out.
//
// LAW reduce.1  a primitive yields solve; Full and Empty yield the special results, as in traverse;
// a
//               composed node yields combine of the results of its children.
// LAW reduce.2  traverse(t, solve, f, special) == reduce(t, solve, fold, special) where fold folds
// the
//               span from the left with f.
// LAW reduce.3  solve and combine are called once for every occurrence, children first, from left
// to
//               right.
// R needs only be movable. No recursion.
// THROWS as traverse does. COST: O(occurrences of nodes) calls; memory O(results that wait).
//
// Source: Skillicorn's reductions, as Davy and Dew, section 8, propose them for CSG trees.

#include <concepts>
#include <cstddef>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "exactcsg/csg/traverse.hpp"
#include "exactcsg/csg/tree_concept.hpp"
#include "exactcsg/csg/walk.hpp"
#include "exactcsg/skeleton/executor.hpp"

namespace exactcsg::csg {

template <ReadableTree T, std::invocable<const typename T::Primitive&> Solve, class Combine,
          class Special = NoSpecial, class R = SolveResult<Solve, typename T::Primitive>>
requires std::movable<R> &&
    std::is_invocable_r_v<R, Combine&, const typename T::Operator&, std::span<R>>
        R reduce(const T& tree, Solve&& solve, Combine&& combine, const Special& special = {}) {
  using Cursor = typename T::Cursor;
  skeleton::detail::Array<R> results;
  std::vector<std::size_t> begins;
  walk(
      tree.root(),
      [&](Cursor) {
        begins.push_back(results.size());
        return true;
      },
      [&](Cursor node) { results.push_back(detail::leaf_result<R>(node, solve, special)); },
      [&](Cursor node) {
        const std::size_t begin = begins.back();
        begins.pop_back();
        R result =
            combine(node.operation(), std::span<R>(results.data() + begin, results.size() - begin));
        results.erase(results.begin() + static_cast<std::ptrdiff_t>(begin), results.end());
        results.push_back(std::move(result));
      });
  return std::move(results.back());
}

}  // namespace exactcsg::csg
