// SPDX-License-Identifier: Apache-2.0
#pragma once

// Two decomposition trees of the same space combined cell by cell: the Boolean operations, sums and
// differences of octrees, quadtrees and k-d trees. [Exact]
//
//   overlay(first, second, op [, early [, executor]]) -> Tree<U, N>
//   overlay_cuts(first, second, cell, op [, early [, executor]]) -> Tree<U, Cut>
//   merge_equal(tree) -> the same with fewer nodes
//   to_cuts(tree, cell) -> Tree<T, Cut>
//
// op(const T1&, const T2&) -> U. early(const T1*, const T2*) -> optional<U> is told what is known:
// null stands for a part that is divided further; a value says that the division does not matter
// (what is united with Full is Full).
//
// LAW overlay.1  at every point the value of the result is op of the values of the two trees there.
// LAW overlay.2  early changes no value; below a pair that it decides nothing is visited, as long
// as
//                REQUIRES it gives only what op gives on every refinement.
// LAW overlay.3  merge_equal changes no value, and leaves no interior node all of whose children
// are
//                equal terminals.
// LAW overlay.4  to_cuts changes no value.
// overlay REQUIRES that nodes in the same place are divided alike: the label of the first is the
// result's; THROWS Error(BadArgument) if their degrees differ. overlay_cuts takes any two trees
// divided by cuts, each in its own way, and cell is the space of both. to_cuts makes such a tree of
// a quadtree or octree (of any dimension), THROWS Error(BadArgument) if a node has another degree.
// Instances of zip and create, with their laws of executors, exceptions and depth.
// COST: O(nodes of the result); overlay_cuts besides the cuts that miss a region, of which there
// are at most nodes times depth.
//
// Source: ours, on what Davy and Dew miss in section 6.1; for octrees after Meagher (1982).

#include <concepts>
#include <cstddef>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "exactcsg/gdt/cell.hpp"
#include "exactcsg/gdt/create.hpp"
#include "exactcsg/gdt/subtree.hpp"
#include "exactcsg/gdt/traverse.hpp"
#include "exactcsg/gdt/tree.hpp"
#include "exactcsg/gdt/zip.hpp"

namespace exactcsg::gdt {

struct NeverEarly {};

namespace detail {

template <class Op, class T1, class T2>
using OverlayResult = std::remove_cvref_t<std::invoke_result_t<Op&, const T1&, const T2&>>;

template <class Node>
auto* known(const Node& node) noexcept {
  return node.is_terminal() ? &node.terminal() : nullptr;
}

template <class U, class Early, class P>
std::optional<U> decide(Early& early, const P& pair) {
  if constexpr (std::same_as<std::remove_cv_t<Early>, NeverEarly>) {
    return std::nullopt;
  } else {
    return early(known(pair.first), known(pair.second));
  }
}

template <class U, class Op, class Early, class P>
U overlay_value(Op& op, Early& early, const P& pair) {
  if (pair.first.is_terminal() && pair.second.is_terminal()) {
    return op(pair.first.terminal(), pair.second.terminal());
  }
  return *decide<U>(early, pair);
}

template <class U, class N, class P>
Subtree<U, N> join(std::span<Subtree<U, N>> parts, const P& pair) {
  return Subtree<U, N>::interior(
      {std::move_iterator(parts.begin()), std::move_iterator(parts.end())},
      pair.first.is_terminal() ? pair.second.label() : pair.first.label());
}

}  // namespace detail

template <class Early, class T1, class T2, class U>
concept DecidesEarly = std::same_as<std::remove_cvref_t<Early>, NeverEarly> ||
    std::is_invocable_r_v<std::optional<U>, Early&, const T1*, const T2*>;

template <class T1, class T2, class N, std::invocable<const T1&, const T2&> Op,
          class Early = NeverEarly, class E = skeleton::SequentialExecutor,
          class U = detail::OverlayResult<Op, T1, T2>>
requires DecidesEarly<Early, T1, T2, U> Tree<U, N> overlay(const Tree<T1, N>& first,
                                                           const Tree<T2, N>& second, Op&& op,
                                                           Early&& early = {},
                                                           const E& executor = {}) {
  using P = Pair<Tree<T1, N>, Tree<T2, N>>;
  using Part = detail::Subtree<U, N>;
  return Tree<U, N>(zip(
      first, second,
      [&](const P& pair) {
        if (detail::decide<U>(early, pair)) return Split::Neither;
        if (pair.first.is_terminal()) {
          return pair.second.is_terminal() ? Split::Neither : Split::Second;
        }
        return pair.second.is_terminal() ? Split::First : Split::Both;
      },
      [&](const P& pair) { return Part::terminal(detail::overlay_value<U>(op, early, pair)); },
      [](std::span<Part> parts, const P& pair) { return detail::join(parts, pair); }, executor));
}

template <class T1, class T2, class Scalar, std::size_t dimension,
          std::invocable<const T1&, const T2&> Op, class Early = NeverEarly,
          class E = skeleton::SequentialExecutor, class U = detail::OverlayResult<Op, T1, T2>>
requires DecidesEarly<Early, T1, T2, U> Tree<U, Cut<Scalar>> overlay_cuts(
    const Tree<T1, Cut<Scalar>>& first, const Tree<T2, Cut<Scalar>>& second,
    const Cell<Scalar, dimension>& cell, Op&& op, Early&& early = {}, const E& executor = {}) {
  using Region = Cell<Scalar, dimension>;
  using P = Pair<Tree<T1, Cut<Scalar>>, Tree<T2, Cut<Scalar>>, Region>;
  using Part = detail::Subtree<U, Cut<Scalar>>;
  return Tree<U, Cut<Scalar>>(zip(
      first, second, cell,
      [&](const P& pair) {
        if (detail::decide<U>(early, pair)) return Split::Neither;
        if (!pair.first.is_terminal()) return Split::First;
        return pair.second.is_terminal() ? Split::Neither : Split::Second;
      },
      [](const P& pair, Split split, std::size_t index) -> std::optional<Region> {
        const Cut<Scalar>& cut = split == Split::First ? pair.first.label() : pair.second.label();
        const Region part = Cuts{}(pair.state, cut, index);
        if (is_empty(part)) return std::nullopt;
        return part;
      },
      [&](const P& pair) { return Part::terminal(detail::overlay_value<U>(op, early, pair)); },
      [](std::span<Part> parts, const P& pair) {
        // A cut that misses the region divides nothing.
        return parts.size() == 1 ? std::move(parts.front()) : detail::join(parts, pair);
      },
      executor));
}

template <std::equality_comparable T, class N, class E = skeleton::SequentialExecutor>
requires std::copyable<T> && std::copyable<N> Tree<T, N> merge_equal(const Tree<T, N>& tree,
                                                                     const E& executor = {}) {
  using Part = detail::Subtree<T, N>;
  return Tree<T, N>(traverse(
      tree, [](const T& terminal) { return Part::terminal(terminal); },
      [](std::span<Part> parts, const N& label) {
        bool equal = !parts.empty();
        for (Part& part : parts) {
          equal = equal && part.is_terminal() && part.terminal() == parts.front().terminal();
        }
        if (equal) return std::move(parts.front());
        return Part::interior({std::move_iterator(parts.begin()), std::move_iterator(parts.end())},
                              label);
      },
      executor));
}

template <std::copyable T, class N, class Scalar, std::size_t dimension>
requires Divides<Orthants, Cell<Scalar, dimension>, N> Tree<T, Cut<Scalar>> to_cuts(
    const Tree<T, N>& tree, const Cell<Scalar, dimension>& cell) {
  using Node = typename Tree<T, N>::Node;
  // A node, or those of its children whose cells are alike along the axes not cut yet.
  struct Part {
    Node node;
    Cell<Scalar, dimension> cell;  // of the node
    std::size_t first;
    std::size_t axes;  // still to be cut, from the last one down; none: the node is as it was
  };
  const auto begin = [](const Node& node, const Cell<Scalar, dimension>& cell_of_node) {
    if (!node.is_terminal() && node.degree() != std::size_t{1} << dimension) {
      throw Error(ErrorId::BadArgument,
                  {"a node of " + std::to_string(node.degree()) + " children",
                   std::to_string(std::size_t{1} << dimension) + " children everywhere"});
    }
    return Part{node, cell_of_node, 0, dimension};
  };
  const auto cut_of = [](const Part& part) {
    const std::size_t axis = part.axes - 1;
    return Cut<Scalar>{axis, Orthants{}(part.cell, part.node.label(), 0).upper[axis]};
  };
  return create(
      begin(tree.root(), cell), [](const Part& part) { return part.node.is_terminal(); },
      [&](const Part& part) {
        std::vector<Part> halves;
        for (const std::size_t above : {0U, 1U}) {
          const std::size_t axis = part.axes - 1;
          const std::size_t index = part.first + (above << axis);
          if (axis > 0) {
            halves.push_back({part.node, part.cell, index, axis});
          } else {
            halves.push_back(
                begin(part.node.child(index), Orthants{}(part.cell, part.node.label(), index)));
          }
        }
        return halves;
      },
      [](const Part& part) { return part.node.terminal(); }, unlimited_depth,
      skeleton::SequentialExecutor{}, cut_of);
}

}  // namespace exactcsg::gdt
