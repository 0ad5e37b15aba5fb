// SPDX-License-Identifier: GPL-3.0-or-later
// How many primitives a solid has: the smallest use of traverse. Shared subtrees count once for
// each place they stand in.

#include <iostream>

#include "exactcsg/csg/traverse.hpp"
#include "exactcsg/csg/tree.hpp"

int main() {
  using namespace exactcsg::csg;
  using Solid = Tree<const char*, BooleanOperator>;
  const Solid wheel = subtract(Solid::primitive("rim"), Solid::primitive("bore"));
  const Solid axle = unite(Solid::primitive("rod"), unite(wheel, wheel));
  const Solid cart = unite(Solid::primitive("box"), unite(axle, axle));
  // One box, two axles of one rod and two wheels of two primitives each: 1 + 2 (1 + 2 * 2) = 11.
  std::cout << traverse(
                   cart, [](const char*) { return 1; },
                   [](int a, BooleanOperator, int b) { return a + b; })
            << " primitives\n";
}
