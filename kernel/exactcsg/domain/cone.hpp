// SPDX-License-Identifier: Apache-2.0
#pragma once

// Unbounded circular cones round any axis, of one nappe or two. The apex is the axis's point.
// [Exact]

#include "exactcsg/domain/axis.hpp"
#include "exactcsg/domain/half_space.hpp"

namespace exactcsg::domain {

namespace detail {

inline Quadric<3> cone_polynomial(const Axis& axis, const Rational& squared_slope) {
  check(axis);
  if (squared_slope <= 0) {
    throw Error(ErrorId::BadArgument,
                {"the squared slope " + to_text(squared_slope), "one above 0"});
  }
  const LinearForm<3> along = height(axis);
  return squared_distance(axis) + Rational(-squared_slope) * product(along, along);
}

}  // namespace detail

// The points whose distance from the axis is at most slope times that from the plane through the
// apex across the axis. slope is the tangent of the half angle at the apex.
// THROWS Error(BadArgument) unless squared_slope > 0 and the axis has a direction.
inline HalfSpace<3> make_double_cone(const Axis& axis, const Rational& squared_slope) {
  return HalfSpace<3>(detail::cone_polynomial(axis, squared_slope));
}

// The nappe that the axis's direction points into. THROWS the same.
inline HalfSpace<3> make_cone(const Axis& axis, const Rational& squared_slope) {
  LinearForm<3> behind = detail::height(axis);
  for (Rational& component : behind.normal) component = -component;
  behind.constant = -behind.constant;
  return {detail::cone_polynomial(axis, squared_slope), std::move(behind)};
}

}  // namespace exactcsg::domain
