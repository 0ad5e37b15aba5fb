// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Random decomposition trees of boxes, and the value of a tree at a point, found in the plainest
// way.

#include <array>
#include <cstddef>
#include <random>
#include <vector>

#include "exactcsg/gdt/cell.hpp"
#include "exactcsg/gdt/tree.hpp"

namespace exactcsg::gdt::test {

inline int below(std::mt19937& random, int n) {
  return static_cast<int>(random() % static_cast<unsigned>(n));
}

template <std::size_t dimension>
Cell<int, dimension> cube(int size) {
  Cell<int, dimension> cell;
  cell.lower.fill(0);
  cell.upper.fill(size);
  return cell;
}

// Quadtrees, octrees and their like of at most `depth` levels; the values are below `values`.
template <std::size_t dimension>
Tree<int> random_orthants(std::mt19937& random, int depth, int values) {
  if (depth == 0 || below(random, 4) == 0) return Tree<int>::terminal(below(random, values));
  std::vector<Tree<int>> children;
  for (std::size_t i = 0; i < std::size_t{1} << dimension; ++i) {
    children.push_back(random_orthants<dimension>(random, depth - 1, values));
  }
  return Tree<int>::interior(std::move(children));
}

// Unequal cuts along any axis, in any order.
template <std::size_t dimension>
Tree<int, Cut<int>> random_cuts(std::mt19937& random, const Cell<int, dimension>& cell, int depth,
                                int values) {
  const auto axis = static_cast<std::size_t>(below(random, dimension));
  const int size = cell.upper[axis] - cell.lower[axis];
  if (depth == 0 || size < 2 || below(random, 6) == 0) {
    return Tree<int, Cut<int>>::terminal(below(random, values));
  }
  const Cut<int> cut{axis, cell.lower[axis] + 1 + below(random, size - 1)};
  std::vector<Tree<int, Cut<int>>> children;
  for (const std::size_t i : {0U, 1U}) {
    children.push_back(random_cuts(random, Cuts{}(cell, cut, i), depth - 1, values));
  }
  return Tree<int, Cut<int>>::interior(std::move(children), cut);
}

// Independent of Orthants, Cuts, descend and follow.
template <class T, class Point>
const T& value_at(const Tree<T>& tree, int size, const Point& point) {
  auto node = tree.root();
  for (int half = size / 2; !node.is_terminal(); half /= 2) {
    std::size_t index = 0;
    for (std::size_t axis = 0; axis < point.size(); ++axis) {
      if (point[axis] / half % 2 != 0) index += std::size_t{1} << axis;
    }
    node = node.child(index);
  }
  return node.terminal();
}
template <class T, class Point>
const T& value_at(const Tree<T, Cut<int>>& tree, int, const Point& point) {
  auto node = tree.root();
  while (!node.is_terminal()) {
    node = node.child(point[node.label().axis] < node.label().at ? 0 : 1);
  }
  return node.terminal();
}

// Every point with integer coordinates in the cube: one for every unit cell.
template <std::size_t dimension, class Visit>
void for_each_point(int size, Visit&& visit) {
  Coordinates<int, dimension> point{};
  for (;;) {
    visit(point);
    std::size_t axis = 0;
    while (axis < dimension && ++point[axis] == size) point[axis++] = 0;
    if (axis == dimension) return;
  }
}

}  // namespace exactcsg::gdt::test
