// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Degenerate trees: a million operators, each below the other.

#include <utility>
#include <vector>

#include "exactcsg/csg/tree.hpp"

namespace exactcsg::csg::test {

enum class Side { Left, Right, Single };

// Left: op(op(op(p0, p1), p2), ...); Right: op(..., op(p2, op(p1, p0))); Single: op(op(op(p0))).
template <class P>
BooleanTree<P> chain(int operators, BooleanOperator operation, Side side, P primitive) {
  using T = BooleanTree<P>;
  T tree = T::primitive(primitive);
  for (int i = 0; i < operators; ++i) {
    std::vector<T> children;
    if (side == Side::Right) children.push_back(T::primitive(primitive));
    children.push_back(std::move(tree));
    if (side == Side::Left) children.push_back(T::primitive(primitive));
    tree = T::compose(operation, std::move(children));
  }
  return tree;
}

}  // namespace exactcsg::csg::test
