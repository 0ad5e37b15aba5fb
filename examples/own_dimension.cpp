// SPDX-License-Identifier: GPL-3.0-or-later
// A user's own dimension: boxes of four-dimensional space, and the measure of a solid made of them
// by cutting space at the faces of the boxes.
//
// A box of side 3 less a box of side 1 inside it: 3^4 - 1^4 = 80. With a second hole of the same
// size that shares half of its volume with the first along one axis, 3^4 - 1 - 1/2 = 79 1/2.

#include <array>
#include <cstddef>
#include <iostream>
#include <span>
#include <vector>

#include "exactcsg/csg/prune.hpp"
#include "exactcsg/csg/tree.hpp"
#include "exactcsg/gdt/cell.hpp"
#include "exactcsg/skeleton/divacon.hpp"

namespace {

using namespace exactcsg;
using Box = gdt::Cell<double, 4>;
using Solid = csg::Tree<Box, csg::BooleanOperator>;

csg::Membership classify(const Box& box, const Box& cell) {
  bool inside = true;
  for (std::size_t axis = 0; axis < 4; ++axis) {
    if (cell.upper[axis] <= box.lower[axis] || box.upper[axis] <= cell.lower[axis]) {
      return csg::Membership::Out;
    }
    inside = inside && box.lower[axis] <= cell.lower[axis] && cell.upper[axis] <= box.upper[axis];
  }
  return inside ? csg::Membership::In : csg::Membership::Unknown;
}

struct Local {
  Box cell;
  Solid solid;
};

// In two, at a face of some box that the cell does not lie in yet.
std::vector<Local> divide(const Local& local) {
  gdt::Cut<double> cut{0, 0};
  csg::for_each_primitive(local.solid, [&](const Box& box) {
    for (std::size_t axis = 0; axis < 4; ++axis) {
      for (const double at : {box.lower[axis], box.upper[axis]}) {
        if (local.cell.lower[axis] < at && at < local.cell.upper[axis]) cut = {axis, at};
      }
    }
  });
  std::vector<Local> parts;
  for (std::size_t i = 0; i < 2; ++i) {
    const Box cell = gdt::Cuts()(local.cell, cut, i);
    parts.push_back(
        {cell, csg::prune(local.solid, [&](const Box& box) { return classify(box, cell); })});
  }
  return parts;
}

double measure(const Solid& solid) {
  return skeleton::divacon(
      Local{{{-9, -9, -9, -9}, {9, 9, 9, 9}}, solid},
      [](const Local& local) { return local.solid.is_empty() || local.solid.is_full(); }, divide,
      [](const Local& local) {
        if (local.solid.is_empty()) return 0.0;
        double product = 1;
        for (std::size_t axis = 0; axis < 4; ++axis) {
          product *= local.cell.upper[axis] - local.cell.lower[axis];
        }
        return product;
      },
      [](std::span<double> parts) { return parts[0] + parts[1]; });
}

}  // namespace

int main() {
  const Solid block = Solid::primitive({{0, 0, 0, 0}, {3, 3, 3, 3}});
  const Solid hole = Solid::primitive({{1, 1, 1, 1}, {2, 2, 2, 2}});
  const Solid shifted = Solid::primitive({{1.5, 1, 1, 1}, {2.5, 2, 2, 2}});
  std::cout << measure(csg::subtract(block, hole)) << '\n'
            << measure(csg::subtract(block, csg::unite(hole, shifted))) << '\n';
}
