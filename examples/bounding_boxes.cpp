// SPDX-License-Identifier: GPL-3.0-or-later
// A hierarchy of bounding boxes: a tree with a box at every node, which cuts off whatever a
// question does not reach.
//
// A row of 1000 balls of radius 1/4, one at every integer x, united in pairs, pairs of pairs and so
// on. Their boxes do not overlap, so that a point leaves at most one ball to be asked: the one
// whose box it is in.

#include <algorithm>
#include <array>
#include <iostream>
#include <optional>
#include <vector>

#include "exactcsg/csg/attributed.hpp"
#include "exactcsg/csg/traverse.hpp"
#include "exactcsg/csg/tree.hpp"

namespace {

using namespace exactcsg::csg;

using Vector = std::array<double, 3>;
struct Ball {
  Vector centre;
  double radius;
};
struct Box {
  Vector lower, upper;
};
using Solid = Tree<Ball, BooleanOperator>;

Box box_of(const Ball& ball) {
  Box box{ball.centre, ball.centre};
  for (std::size_t i = 0; i < 3; ++i) {
    box.lower[i] -= ball.radius;
    box.upper[i] += ball.radius;
  }
  return box;
}

// Also for intersections and differences, which are subsets of the union.
Box around_both(Box a, BooleanOperator, const Box& b) {
  for (std::size_t i = 0; i < 3; ++i) {
    a.lower[i] = std::min(a.lower[i], b.lower[i]);
    a.upper[i] = std::max(a.upper[i], b.upper[i]);
  }
  return a;
}

bool outside(const Box& box, const Vector& p) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (p[i] < box.lower[i] || box.upper[i] < p[i]) return true;
  }
  return false;
}

Solid row(int begin, int end) {
  if (end - begin == 1) return Solid::primitive({{static_cast<double>(begin), 0, 0}, 0.25});
  const int middle = begin + (end - begin) / 2;
  return unite(row(begin, middle), row(middle, end));
}

}  // namespace

int main() {
  const auto boxed = attribute(row(0, 1000), box_of, around_both);
  for (const Vector& point : {Vector{700.125, 0.125, 0}, Vector{700.5, 0, 0}, Vector{700, 1, 0}}) {
    int balls = 0;
    const auto inside = [&](const Ball& ball) {
      ++balls;
      double squared = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        squared += (point[i] - ball.centre[i]) * (point[i] - ball.centre[i]);
      }
      return squared <= ball.radius * ball.radius;
    };
    const auto cut_off = [&](const Box& box) {
      return outside(box, point) ? std::optional(false) : std::nullopt;
    };
    const bool in = traverse(boxed, CutOff{inside, cut_off},
                             [](bool a, BooleanOperator, bool b) { return a || b; });
    std::cout << (in ? "in" : "out") << ", " << balls << " of 1000 balls asked\n";
  }
}
