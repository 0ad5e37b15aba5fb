// SPDX-License-Identifier: GPL-3.0-or-later
// An edge classified against a solid: the parts of a segment that are in, on and out of it, with
// their ends as exact numbers a + b sqrt(c) (Tilove's line/solid classification, by the traversal
// of Davy and Dew, section 3.2).
//
// The solid is the union of a block [0, 2]^3 and a ball of radius sqrt(2) round (2, 0, 1). The
// first segment runs along an edge of the block until it enters the ball (|x - 2| = sqrt(2 - 1) at
// y = 0, z = 0, so x = 1 and x = 3); the second runs in the block's face z = 2 as far as x = 2;
// the third meets the ball alone, where (x - 2)^2 = 2 - 1/4 - 1.

#include <array>
#include <iostream>
#include <string_view>

#include "exactcsg/domain/bounded_primitives.hpp"
#include "exactcsg/domain/classify.hpp"

namespace {

using namespace exactcsg;
using domain::Point;

std::string_view name(PointClass value) {
  constexpr std::array<std::string_view, 3> names{"out", "on", "in"};
  return names[static_cast<std::size_t>(value)];
}

void print(const QuadraticNumber& t) {
  std::cout << t.rational_part();
  if (t.factor() > 0) std::cout << " + " << t.factor() << " sqrt(" << t.radicand() << ')';
  if (t.factor() < 0) {
    std::cout << " - " << Rational(-t.factor()) << " sqrt(" << t.radicand() << ')';
  }
}

void show(const domain::Solid3& solid, const Point<3>& from, const Point<3>& to) {
  const domain::Section found = simplified(section(solid, domain::segment(from, to)));
  std::cout << "from 0";
  for (std::size_t i = 0; i < found.between.size(); ++i) {
    std::cout << " to ";
    if (i < found.crossings.size()) {
      print(*found.crossings[i].parameter.quadratic());
    } else {
      std::cout << 1;
    }
    std::cout << ": " << name(found.between[i]) << (i + 1 < found.between.size() ? ";" : "\n");
  }
}

}  // namespace

int main() {
  const domain::Solid3 solid = csg::unite(domain::make_block({{0, 0, 0}, {2, 2, 2}}),
                                          domain::make_bounded_ball({2, 0, 1}, 2));
  show(solid, {-1, 0, 0}, {4, 0, 0});
  show(solid, {0, 1, 2}, {3, 1, 2});
  show(solid, {-1, Rational(-1, 2), 0}, {4, Rational(-1, 2), 0});
}
