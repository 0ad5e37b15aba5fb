// SPDX-License-Identifier: GPL-3.0-or-later
// Point membership classification, the first example of Davy and Dew (section 3.2), with what they
// leave out: On combined correctly. A ball with a cylindrical hole, a block that shares a face with
// another; every answer is exact, also for points on several surfaces.
//
// ball x^2 + y^2 + z^2 <= 9, hole x^2 + y^2 <= 5: the rim of the hole is at z = +-2.

#include <array>
#include <iostream>
#include <string_view>

#include "exactcsg/domain/bounded_primitives.hpp"
#include "exactcsg/domain/classify.hpp"

namespace {

using namespace exactcsg;
using domain::Point;
using domain::Solid3;

std::string_view name(PointClass value) {
  constexpr std::array<std::string_view, 3> names{"out", "on", "in"};
  return names[static_cast<std::size_t>(value)];
}

void show(std::string_view what, const Solid3& solid, const Point<3>& p) {
  std::cout << what << " (" << p[0] << ", " << p[1] << ", " << p[2]
            << "): " << name(classify(solid, p)) << '\n';
}

}  // namespace

int main() {
  const Solid3 ball = domain::make_bounded_ball({0, 0, 0}, 9);
  const Solid3 hole = Solid3::primitive(domain::make_cylinder({{0, 0, 0}, {0, 0, 1}}, 5));
  const Solid3 drilled = csg::subtract(ball, hole);
  show("drilled ball", drilled, {0, 0, 0});
  show("drilled ball", drilled, {2, 1, 1});  // on the wall of the hole
  show("drilled ball", drilled, {2, 1, 2});  // on its rim
  show("drilled ball", drilled, {2, 2, 0});
  show("drilled ball", drilled, {2, 2, 1});  // on the ball: 4 + 4 + 1 = 9

  const Solid3 left = domain::make_block({{0, 0, 0}, {1, 1, 1}});
  const Solid3 right = domain::make_block({{1, 0, 0}, {2, 1, 1}});
  const Rational half(1, 2);
  const Point<3> of_common_face(1, half, half);
  show("union of blocks", csg::unite(left, right), of_common_face);
  show("union of blocks", csg::unite(left, right), {1, 0, half});
  show("intersection of blocks", csg::intersect(left, right), of_common_face);
  show("difference of blocks", csg::subtract(left, right), of_common_face);

  const Solid3 plug = csg::intersect(ball, hole);
  show("hole and plug", csg::unite(drilled, plug), {2, 1, 1});  // filled again
  show("hole and plug", csg::unite(drilled, plug), {2, 1, 2});
}
