// SPDX-License-Identifier: Apache-2.0
#pragma once

// The decomposition tree of a recursive division. [Exact]
//
//   create(data, leaf, divide, solve [, max_depth [, executor [, label]]])
//
// leaf(const D&) -> bool, divide(D&) -> range of D, solve(D) -> T, as for divacon; label(D) -> N is
// given what divide has left of the data, so that a division found once (the plane of the cut) is
// stored in the data by divide and taken out by label.
//
// LAW create.1  create(x) == Terminal(solve(x)) if leaf(x) or the depth is max_depth (the root's is
//               0); else Interior([create(y) : y in divide(x)], label(x)).
// LAW create.2  leaf is not asked at max_depth.
// An instance of skeleton::divacon, with its laws of executors, exceptions and depth.
// COST: that of divacon, and O(nodes).
//
// Source: Davy and Dew, section 3.3.

#include <concepts>
#include <cstddef>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "exactcsg/gdt/tree.hpp"
#include "exactcsg/skeleton/divacon.hpp"

namespace exactcsg::gdt {

constexpr std::size_t unlimited_depth = std::numeric_limits<std::size_t>::max();

struct Unlabelled {
  template <class D>
  constexpr NoLabel operator()(D&&) const noexcept {
    return {};
  }
};

template <std::movable D, std::predicate<const D&> Leaf, class Divide,
          skeleton::detail::Takes<D> Solve, class E = skeleton::SequentialExecutor,
          skeleton::detail::Takes<D> Label = Unlabelled,
          class T = std::remove_cvref_t<skeleton::detail::Given<Solve, D>>,
          class N = std::remove_cvref_t<skeleton::detail::Given<Label, D>>>
requires std::invocable<Divide&, D&> Tree<T, N> create(D data, Leaf&& leaf, Divide&& divide,
                                                       Solve&& solve,
                                                       std::size_t max_depth = unlimited_depth,
                                                       const E& executor = {}, Label&& label = {}) {
  using Subtree = detail::Subtree<T, N>;
  struct Task {
    D data;
    std::size_t depth;
  };
  return Tree<T, N>(skeleton::divacon(
      Task{std::move(data), 0},
      [&](const Task& task) { return task.depth == max_depth || leaf(task.data); },
      [&](Task& task) {
        std::vector<Task> parts;
        for (auto&& part : divide(task.data)) {
          parts.push_back({D(std::move(part)), task.depth + 1});
        }
        return parts;
      },
      [&](Task&& task) { return Subtree::terminal(skeleton::detail::give(solve, task.data)); },
      [&](std::span<Subtree> children, Task&& task) {
        return Subtree::interior(
            {std::move_iterator(children.begin()), std::move_iterator(children.end())},
            skeleton::detail::give(label, task.data));
      },
      executor));
}

}  // namespace exactcsg::gdt
