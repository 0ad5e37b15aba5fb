// SPDX-License-Identifier: Apache-2.0
#pragma once

// The neighbourhood of a point where several lines, circles, surfaces of degree two or tori meet:
// what distinguishes In, On and Out there. [Exact]
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
// complete are
//   - any number of planes; surfaces whose tangent planes are different, three of which share a
//     tangent only if the surfaces share a line or, as surfaces of revolution, a circle;
//   - any number of surfaces that touch, if their curvatures differ: where two of them are equally
//     high over a direction of the tangent plane they cross there, and no third one and no other
//     tangent plane meets them; or all that meet there share a line or a circle along which those
//     with one tangent plane touch;
//   - at the apex of a cone, which may be that of several: any number of cones and planes through
//     it; other surfaces, and the tip of one spindle torus, which meet those only in different
//     directions and cross them there.
// Not: surfaces that osculate; others that meet in one direction; surfaces that touch in an apex; a
// cone or another torus at the tip of a torus; the centre of a horn torus, but of that torus alone.
//
// Source: Tilove, Requicha and Voelcker (neighbourhoods); Davy and Dew, section 3.2, leave it out.

#include <cstddef>
#include <span>
#include <vector>

#include "exactcsg/domain/torus.hpp"

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

// A surface as germs see it: the zeros of the polynomial; or a torus, with which the polynomial
// agrees to second order at the point.
template <std::size_t D>
struct GermSurface {
  const Quadric<D>* polynomial = nullptr;
  const Torus* torus = nullptr;
};

// base^2 - radicand up to second order about the point. At a tip, a cone.
// REQUIRES the surface passes through the point.
Quadric<3> second_order(const Torus& torus, const Point<3>& point);

// REQUIRES every surface passes through the point; a torus occurs once.
Germs<2> germs_at(const Point<2>& point, std::span<const GermSurface<2>> surfaces);
Germs<3> germs_at(const Point<3>& point, std::span<const GermSurface<3>> surfaces);

}  // namespace exactcsg::domain
