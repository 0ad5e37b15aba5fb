// SPDX-License-Identifier: Apache-2.0
#pragma once

// Half-planes, bounded by a line. [Exact]

#include "exactcsg/domain/half_space.hpp"

namespace exactcsg::domain {

// {(x, y) : a x + b y + c <= 0}, the side of the line away from the outward normal (a, b).
// THROWS Error(DegenerateHalfSpace) if a = b = 0.
inline HalfSpace<2> make_line(const Rational& a, const Rational& b, const Rational& c) {
  if (a == 0 && b == 0) throw Error(ErrorId::DegenerateHalfSpace, {"the line's normal (0, 0)", ""});
  return HalfSpace<2>(Quadric<2>(LinearForm<2>{{a, b}, c}));
}

// The half-plane to the left of the way from p to q. THROWS Error(DegenerateHalfSpace) if p = q.
inline HalfSpace<2> make_line(const Point<2>& p, const Point<2>& q) {
  const Rational a = q[1] - p[1];
  const Rational b = p[0] - q[0];
  return make_line(a, b, Rational(-a * p[0] - b * p[1]));
}

}  // namespace exactcsg::domain
