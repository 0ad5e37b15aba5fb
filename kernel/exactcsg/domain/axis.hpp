// SPDX-License-Identifier: Apache-2.0
#pragma once

// The axis of a surface of revolution. [Exact]

#include "exactcsg/domain/quadric.hpp"

namespace exactcsg::domain {

// The line point + t direction. The direction need not have unit length; its length does not
// matter.
struct Axis {
  Point<3> point;
  Coordinates<3> direction;
};

namespace detail {

inline Rational squared_length(const Coordinates<3>& v) {
  return v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
}

// THROWS Error(BadArgument) if the direction is 0.
inline void check(const Axis& axis) {
  if (squared_length(axis.direction) == 0) {
    throw Error(ErrorId::BadArgument, {"an axis of direction (0, 0, 0)", "any other direction"});
  }
}

// (x - axis.point) . axis.direction, the height along the axis times the direction's length
inline LinearForm<3> height(const Axis& axis) {
  LinearForm<3> form{axis.direction, 0};
  form.constant = -form(axis.point.coordinates());
  return form;
}

// |(x - axis.point) x axis.direction|^2, the distance from the axis times the direction's length,
// squared
inline Quadric<3> squared_distance(const Axis& axis) {
  Quadric<3> sum;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const std::size_t k = (i + 2) % 3;
    LinearForm<3> component{};
    component.normal[j] = axis.direction[k];
    component.normal[k] = -axis.direction[j];
    component.constant = -component(axis.point.coordinates());
    sum = sum + product(component, component);
  }
  return sum;
}

}  // namespace detail

}  // namespace exactcsg::domain
