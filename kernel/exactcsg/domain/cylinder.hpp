// SPDX-License-Identifier: Apache-2.0
#pragma once

// Unbounded circular cylinders round any axis. [Exact]

#include "exactcsg/domain/axis.hpp"
#include "exactcsg/domain/half_space.hpp"

namespace exactcsg::domain {

// The points at a distance of at most the radius from the axis.
// THROWS Error(BadArgument) unless squared_radius > 0 and the axis has a direction.
inline HalfSpace<3> make_cylinder(const Axis& axis, const Rational& squared_radius) {
  detail::check(axis);
  if (squared_radius <= 0) {
    throw Error(ErrorId::BadArgument,
                {"the squared radius " + to_text(squared_radius), "one above 0"});
  }
  const Rational scaled = squared_radius * detail::squared_length(axis.direction);
  return HalfSpace<3>(detail::squared_distance(axis) +
                      Quadric<3>(LinearForm<3>{{}, Rational(-scaled)}));
}

}  // namespace exactcsg::domain
