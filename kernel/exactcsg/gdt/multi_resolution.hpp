// SPDX-License-Identifier: Apache-2.0
#pragma once

// The multi-resolution tree: the same object at every node, described better the deeper one goes; a
// decomposition tree whose labels are of the type of its terminals. [Exact]
//
//   create_multi_resolution(data, leaf, divide, describe [, max_depth [, executor]])
//   traverse(tree, LeafTest{leaf}, solve, combine [, executor])
//   traverse(tree, query, LeafTest{leaf}, solve, combine [, executor])
//
// describe(const D&) -> T at every node. leaf(const N&) or leaf(const N&, query) -> bool: is this
// accurate enough? solve(const T&) or solve(const T&, query) -> R; combine as for traverse.
//
// LAW multi.1  create_multi_resolution(x, leaf, divide, f) == create(x, leaf, divide, f), with the
//              label f(y) at the node of every y that was divided (as divide has left it).
// LAW multi.2  the result at a node is solve's of its geometry if it is a terminal or leaf says so,
//              and then nothing below is visited; else that of combine.
// LAW multi.3  with a leaf that is always false, this is gdt::traverse.
// Instances of skeleton::divacon, with its laws of executors, exceptions and depth.
// COST: O(nodes visited) calls.
//
// Source: Davy and Dew, section 3.7; Ballard's strip trees are the standard example.

#include <concepts>
#include <cstddef>
#include <span>
#include <type_traits>
#include <utility>

#include "exactcsg/gdt/create.hpp"
#include "exactcsg/gdt/traverse.hpp"
#include "exactcsg/gdt/tree.hpp"
#include "exactcsg/skeleton/divacon.hpp"

namespace exactcsg::gdt {

template <class T>
using MultiResolutionTree = Tree<T, T>;

template <std::movable D, std::predicate<const D&> Leaf, std::invocable<D&> Divide,
          std::invocable<const D&> Describe, class E = skeleton::SequentialExecutor,
          class T = std::remove_cvref_t<std::invoke_result_t<Describe&, const D&>>>
MultiResolutionTree<T> create_multi_resolution(D data, Leaf&& leaf, Divide&& divide,
                                               Describe&& describe,
                                               std::size_t max_depth = unlimited_depth,
                                               const E& executor = {}) {
  const auto describe_any = [&](const D& part) -> T { return describe(part); };
  return create(std::move(data), leaf, divide, describe_any, max_depth, executor, describe_any);
}

// Says where a traversal need not go deeper.
template <class Leaf>
struct LeafTest {
  Leaf leaf;
};
template <class Leaf>
LeafTest(Leaf) -> LeafTest<Leaf>;

template <class T, class N, std::predicate<const N&> Leaf, std::invocable<const T&> Solve,
          class Combine, class E = skeleton::SequentialExecutor,
          class R = std::remove_cvref_t<std::invoke_result_t<Solve&, const T&>>>
requires std::movable<R> && std::is_invocable_r_v<R, Solve&, const N&> &&
    CombinesChildren<Combine, R, N>
        R traverse(const Tree<T, N>& tree, const LeafTest<Leaf>& test, Solve&& solve,
                   Combine&& combine, const E& executor = {}) {
  using Node = typename Tree<T, N>::Node;
  return skeleton::divacon(
      tree.root(), [&](const Node& node) { return node.is_terminal() || test.leaf(node.label()); },
      [](const Node& node) { return node.children(); },
      [&](const Node& node) -> R {
        return node.is_terminal() ? solve(node.terminal()) : solve(node.label());
      },
      [&](std::span<R> results, const Node& node) -> R {
        return detail::combine_children<R>(combine, results, node);
      },
      executor);
}

template <class T, class N, class Query, std::predicate<const N&, const Query&> Leaf,
          std::invocable<const T&, const Query&> Solve, class Combine,
          class E = skeleton::SequentialExecutor>
requires std::invocable<Solve&, const N&, const Query&>
auto traverse(const Tree<T, N>& tree, const Query& query, const LeafTest<Leaf>& test, Solve&& solve,
              Combine&& combine, const E& executor = {}) {
  return traverse(
      tree, LeafTest{[&](const N& label) { return test.leaf(label, query); }},
      [&](const auto& geometry) { return solve(geometry, query); }, combine, executor);
}

}  // namespace exactcsg::gdt
