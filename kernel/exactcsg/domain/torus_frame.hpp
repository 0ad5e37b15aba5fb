// SPDX-License-Identifier: Apache-2.0
#pragma once

// Polynomials of degree two seen from the axis of a torus: in terms of the distance rho from it (in
// units of the torus's major radius) and of a linear form w along it. [Exact]

#include <array>
#include <optional>

#include "exactcsg/domain/torus.hpp"

namespace exactcsg::domain {

// radial rho^2 + square w^2 + linear w + constant + l, where l is a linear form across the axis
// whose greatest value at the distance rho is sqrt(squared_slope) rho.
struct AxialForm {
  Rational radial;
  Rational square;
  Rational linear;
  Rational constant;
  Rational squared_slope;

  // A surface of revolution round the axis, in the affine sense.
  bool is_coaxial() const { return squared_slope == 0; }
};

// LAW torus_frame.1  form(f), if there is one, describes f; there is none if the terms of degree
//                    two of f have other directions than those of the torus.
// LAW torus_frame.2  z^2 of the torus is w^2 * squared_unit().
// LAW torus_frame.3  on_axis(w) is the point of the axis at w; squared_distance(d) is the square of
//                    the distance of on_axis(w) + d from the axis, in units of the major radius.
// LAW torus_frame.4  of all directions across the axis, f grows most along uphill(f), which is 0 if
//                    f is coaxial. REQUIRES form(f)
// COST: O(1) rational operations.
class TorusFrame {
 public:
  explicit TorusFrame(const Torus& torus);

  std::optional<AxialForm> form(const Quadric<3>& f) const;
  const LinearForm<3>& along() const noexcept { return along_; }  // w
  const Rational& squared_unit() const noexcept { return squared_unit_; }
  Coordinates<3> on_axis(const Rational& w) const;
  Rational squared_distance(const Coordinates<3>& d) const {
    return squared_radius_.half_curvature(d);
  }
  Coordinates<3> uphill(const Quadric<3>& f) const;

 private:
  // What is left of f if the terms of degree two are taken off: linear, if form(f) is there.
  Quadric<3> rest(const Quadric<3>& f, AxialForm& form) const;
  Coordinates<3> uphill(const Coordinates<3>& normal, const Rational& along) const;
  Coordinates<3> solved(const std::array<Rational, 2>& across, const Rational& along) const;

  Quadric<3> squared_radius_;
  LinearForm<3> along_;
  Rational squared_unit_;
  std::array<std::size_t, 2> rows_{};  // of squared_radius_, that are not parallel
  Coordinates<3> direction_;           // of the axis
  Coordinates<3> centre_;
};

// True if f = 0 is a surface of revolution round the torus's axis, in the affine sense; of another
// torus, if its axis is the same.
bool is_coaxial(const TorusFrame& frame, const Quadric<3>& f);
bool is_coaxial(const TorusFrame& frame, const Torus& torus);

}  // namespace exactcsg::domain
