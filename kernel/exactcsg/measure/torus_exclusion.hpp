// SPDX-License-Identifier: Apache-2.0
#pragma once

// Whether a torus and another surface's half-space exclude each other, seen from the torus's axis.
// [Exact]
//
// In the half-plane of rho and w (torus_frame.hpp) a torus is a disc: base - sqrt(radicand) is of
// degree two there. So is any surface of revolution round the same axis, and another torus round
// it; and of a plane, a sphere or another quadric whose terms of degree two have the axis's
// directions, the least value at each (rho, w) is bounded from below by one. f + mu g >= 0 for two
// such polynomials, on the rectangle of all rho and w in the box, proves that f < 0 and g < 0
// exclude each other.

#include <array>
#include <optional>
#include <utility>

#include "exactcsg/domain/surface_half_space.hpp"
#include "exactcsg/domain/torus_frame.hpp"
#include "exactcsg/measure/nonnegative_sum.hpp"

namespace exactcsg::measure::detail {

// Bounds of a root, equal if it is rational.
inline Enclosure root_bounds(const Rational& square) {
  constexpr int bits = 64;
  return enclose(QuadraticNumber(0, 1, square), bits);
}

// radial rho^2 + slope rho + square w^2 + linear w + constant, as a polynomial in (rho, w)
inline domain::Quadric<2> in_half_plane(const domain::AxialForm& form, const Rational& slope) {
  domain::Quadric<2>::Matrix square;
  square[0][0] = form.radial;
  square[1][1] = form.square;
  return {std::move(square), domain::LinearForm<2>{{slope, form.linear}, form.constant}};
}

// A lower bound of what is negative inside the half-space; nullopt if there is none of this kind.
inline std::optional<domain::Quadric<2>> lower_bound(const domain::TorusFrame& frame,
                                                     const domain::HalfSpace<3>& half_space) {
  const Rational sign = half_space.is_complement() ? -1 : 1;
  const auto form = frame.form(sign * half_space.polynomial());
  if (!form) return std::nullopt;
  return in_half_plane(*form, Rational(-root_bounds(form->squared_slope).upper));
}
inline std::optional<domain::Quadric<2>> lower_bound(const domain::TorusFrame& frame,
                                                     const domain::Torus& torus) {
  if (!is_coaxial(frame, torus)) return std::nullopt;
  const Rational sign = torus.is_complement() ? -1 : 1;
  const Enclosure root = root_bounds(frame.form(torus.radicand())->radial);
  return in_half_plane(*frame.form(sign * torus.base()),
                       torus.is_complement() ? root.lower : Rational(-root.upper));
}

inline ApproximateQuadric approximate_quadric(const domain::Quadric<2>& f) {
  UnitQuadric result;
  result.constant = certified_double_of(f.linear().constant);
  for (std::size_t i = 0; i < 2; ++i) {
    result.linear[i] = certified_double_of(f.linear().normal[i]);
    for (std::size_t j = 0; j < 2; ++j) {
      result.square[i][j] = certified_double_of(f.square()[i][j]);
    }
  }
  return ApproximateQuadric(UnitSurface(result), false);
}

// Two half-spaces, one of them a torus's, seen from its axis; nullopt if that cannot be done.
struct ViewFromAxis {
  domain::TorusFrame frame;
  domain::Quadric<2> f;
  domain::Quadric<2> g;
  domain::Coordinates<3> downhill;  // where the second is least, if it is not the same all round

  static std::optional<ViewFromAxis> of(const domain::SurfaceHalfSpace& a,
                                        const domain::SurfaceHalfSpace& b) {
    const bool is_first = a.torus() != nullptr;
    if (!is_first && b.torus() == nullptr) return std::nullopt;
    const domain::SurfaceHalfSpace& other = is_first ? b : a;
    domain::TorusFrame frame(*(is_first ? a : b).torus());
    const auto bound = [&](const auto& kind) { return lower_bound(frame, kind); };
    auto f = (is_first ? a : b).visit(bound);
    auto g = other.visit(bound);
    if (!f || !g) return std::nullopt;
    domain::Coordinates<3> downhill;
    if (other.quadric() != nullptr) {
      const Rational sign = other.quadric()->is_complement() ? 1 : -1;
      downhill = frame.uphill(sign * other.quadric()->polynomial());
    }
    return ViewFromAxis{std::move(frame), std::move(*f), std::move(*g), std::move(downhill)};
  }
};

// Their interiors have no common point in the box. False if that is not seen, or neither is a
// torus.
inline bool exclude_round_axis(const domain::SurfaceHalfSpace& a, const domain::SurfaceHalfSpace& b,
                               const domain::Box<3>& box) {
  const std::optional<ViewFromAxis> view = ViewFromAxis::of(a, b);
  if (!view) return false;
  const domain::Torus& torus = a.torus() != nullptr ? *a.torus() : *b.torus();
  const domain::Range along = domain::range(domain::Quadric<3>(view->frame.along()), box);
  const Rational squared_radius = domain::range(torus.radicand(), box).maximum / 4;
  const domain::Box<2> rectangle(
      domain::Point<2>(0, along.minimum),
      domain::Point<2>(root_bounds(squared_radius).upper, along.maximum));
  return have_nonnegative_sum(
      view->f, view->g, {approximate_quadric(view->f), approximate_quadric(view->g)}, rectangle);
}

// A point at which both are negative, perhaps: in the middle of the lens that they have in common,
// seen from the axis; if it is the same all round, on the side of `towards`. [Approximate]
inline std::optional<domain::Point<3>> point_round_axis(const domain::SurfaceHalfSpace& a,
                                                        const domain::SurfaceHalfSpace& b,
                                                        const domain::Point<3>& towards) {
  const std::optional<ViewFromAxis> view = ViewFromAxis::of(a, b);
  if (!view) return std::nullopt;
  const auto middle = balance(approximate_quadric(view->f), approximate_quadric(view->g));
  if (!middle || !(middle->point[0] > 0 && middle->point[0] < 0x1p60) ||
      !(std::abs(middle->point[1]) < 0x1p60)) {
    return std::nullopt;
  }
  const Rational w = rational_of(middle->point[1]);
  const domain::Coordinates<3> from = view->frame.on_axis(w);
  domain::Coordinates<3> direction = view->downhill;
  double length = std::sqrt(nearest_double(view->frame.squared_distance(direction)));
  if (!(length > 0)) {
    const Rational height = view->frame.along()(towards.coordinates());
    const domain::Coordinates<3> foot = view->frame.on_axis(height);
    for (std::size_t i = 0; i < 3; ++i) direction[i] = towards[i] - foot[i];
    length = std::sqrt(nearest_double(view->frame.squared_distance(direction)));
  }
  const double factor = middle->point[0] / length;
  if (!(factor < 0x1p60)) return std::nullopt;
  domain::Coordinates<3> result = from;
  for (std::size_t i = 0; i < 3; ++i) result[i] += rational_of(factor) * direction[i];
  return domain::Point<3>(result);
}

}  // namespace exactcsg::measure::detail
