// SPDX-License-Identifier: GPL-3.0-or-later
// The polar moment of inertia of a planar solid about any point, from a decomposition tree that is
// made once: the point is the traversal's external data.
//
// A square of side 2 with a square hole of side 1, both about the origin: a square of side s has
// s^4 / 6 about its middle, so 16/6 - 1/6 = 5/2 with an area of 3; about a point at the distance d
// it has 3 d^2 more (Steiner).

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

Solid square(const Rational& half) {
  Solid result = Solid::full();
  for (const auto& [a, b] : std::array<std::array<int, 2>, 4>{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}}) {
    result = csg::intersect(result, Solid::primitive(domain::make_line(a, b, Rational(-half))));
  }
  return result;
}

struct Local {
  Cell cell;
  Solid solid;
};

// The integral of |p - about|^2 over a rectangle.
Rational moment(const Cell& cell, const domain::Point<2>& about) {
  const auto integral = [&](std::size_t axis, int power) {
    const auto antiderivative = [&](const Rational& x) {
      Rational value = x;
      for (int i = 0; i < power; ++i) value *= x;
      return Rational(value / (power + 1));
    };
    return Rational(antiderivative(cell.upper[axis] - about[axis]) -
                    antiderivative(cell.lower[axis] - about[axis]));
  };
  return integral(0, 2) * integral(1, 0) + integral(0, 0) * integral(1, 2);
}

}  // namespace

int main() {
  const Solid frame = csg::subtract(square(1), square({1, 2}));
  const auto tree = gdt::create(
      Local{{{-2, -2}, {2, 2}}, frame},
      [](const Local& local) { return local.solid.is_empty() || local.solid.is_full(); },
      [](const Local& local) {
        std::vector<Local> parts;
        for (std::size_t i = 0; i < 4; ++i) {
          const Cell cell = gdt::Orthants()(local.cell, gdt::NoLabel(), i);
          const domain::Box<2> box(cell.lower, cell.upper);
          parts.push_back({cell, csg::prune(local.solid, [&](const auto& half_space) {
                             return classify(half_space, box);
                           })});
        }
        return parts;
      },
      [](Local local) { return local; });
  for (const domain::Point<2>& about :
       {domain::Point<2>(0, 0), domain::Point<2>(1, 0), domain::Point<2>(3, 4)}) {
    const Rational result = gdt::traverse(
        tree, about,
        [](const Local& local, const domain::Point<2>& point) {
          return local.solid.is_full() ? moment(local.cell, point) : Rational(0);
        },
        [](std::span<Rational> parts) {
          Rational sum = 0;
          for (const Rational& part : parts) sum += part;
          return sum;
        });
    std::cout << "about (" << about[0] << ", " << about[1] << "): " << result << '\n';
  }
}
