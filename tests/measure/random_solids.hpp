// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Random primitives and small trees of them, about the size of the cube [-1, 1]^3. To be called
// within a property.

#include <rapidcheck.h>

#include "measure/curved_solids.hpp"

namespace exactcsg::measure::test {

inline Rational random_rational(int low, int high) {
  return Rational(*rc::gen::inRange(low * 12, high * 12 + 1)) / 12;
}
inline Point<3> random_point() {
  return point(random_rational(-1, 1), random_rational(-1, 1), random_rational(-1, 1));
}
inline Coordinates<3> random_direction() {
  Coordinates<3> direction;
  do {
    for (Rational& x : direction) x = *rc::gen::inRange(-3, 4);
  } while (direction == Coordinates<3>{});
  return direction;
}
inline Solid3 random_primitive() {
  const Rational size = random_rational(0, 1) + Rational(1, 12);
  const Axis axis{random_point(), random_direction()};
  switch (*rc::gen::inRange(0, 6)) {
    case 0:
      return ball(axis.point, size);
    case 1:
      return solid(domain::make_cylinder(axis, size));
    case 2:
      return solid(domain::make_cone(axis, size));
    case 3:
      return solid(domain::make_double_cone(axis, size));
    case 4:
      return solid(domain::make_ellipsoid<3>(axis.point, {size, 1, Rational(1, 3)}));
    default:
      return below(axis.direction, size);
  }
}
inline Solid3 random_solid() {
  Solid3 set = random_primitive();
  const int operations = *rc::gen::inRange(0, 3);
  for (int i = 0; i < operations; ++i) {
    const Solid3 other = random_primitive();
    switch (*rc::gen::inRange(0, 4)) {
      case 0:
        set = csg::unite(set, other);
        break;
      case 1:
        set = csg::intersect(set, other);
        break;
      case 2:
        set = csg::subtract(set, other);
        break;
      default:
        set = Solid3::compose(csg::BooleanOperator::SymmetricDifference, {set, other});
    }
  }
  return set;
}

}  // namespace exactcsg::measure::test
