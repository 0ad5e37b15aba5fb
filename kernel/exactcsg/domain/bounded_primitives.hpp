// SPDX-License-Identifier: Apache-2.0
#pragma once

// The bounded primitives of constructive solid geometry as trees of half-spaces. [Exact]
//
// Every one is convex, with an interior: THROWS Error(BadArgument) otherwise.
//
// Source: Davy and Dew, section 4 (GEL's module of bounded primitives).

#include <vector>

#include "exactcsg/csg/tree.hpp"
#include "exactcsg/domain/half_spaces.hpp"

namespace exactcsg::domain {

using Solid3 = csg::BooleanTree<HalfSpace<3>>;

namespace detail {

inline Solid3 intersection(std::vector<HalfSpace<3>> half_spaces) {
  std::vector<Solid3> operands;
  for (HalfSpace<3>& half_space : half_spaces) {
    operands.push_back(Solid3::primitive(std::move(half_space)));
  }
  return Solid3::compose(csg::BooleanOperator::Intersection, std::move(operands));
}

inline std::vector<HalfSpace<3>> sides(const Box<3>& box) {
  std::vector<HalfSpace<3>> result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Coordinates<3> normal;
    normal[axis] = -1;
    result.push_back(make_plane(normal, box.lower()[axis]));
    normal[axis] = 1;
    result.push_back(make_plane(normal, Rational(-box.upper()[axis])));
  }
  return result;
}

// Between the planes across the axis through its point and through point + direction.
inline std::vector<HalfSpace<3>> slab(const Axis& axis) {
  check(axis);
  const LinearForm<3> up = height(axis);
  const Coordinates<3> down{Rational(-up.normal[0]), Rational(-up.normal[1]),
                            Rational(-up.normal[2])};
  return {make_plane(down, Rational(-up.constant)),
          make_plane(up.normal, Rational(up.constant - squared_length(axis.direction)))};
}

}  // namespace detail

inline Solid3 make_block(const Box<3>& box) { return detail::intersection(detail::sides(box)); }

inline Solid3 make_bounded_ball(const Point<3>& centre, const Rational& squared_radius) {
  return Solid3::primitive(make_sphere(centre, squared_radius));
}

// From the axis's point to point + direction.
inline Solid3 make_bounded_cylinder(const Axis& axis, const Rational& squared_radius) {
  std::vector<HalfSpace<3>> half_spaces = detail::slab(axis);
  half_spaces.push_back(make_cylinder(axis, squared_radius));
  return detail::intersection(std::move(half_spaces));
}

// Its base is the disc round the axis's point, its apex point + direction.
inline Solid3 make_bounded_cone(const Axis& axis, const Rational& squared_radius) {
  std::vector<HalfSpace<3>> half_spaces = detail::slab(axis);
  half_spaces.pop_back();
  Axis from_apex = axis;
  Coordinates<3> apex;
  for (std::size_t i = 0; i < 3; ++i) {
    apex[i] = axis.point[i] + axis.direction[i];
    from_apex.direction[i] = -axis.direction[i];
  }
  from_apex.point = apex;
  half_spaces.push_back(
      make_cone(from_apex, Rational(squared_radius / detail::squared_length(axis.direction))));
  return detail::intersection(std::move(half_spaces));
}

// The half of the box at its lower corner that the plane through its vertical edges at (upper x,
// lower y) and (lower x, upper y) cuts off.
inline Solid3 make_wedge(const Box<3>& box) {
  std::vector<HalfSpace<3>> half_spaces = detail::sides(box);
  const Rational a = 1 / Rational(box.upper()[0] - box.lower()[0]);
  const Rational b = 1 / Rational(box.upper()[1] - box.lower()[1]);
  const Rational constant = -1 - a * box.lower()[0] - b * box.lower()[1];
  const HalfSpace<3> slope = make_plane({a, b, 0}, constant);
  // The sides at the upper x and the upper y touch in an edge only.
  return detail::intersection(
      {half_spaces[0], half_spaces[2], half_spaces[4], half_spaces[5], slope});
}

}  // namespace exactcsg::domain
