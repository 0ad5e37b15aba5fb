// SPDX-License-Identifier: Apache-2.0
#pragma once

// What is computed from a decomposition tree: all of it, or along one path. [Exact]
//
//   traverse(tree, solve, combine [, executor])
//   traverse(tree, query, solve, combine [, executor])
//   descend(tree, choose) -> const T&
//
// solve(const T&) or solve(const T&, query) -> R at the terminals; combine(span<R>) -> R or
// combine(span<R>, const N&) -> R at the others. choose(const N&) -> index of a child.
//
// LAW gdt.traverse.1  the result at a terminal is solve's; at an interior node it is that of
// combine
//                     on the results of its children, in order.
// LAW gdt.traverse.2  traverse(create(x, leaf, divide, solve), f, combine) ==
//                     divacon(x, leaf, divide, f o solve, combine).
// LAW gdt.descend.1   descend returns the terminal that choose leads to from the root.
// traverse is an instance of skeleton::divacon, with its laws of executors, exceptions and depth.
// THROWS descend: Error(BadArgument) if choose names a child that is not there.
// COST: traverse O(nodes) calls; descend O(depth of the path), no allocation.
//
// Source: Davy and Dew, section 3.3; descend is ours (their section 6.1 misses it).

#include <concepts>
#include <cstddef>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "exactcsg/gdt/tree.hpp"
#include "exactcsg/skeleton/divacon.hpp"

namespace exactcsg::gdt {

template <class Combine, class R, class N>
concept CombinesChildren =
    std::is_invocable_r_v<R, Combine&, std::span<R>> || std::is_invocable_r_v < R,
        Combine&, std::span<R>,
const N& > ;

namespace detail {

template <class R, class Combine, class Node>
R combine_children(Combine& combine, std::span<R> results, const Node& node) {
  if constexpr (std::is_invocable_r_v<R, Combine&, std::span<R>>) {
    return combine(results);
  } else {
    return combine(results, node.label());
  }
}

// What SequentialExecutor would do, but the nodes are at hand: no problem is made and moved.
template <class R, class T, class N, class Solve, class Combine>
R traverse_sequentially(const Tree<T, N>& tree, Solve& solve, Combine& combine) {
  using Node = typename Tree<T, N>::Node;
  struct Open {
    Node node;
    std::size_t next_child;
    std::size_t first_result;
  };
  std::vector<Open> open;
  skeleton::detail::Array<R> results;
  Node node = tree.root();
  for (;;) {
    while (!node.is_terminal() && node.degree() > 0) {
      open.push_back({node, 1, results.size()});
      node = node.child(0);
    }
    if (node.is_terminal()) {
      results.push_back(solve(node.terminal()));
    } else {
      results.push_back(combine_children<R>(combine, std::span<R>(), node));
    }
    while (!open.empty() && open.back().next_child == open.back().node.degree()) {
      const Open& top = open.back();
      const auto first = results.begin() + static_cast<std::ptrdiff_t>(top.first_result);
      R result = combine_children<R>(
          combine, std::span<R>(results.data() + top.first_result, top.node.degree()), top.node);
      results.erase(first, results.end());
      results.push_back(std::move(result));
      open.pop_back();
    }
    if (open.empty()) return std::move(results.front());
    node = open.back().node.child(open.back().next_child++);
  }
}

}  // namespace detail

template <class T, class N, std::invocable<const T&> Solve, class Combine,
          class E = skeleton::SequentialExecutor,
          class R = std::remove_cvref_t<std::invoke_result_t<Solve&, const T&>>>
requires std::movable<R> && CombinesChildren<Combine, R, N> R traverse(const Tree<T, N>& tree,
                                                                       Solve&& solve,
                                                                       Combine&& combine,
                                                                       const E& executor = {}) {
  using Node = typename Tree<T, N>::Node;
  if constexpr (std::same_as<E, skeleton::SequentialExecutor>) {
    return detail::traverse_sequentially<R>(tree, solve, combine);
  }
  return skeleton::divacon(
      tree.root(), [](const Node& node) { return node.is_terminal(); },
      [](const Node& node) { return node.children(); },
      [&](const Node& node) -> R { return solve(node.terminal()); },
      [&](std::span<R> results, const Node& node) -> R {
        return detail::combine_children<R>(combine, results, node);
      },
      executor);
}

template <class T, class N, class Query, std::invocable<const T&, const Query&> Solve,
          class Combine, class E = skeleton::SequentialExecutor>
auto traverse(const Tree<T, N>& tree, const Query& query, Solve&& solve, Combine&& combine,
              const E& executor = {}) {
  return traverse(
      tree, [&](const T& terminal) { return solve(terminal, query); }, combine, executor);
}

template <class T, class N, class Choose>
requires std::convertible_to<std::invoke_result_t<Choose&, const N&>, std::size_t>
const T& descend(const Tree<T, N>& tree, Choose&& choose) {
  auto node = tree.root();
  while (!node.is_terminal()) {
    const auto index = static_cast<std::size_t>(choose(node.label()));
    if (index >= node.degree()) {
      throw Error(ErrorId::BadArgument, {"child " + std::to_string(index),
                                         "one of " + std::to_string(node.degree()) + " children"});
    }
    node = node.child(index);
  }
  return node.terminal();
}

}  // namespace exactcsg::gdt
