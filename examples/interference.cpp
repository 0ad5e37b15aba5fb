// SPDX-License-Identifier: GPL-3.0-or-later
// Do two solids have points in common? The intersection is pruned to smaller and smaller boxes: a
// box in which it is Full is a proof that they do, and if it is Empty everywhere they do not. Where
// boxes of the smallest size are left, they may touch.
//
// Two balls of radius 1 with a gap between them: negative, they overlap; zero, they touch.

#include <array>
#include <iostream>
#include <string>
#include <vector>

#include "exactcsg/csg/prune.hpp"
#include "exactcsg/csg/tree.hpp"
#include "exactcsg/domain/half_spaces.hpp"
#include "exactcsg/gdt/cell.hpp"

namespace {

using namespace exactcsg;
using Solid = csg::Tree<domain::HalfSpace<3>, csg::BooleanOperator>;

struct Region {
  gdt::Cell<Rational, 3> cell;
  Solid solid;
  int depth;
};

Region pruned(const gdt::Cell<Rational, 3>& cell, const Solid& solid, int depth) {
  const domain::Box<3> box(cell.lower, cell.upper);
  return {cell,
          csg::prune(solid, [&](const auto& half_space) { return classify(half_space, box); }),
          depth};
}

std::string interference(const Solid& a, const Solid& b) {
  constexpr int deepest = 7;
  std::vector<Region> open{pruned({{-4, -4, -4}, {4, 4, 4}}, csg::intersect(a, b), 0)};
  std::size_t undecided = 0;
  while (!open.empty()) {
    const Region region = open.back();
    open.pop_back();
    if (region.solid.is_empty()) continue;
    if (region.solid.is_full()) {
      return "they share a box of side " +
             to_text(Rational(region.cell.upper[0] - region.cell.lower[0]));
    }
    if (region.depth == deepest) {
      ++undecided;
      continue;
    }
    for (std::size_t i = 0; i < 8; ++i) {
      const auto octant = gdt::Orthants()(region.cell, gdt::NoLabel(), i);
      open.push_back(pruned(octant, region.solid, region.depth + 1));
    }
  }
  return undecided == 0 ? "they have no volume in common"
                        : std::to_string(undecided) + " boxes are left undecided";
}

}  // namespace

int main() {
  const Solid ball = Solid::primitive(domain::make_sphere({0, 0, 0}, 1));
  for (const Rational& gap : {Rational(-1, 4), Rational(0), Rational(1, 64)}) {
    const Solid other = Solid::primitive(domain::make_sphere({Rational(2 + gap), 0, 0}, 1));
    std::cout << "gap " << gap << ": " << interference(ball, other) << '\n';
  }
}
