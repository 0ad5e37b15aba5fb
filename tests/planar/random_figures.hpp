// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Random trees of random figures, most of them with much in common: corners and edges of a small
// grid, paths that cross themselves, holes that touch.

#include <cstdint>
#include <vector>

#include "io/planar_support.hpp"

namespace exactcsg::test {

class RandomFigures {
 public:
  // Coordinates are in {0, ..., grid}, then mapped.
  RandomFigures(std::uint32_t seed, int grid, io::AffineMap2 map)
      : state_(seed * 2654435761U + 1), grid_(grid), map_(std::move(map)) {}

  int below(int n) {
    state_ = state_ * 1664525U + 1013904223U;
    return static_cast<int>((state_ >> 8U) % static_cast<std::uint32_t>(n));
  }

  PlanarTree tree(int depth) {
    if (depth == 0 || below(5) == 0) return PlanarTree::primitive(figure());
    std::vector<PlanarTree> operands;
    const int count = 2 + below(3);
    for (int i = 0; i < count; ++i) {
      if (i > 0 && below(6) == 0) {
        operands.push_back(operands[static_cast<std::size_t>(below(i))]);  // shared
      } else {
        operands.push_back(tree(depth - 1));
      }
    }
    return PlanarTree::compose(static_cast<csg::BooleanOperator>(below(4)), std::move(operands));
  }

  PlanarFigure figure() {
    PlanarFigure figure;
    const int paths = 1 + below(3) / 2 + below(6) / 5;
    for (int i = 0; i < paths; ++i) figure.paths.push_back(path());
    return figure;
  }

 private:
  Point2 point(int x, int y) const {
    const auto& m = map_.m;
    return {m[0][0] * x + m[0][1] * y + m[0][2], m[1][0] * x + m[1][1] * y + m[1][2]};
  }

  std::vector<Point2> path() {
    std::vector<Point2> path;
    const int x = below(grid_);
    const int y = below(grid_);
    const int width = 1 + below(grid_ - x);
    const int height = 1 + below(grid_ - y);
    switch (below(3)) {
      case 0:
        return {point(x, y), point(x + width, y), point(x + width, y + height),
                point(x, y + height)};
      case 1:
        return {point(x, y), point(x + width, y), point(x, y + height)};
      default:
        break;
    }
    const int corners = 3 + below(6);
    for (int i = 0; i < corners; ++i) path.push_back(point(below(grid_ + 1), below(grid_ + 1)));
    return path;
  }

  std::uint32_t state_;
  int grid_;
  io::AffineMap2 map_;
};

}  // namespace exactcsg::test
