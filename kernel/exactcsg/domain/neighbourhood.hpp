// SPDX-License-Identifier: Apache-2.0
#pragma once

// The neighbourhood of a point where several lines, circles or surfaces of degree two meet: what
// distinguishes In, On and Out there. [Exact]
//
// Round the point, the surfaces cut a small ball into cells. A cell is named by a germ, a curve
// that leaves the point into it: p + e d + e^(3/2) u for small e > 0, or p + e d + e^2 u where
// surfaces touch. The sign of f along it is that of the first non-zero one of g.d and g.u (or d'Ad
// + g.u), g the gradient of f at p.
//
// LAW germs.1  every germ lies in a cell, not on any surface, but perhaps on a cone whose apex is
//              the point.
// LAW germs.2  if `complete`, every cell has a germ.
//
// Lines and circles in the plane are always complete: two that touch differ in curvature. In space,
// complete are: any number of planes; surfaces whose tangent planes are different, three of which
// share a line only if the surfaces do; and two surfaces that touch, if the difference of their
// curvatures is definite or indefinite, or they touch along a line; the apex of one cone. Not: the
// apex of a cone on another surface; conics that osculate.
//
// Source: Tilove, Requicha and Voelcker (neighbourhoods); Davy and Dew, section 3.2, leave it out.

#include <cstddef>
#include <span>
#include <vector>

#include "exactcsg/domain/quadric.hpp"

namespace exactcsg::domain {

template <std::size_t D>
struct Germ {
  Coordinates<D> direction;
  Coordinates<D> offset;
  bool is_curved = false;  // the offset is of second order

  // Of f, whose gradient at the point is given. Zero: not decided, which happens at an apex only.
  Sign sign(const Quadric<D>& f, const Coordinates<D>& gradient) const {
    Rational first;
    Rational second;
    for (std::size_t i = 0; i < D; ++i) {
      first += gradient[i] * direction[i];
      second += gradient[i] * offset[i];
    }
    if (first != 0) return sign_of(first);
    // At an apex the second order is all there is.
    if (is_curved || gradient == Coordinates<D>{}) second += f.half_curvature(direction);
    return sign_of(second);
  }
};

template <std::size_t D>
struct Germs {
  std::vector<Germ<D>> germs;
  bool complete = true;
};

// REQUIRES every surface passes through the point.
Germs<2> germs_at(const Point<2>& point, std::span<const Quadric<2>* const> surfaces);
Germs<3> germs_at(const Point<3>& point, std::span<const Quadric<3>* const> surfaces);

}  // namespace exactcsg::domain
