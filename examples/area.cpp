// SPDX-License-Identifier: GPL-3.0-or-later
// The area of a planar solid by subdivision: by a decomposition tree that is kept, and on the fly.
//
// A square of side 3/4 with a square hole of side 1/4 has straight edges on the grid of depth 3:
// from there on its area is exact, 9/16 - 1/16 = 1/2. A disc of radius 1/8 in the hole adds pi /
// 64, which the sums of cells enclose: those that are full, and with those that the circle crosses.

#include <array>
#include <iostream>
#include <span>
#include <vector>

#include "exactcsg/csg/prune.hpp"
#include "exactcsg/csg/tree.hpp"
#include "exactcsg/domain/half_spaces.hpp"
#include "exactcsg/gdt/cell.hpp"
#include "exactcsg/gdt/create.hpp"
#include "exactcsg/gdt/traverse.hpp"

namespace {

using namespace exactcsg;
using Cell = gdt::Cell<Rational, 2>;
using Solid = csg::Tree<domain::HalfSpace<2>, csg::BooleanOperator>;

Solid square(const Rational& from, const Rational& to) {
  const std::array<domain::Point<2>, 4> corner{{{from, from}, {to, from}, {to, to}, {from, to}}};
  Solid result = Solid::full();
  for (std::size_t i = 0; i < 4; ++i) {
    const auto side = domain::make_line(corner[i], corner[(i + 1) % 4]);
    result = csg::intersect(result, Solid::primitive(side));
  }
  return result;
}

// A cell, and the solid as far as it matters there.
struct Local {
  Cell cell;
  Solid solid;
  int depth = 0;
};

bool is_decided(const Local& local) { return local.solid.is_empty() || local.solid.is_full(); }

std::vector<Local> quadrants(const Local& local) {
  std::vector<Local> parts;
  for (std::size_t i = 0; i < 4; ++i) {
    const Cell cell = gdt::Orthants()(local.cell, gdt::NoLabel(), i);
    const domain::Box<2> box(cell.lower, cell.upper);
    const auto solid = csg::prune(local.solid, [&](const auto& h) { return classify(h, box); });
    parts.push_back({cell, solid, local.depth + 1});
  }
  return parts;
}

// Of cells that are full, and of those that are neither full nor empty.
struct Area {
  Rational full = 0;
  Rational undecided = 0;
};

Area area_of(const Local& local) {
  if (local.solid.is_empty()) return {};
  const auto& [lower, upper] = local.cell;
  const Rational size = (upper[0] - lower[0]) * (upper[1] - lower[1]);
  return local.solid.is_full() ? Area{size, 0} : Area{0, size};
}

Area sum(std::span<Area> parts) {
  Area total;
  for (const Area& part : parts) {
    total.full += part.full;
    total.undecided += part.undecided;
  }
  return total;
}

void print(const Area& area) {
  std::cout << area.full << " to " << Rational(area.full + area.undecided) << '\n';
}

}  // namespace

int main() {
  const Solid frame = csg::subtract(square({1, 8}, {7, 8}), square({1, 4}, {1, 2}));
  const auto disc = domain::make_disc({Rational(3, 8), Rational(3, 8)}, {1, 64});
  const Local with_disc{{{0, 0}, {1, 1}}, csg::unite(frame, Solid::primitive(disc))};
  for (const std::size_t depth : {3, 5, 7}) {
    const auto tree = gdt::create(
        with_disc, is_decided, quadrants, [](const Local& local) { return area_of(local); }, depth);
    std::cout << "by a tree of depth " << depth << ": ";
    print(gdt::traverse(
        tree, [](const Area& area) { return area; }, sum));
  }
  std::cout << "the frame alone, on the fly: ";
  print(skeleton::divacon(
      Local{with_disc.cell, frame}, [](const Local& l) { return l.depth == 3 || is_decided(l); },
      quadrants, area_of, sum));
}
