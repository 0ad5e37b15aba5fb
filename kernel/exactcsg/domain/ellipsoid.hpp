// SPDX-License-Identifier: Apache-2.0
#pragma once

// Axis-parallel ellipsoids of any dimension; turn them by apply. [Exact]

#include "exactcsg/domain/half_space.hpp"

namespace exactcsg::domain {

// {x : sum of (x_i - centre_i)^2 / squared_semi_axes_i <= 1}
// THROWS Error(BadArgument) unless all squared_semi_axes > 0.
template <std::size_t D>
HalfSpace<D> make_ellipsoid(const Point<D>& centre, const Coordinates<D>& squared_semi_axes) {
  Quadric<D> f(LinearForm<D>{{}, Rational(-1)});
  for (std::size_t i = 0; i < D; ++i) {
    if (squared_semi_axes[i] <= 0) {
      throw Error(ErrorId::BadArgument,
                  {"the squared semi-axis " + to_text(squared_semi_axes[i]), "one above 0"});
    }
    LinearForm<D> offset{{}, Rational(-centre[i])};
    offset.normal[i] = 1;
    f = f + Rational(1 / squared_semi_axes[i]) * product(offset, offset);
  }
  return HalfSpace<D>(std::move(f));
}

}  // namespace exactcsg::domain
