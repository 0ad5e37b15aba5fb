// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/domain/torus_frame.hpp"

#include "exactcsg/domain/vector.hpp"

namespace exactcsg::domain {

TorusFrame::TorusFrame(const Torus& torus) : squared_radius_(Rational(1, 4) * torus.radicand()) {
  // z^2 = s (m x + c)^2: a row of its square form is s m_i m, its linear term along i 2 s m_i c.
  const Quadric<3>& height = torus.squared_height();
  std::size_t row = 0;
  while (height.square()[row][row] == 0) ++row;
  along_ = {height.square()[row], Rational(height.linear().normal[row] / 2)};
  squared_unit_ = 1 / height.square()[row][row];
  for (std::size_t k = 0; k < 3 && detail::is_zero(direction_); ++k) {
    rows_ = {(k + 1) % 3, (k + 2) % 3};
    direction_ = detail::vector_product(squared_radius_.square()[rows_[0]],
                                        squared_radius_.square()[rows_[1]]);
  }
  centre_ = on_axis(0);
}

// The x whose products with the two rows of rho^2 and with the normal of w are these.
Coordinates<3> TorusFrame::solved(const std::array<Rational, 2>& across,
                                  const Rational& along) const {
  std::array<std::array<Rational, 4>, 3> equations;
  for (std::size_t j = 0; j < 3; ++j) {
    for (std::size_t i = 0; i < 2; ++i) equations[i][j] = squared_radius_.square()[rows_[i]][j];
    equations[2][j] = along_.normal[j];
  }
  for (std::size_t i = 0; i < 2; ++i) equations[i][3] = across[i];
  equations[2][3] = along;
  return *detail::solved<3>(std::move(equations), 3);
}

// Where the gradient of rho^2 is 0.
Coordinates<3> TorusFrame::on_axis(const Rational& w) const {
  const Coordinates<3>& slope = squared_radius_.linear().normal;
  return solved({Rational(-slope[rows_[0]] / 2), Rational(-slope[rows_[1]] / 2)},
                Rational(w - along_.constant));
}

Quadric<3> TorusFrame::rest(const Quadric<3>& f, AxialForm& form) const {
  const Rational advance = detail::scalar_product(along_.normal, direction_);
  form.square = f.half_curvature(direction_) / (advance * advance);
  const Quadric<3> without_square = f + Rational(-form.square) * product(along_, along_);
  std::size_t row = 0;
  while (squared_radius_.square()[row][row] == 0) ++row;
  form.radial = without_square.square()[row][row] / squared_radius_.square()[row][row];
  Quadric<3> rest = without_square + Rational(-form.radial) * squared_radius_;
  form.linear = detail::scalar_product(rest.linear().normal, direction_) / advance;
  return rest;
}

// The u across the axis with R u = n, n the part of the normal that is not along w.
Coordinates<3> TorusFrame::uphill(const Coordinates<3>& normal, const Rational& along) const {
  const Coordinates<3> across =
      detail::sum(normal, detail::scaled(Rational(-along), along_.normal));
  return solved({across[rows_[0]], across[rows_[1]]}, 0);
}
Coordinates<3> TorusFrame::uphill(const Quadric<3>& f) const {
  AxialForm form;
  const Quadric<3> linear = rest(f, form);
  return uphill(linear.linear().normal, form.linear);
}

std::optional<AxialForm> TorusFrame::form(const Quadric<3>& f) const {
  AxialForm result;
  const Quadric<3> linear = rest(f, result);
  if (!linear.is_linear()) return std::nullopt;
  result.constant = linear(centre_);
  // n v = u'R v is at most sqrt(u'R u) sqrt(v'R v) = sqrt(n u) rho.
  const Coordinates<3>& normal = linear.linear().normal;
  result.squared_slope = squared_distance(uphill(normal, result.linear));
  return result;
}

bool is_coaxial(const TorusFrame& frame, const Quadric<3>& f) {
  const std::optional<AxialForm> form = frame.form(f);
  return form && form->is_coaxial();
}

bool is_coaxial(const TorusFrame& frame, const Torus& torus) {
  return is_coaxial(frame, torus.base()) && is_coaxial(frame, torus.radicand());
}

}  // namespace exactcsg::domain
