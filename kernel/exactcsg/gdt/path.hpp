// SPDX-License-Identifier: Apache-2.0
#pragma once

// A place in a decomposition tree that knows the way to it, and with it the cell. [Exact]
//
//   Path(tree, cell, division)            at the root, whose cell is `cell`
//   path.down(i), path.up()               to the i-th child; to the father
//   locate(tree, cell, division, point)   the terminal whose cell contains the point
//   neighbours(path, axis, side, visit)   the terminals on the other side of a face
//   follow(tree, state, choose, visit)    any other way through the tree, in order
//
// choose(const S&, const Node&, receive) is asked at an interior node, and gives the children to be
// visited, in order, to receive(index, S). visit is told every terminal with its cell or state; it
// returns nothing, or true to end the walk.
//
// LAW path.1  after down(i), up() leads back to the same node and cell.
// LAW path.2  cell() is the cell that the division gives along the way from the root.
// LAW locate.1  the cell of the terminal contains the point.
// LAW neighbours.1  visited are exactly the terminals whose cells have a facet in common with the
//                   given face of the path's cell (of positive area) and lie on its other side;
//                   none at the border of the root's cell.
// LAW follow.1  the terminals visited are those that choose leads to, in its order, up to the first
//               at which visit returns true; follow returns whether there was one.
// REQUIRES the tree outlives the path. THROWS Error(BadArgument): down with an index that is not
// there or at a terminal, up at the root, locate a point outside the cell. No recursion.
// COST: down O(1), up O(1); locate O(depth * degree); follow O(nodes visited * degree); neighbours
// the nodes between the cell and its neighbours. Memory O(depth), no change to the tree.
//
// Source: ours; Davy and Dew, section 6.1, miss ways that are not divide and conquer. Neighbours
// through the common ancestor after Samet (1984).

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "exactcsg/gdt/cell.hpp"
#include "exactcsg/gdt/tree.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg::gdt {

namespace detail {

// What visit returns, as "end the walk here".
template <class Visit, class... Arguments>
bool ends(Visit& visit, Arguments&&... arguments) {
  if constexpr (std::is_void_v<std::invoke_result_t<Visit&, Arguments...>>) {
    visit(std::forward<Arguments>(arguments)...);
    return false;
  } else {
    return static_cast<bool>(visit(std::forward<Arguments>(arguments)...));
  }
}

template <class Node, std::movable S, class Choose, class Visit>
bool follow_from(const Node& start, S state, Choose& choose, Visit& visit) {
  struct Place {
    Node node;
    S state;
  };
  std::vector<Place> pending;
  pending.push_back({start, std::move(state)});
  while (!pending.empty()) {
    const Place here = std::move(pending.back());
    pending.pop_back();
    if (here.node.is_terminal()) {
      if (ends(visit, here.node.terminal(), here.state)) return true;
      continue;
    }
    const auto others = static_cast<std::ptrdiff_t>(pending.size());
    choose(here.state, here.node, [&](std::size_t index, S next) {
      pending.push_back({here.node.child(index), std::move(next)});
    });
    std::reverse(pending.begin() + others, pending.end());
  }
  return false;
}

}  // namespace detail

template <class T, class N, std::movable S, class Choose, std::invocable<const T&, const S&> Visit>
bool follow(const Tree<T, N>& tree, S state, Choose&& choose, Visit&& visit) {
  return detail::follow_from(tree.root(), std::move(state), choose, visit);
}

template <class T, class N, std::copyable C, Divides<C, N> Division>
class Path {
 public:
  using Node = typename Tree<T, N>::Node;

  Path(const Tree<T, N>& tree, C cell, Division division = {}) : division_(std::move(division)) {
    steps_.push_back({tree.root(), std::move(cell), 0});
  }

  const Node& node() const noexcept { return steps_.back().node; }
  const C& cell() const noexcept { return steps_.back().cell; }
  bool is_terminal() const noexcept { return node().is_terminal(); }
  bool is_root() const noexcept { return steps_.size() == 1; }
  std::size_t depth() const noexcept { return steps_.size() - 1; }  // the root's is 0
  // Which child of its father this is; 0 at the root.
  std::size_t index() const noexcept { return steps_.back().index; }
  const Division& division() const noexcept { return division_; }
  // The cell that the i-th child has. REQUIRES !is_terminal()
  C cell_of_child(std::size_t i) const { return division_(cell(), node().label(), i); }

  void down(std::size_t i) {
    if (is_terminal() || i >= node().degree()) {
      throw Error(ErrorId::BadArgument,
                  {"child " + std::to_string(i),
                   "one of " + std::to_string(is_terminal() ? 0 : node().degree()) + " children"});
    }
    steps_.push_back({node().child(i), cell_of_child(i), i});
  }
  void up() {
    if (is_root()) throw Error(ErrorId::BadArgument, {"the father of the root", "another node"});
    steps_.pop_back();
  }

 private:
  struct Step {
    Node node;
    C cell;
    std::size_t index;
  };
  std::vector<Step> steps_;
  Division division_;
};
template <class T, class N, class C, class Division>
Path(const Tree<T, N>&, C, Division) -> Path<T, N, C, Division>;

template <class T, class N, BoxCell C, Divides<C, N> Division, class Point>
Path<T, N, C, Division> locate(const Tree<T, N>& tree, C cell, Division division,
                               const Point& point) {
  Path path(tree, std::move(cell), std::move(division));
  bool inside = contains(path.cell(), point);
  while (inside && !path.is_terminal()) {
    std::size_t index = 0;
    while (index < path.node().degree() && !contains(path.cell_of_child(index), point)) ++index;
    inside = index < path.node().degree();
    if (inside) path.down(index);
  }
  if (!inside) throw Error(ErrorId::BadArgument, {"a point outside", "a point of the root's cell"});
  return path;
}

enum class Side : std::uint8_t { Lower, Upper };

// visit(const T&, const C&)
template <class T, class N, BoxCell C, class Division, std::invocable<const T&, const C&> Visit>
bool neighbours(Path<T, N, C, Division> path, std::size_t axis, Side side, Visit&& visit) {
  const C cell = path.cell();
  const auto face = [&](const C& c) { return (side == Side::Lower ? c.lower : c.upper)[axis]; };
  const auto plane = face(cell);
  while (!path.is_root() && face(path.cell()) == plane) path.up();
  if (face(path.cell()) == plane) return false;
  const auto across = [&](const C& c) {
    const bool at_plane = side == Side::Lower ? c.lower[axis] < plane && !(c.upper[axis] < plane)
                                              : plane < c.upper[axis] && !(plane < c.lower[axis]);
    if (!at_plane) return false;
    for (std::size_t a = 0; a < c.lower.size(); ++a) {
      if (a == axis) continue;
      if (!(c.lower[a] < cell.upper[a] && cell.lower[a] < c.upper[a])) return false;
    }
    return true;
  };
  const auto choose = [&](const C& from, const typename Path<T, N, C, Division>::Node& node,
                          auto&& receive) {
    for (std::size_t i = 0; i < node.degree(); ++i) {
      C part = path.division()(from, node.label(), i);
      if (across(part)) receive(i, std::move(part));
    }
  };
  return detail::follow_from(path.node(), path.cell(), choose, visit);
}

}  // namespace exactcsg::gdt
