// SPDX-License-Identifier: Apache-2.0
#pragma once

// What is computed from a decomposition tree: all of it, or along one path. [Exact]
//
//   traverse(tree, solve, combine [, executor])
//   traverse(tree, query, solve, combine [, executor])
//   descend(tree, choose) -> const T&
//   descend_batch(tree, span<Q> queries, choose, visit [, executor])
//
// solve(const T&) or solve(const T&, query) -> R at the terminals; combine(span<R>) -> R or
// combine(span<R>, const N&) -> R at the others. choose(const N&) -> index of a child; for a batch
// choose(const N&, const Q&). visit(const T&, span<Q>) is given the queries that end at a terminal.
//
// LAW gdt.traverse.1  the result at a terminal is solve's; at an interior node it is that of
// combine
//                     on the results of its children, in order.
// LAW gdt.traverse.2  traverse(create(x, leaf, divide, solve), f, combine) ==
//                     divacon(x, leaf, divide, f o solve, combine).
// LAW gdt.descend.1   descend returns the terminal that choose leads to from the root.
// LAW gdt.descend.2   descend_batch puts the queries in the order of the terminals to which choose
//                     leads them, and visits each of these terminals once, with its queries; their
//                     order does not depend on the executor.
// traverse and descend_batch are instances of skeleton::divacon, with its laws of executors,
// exceptions and depth. On several threads, visit is called from all of them.
// THROWS descend, descend_batch: Error(BadArgument) if choose names a child that is not there.
// COST: traverse O(nodes) calls; descend O(depth of the path), no allocation; descend_batch as
// many calls of choose as descend for each query, but every node is fetched once for all of them:
// faster by the cache misses where the tree is larger than the cache.
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

namespace detail {

inline void require_child(std::size_t index, std::size_t degree) {
  if (index < degree) return;
  throw Error(ErrorId::BadArgument,
              {"child " + std::to_string(index), "one of " + std::to_string(degree) + " children"});
}

}  // namespace detail

template <class T, class N, class Choose>
requires std::convertible_to<std::invoke_result_t<Choose&, const N&>, std::size_t>
const T& descend(const Tree<T, N>& tree, Choose&& choose) {
  auto node = tree.root();
  while (!node.is_terminal()) {
    const auto index = static_cast<std::size_t>(choose(node.label()));
    detail::require_child(index, node.degree());
    node = node.child(index);
  }
  return node.terminal();
}

namespace detail {

// Queries on their way down, all at one node.
template <class Node, class Q>
struct Party {
  Node node;
  std::span<Q> queries;
};

// One party for every child that somebody goes to. The queries change places, those of the first
// child first: each is put where it belongs, in exchange for the one that stands there.
template <class Node, class Q, class Choose>
std::vector<Party<Node, Q>> part_ways(const Party<Node, Q>& party, Choose& choose) {
  const std::size_t degree = party.node.degree();
  std::vector<std::size_t> choices(party.queries.size());
  std::vector<std::size_t> next(degree + 1, 0);  // where the next query of a child goes
  for (std::size_t i = 0; i < choices.size(); ++i) {
    choices[i] = static_cast<std::size_t>(choose(party.node.label(), party.queries[i]));
    require_child(choices[i], degree);
    ++next[choices[i] + 1];
  }
  for (std::size_t child = 0; child < degree; ++child) next[child + 1] += next[child];
  const std::vector<std::size_t> first(next);
  std::vector<Party<Node, Q>> parties;
  for (std::size_t child = 0; child < degree; ++child) {
    while (next[child] < first[child + 1]) {
      const std::size_t here = next[child];
      const std::size_t there = next[choices[here]]++;
      if (there == here) continue;
      std::swap(party.queries[here], party.queries[there]);
      std::swap(choices[here], choices[there]);
    }
    const std::size_t count = first[child + 1] - first[child];
    if (count > 0) {
      parties.push_back({party.node.child(child), party.queries.subspan(first[child], count)});
    }
  }
  return parties;
}

// Parties of fewer than few_queries are not shared between threads any more.
template <class Node, class Q, class Choose, class Visit, class E>
void descend_together(const Party<Node, Q>& start, Choose& choose, Visit& visit, const E& executor,
                      std::size_t few_queries) {
  struct Nothing {};
  skeleton::divacon(
      start,
      [&](const Party<Node, Q>& party) {
        return party.node.is_terminal() || party.queries.size() < few_queries;
      },
      [&](const Party<Node, Q>& party) { return part_ways(party, choose); },
      [&](const Party<Node, Q>& party) {
        if (party.node.is_terminal()) {
          visit(party.node.terminal(), party.queries);
        } else {
          descend_together(party, choose, visit, skeleton::SequentialExecutor(), 0);
        }
        return Nothing();
      },
      [](std::span<Nothing>) { return Nothing(); }, executor);
}

}  // namespace detail

template <class T, class N, class Q, class Choose, std::invocable<const T&, std::span<Q>> Visit,
          class E = skeleton::SequentialExecutor>
requires std::convertible_to<std::invoke_result_t<Choose&, const N&, const Q&>, std::size_t>
void descend_batch(const Tree<T, N>& tree, std::span<Q> queries, Choose&& choose, Visit&& visit,
                   const E& executor = {}) {
  using Node = typename Tree<T, N>::Node;
  if (queries.empty()) return;
  constexpr std::size_t few_queries = std::same_as<E, skeleton::SequentialExecutor> ? 0 : 1024;
  detail::descend_together(detail::Party<Node, Q>{tree.root(), queries}, choose, visit, executor,
                           few_queries);
}

}  // namespace exactcsg::gdt
