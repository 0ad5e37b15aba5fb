// SPDX-License-Identifier: Apache-2.0
#pragma once

// Balls of any dimension: discs bounded by circles, balls bounded by spheres. [Exact]

#include "exactcsg/domain/half_space.hpp"

namespace exactcsg::domain {

// {x : |x - centre|^2 <= squared_radius}; the radius itself need not be rational.
// THROWS Error(BadArgument) unless squared_radius > 0.
template <std::size_t D>
HalfSpace<D> make_ball(const Point<D>& centre, const Rational& squared_radius) {
  if (squared_radius <= 0) {
    throw Error(ErrorId::BadArgument,
                {"the squared radius " + to_text(squared_radius), "one above 0"});
  }
  Quadric<D> f(LinearForm<D>{{}, Rational(-squared_radius)});
  for (std::size_t i = 0; i < D; ++i) {
    LinearForm<D> offset{{}, Rational(-centre[i])};
    offset.normal[i] = 1;
    f = f + product(offset, offset);
  }
  return HalfSpace<D>(std::move(f));
}

inline HalfSpace<2> make_disc(const Point<2>& centre, const Rational& squared_radius) {
  return make_ball(centre, squared_radius);
}
inline HalfSpace<3> make_sphere(const Point<3>& centre, const Rational& squared_radius) {
  return make_ball(centre, squared_radius);
}

}  // namespace exactcsg::domain
