// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Degenerate trees: many operators, each below the other.

#include <utility>
#include <vector>

#include "exactcsg/csg/tree.hpp"

namespace exactcsg::csg::test {

// A million. Less under the sanitizers, where a million takes minutes; their stack frames are
// larger, so that it is still more calls than a stack of 8 MiB holds.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr int chain_depth = 200'000;
#else
inline constexpr int chain_depth = 1'000'000;
#endif

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
