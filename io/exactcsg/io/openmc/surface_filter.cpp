// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/openmc/surface_filter.hpp"

#include <cmath>

#include "exactcsg/number/certified_root.hpp"

namespace exactcsg::io::openmc {

namespace {

// Of a t^2 + b t for |t| <= reach.
std::array<double, 2> range_along(double a, double b, double reach) {
  const double square = a * reach * reach;
  const double sides = std::abs(b) * reach;
  std::array<double, 2> range{square - sides, square + sides};
  if (std::abs(b) < 2 * std::abs(a) * reach) range[a > 0 ? 0 : 1] = -b * b / (4 * a);
  return range;
}

csg::Membership class_in(const domain::Torus& torus, const CertifiedPoint& point) {
  const CertifiedDouble value =
      torus.base().approximate(point) - square_root(torus.radicand().approximate(point));
  if (value.value > value.error) return csg::Membership::Out;
  return -value.value > value.error ? csg::Membership::In : csg::Membership::Unknown;
}

csg::Membership class_in(const domain::Torus& torus, const std::array<double, 3>& lower,
                         const std::array<double, 3>& upper) {
  domain::Coordinates<3> low;
  domain::Coordinates<3> high;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(lower[i] < upper[i])) return csg::Membership::Unknown;
    low[i] = rational_of(lower[i]);
    high[i] = rational_of(upper[i]);
  }
  return domain::classify(torus, domain::Box<3>(low, high));
}

}  // namespace

SurfaceFilter::SurfaceFilter(const HalfSpace& half_space) {
  if (half_space.torus() != nullptr) {
    torus_ = *half_space.torus();
    return;
  }
  const domain::Quadric<3>& f = half_space.quadric()->polynomial();
  const auto rounded = [&](const Rational& coefficient) {
    const double value = nearest_double(coefficient);
    is_usable_ = is_usable_ && (coefficient == 0 || std::abs(value) > 1e-100);
    return value;
  };
  constant_ = rounded(f.linear().constant);
  for (std::size_t i = 0; i < 3; ++i) {
    linear_[i] = rounded(f.linear().normal[i]);
    for (std::size_t j = 0; j < 3; ++j) square_[i][j] = rounded(f.square()[i][j]);
  }
}

csg::Membership SurfaceFilter::classify(const CertifiedPoint& point) const {
  if (torus_) return class_in(*torus_, point);
  double value = constant_;
  double magnitude = std::abs(constant_);
  double reach = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    double factor = linear_[i];
    double size = std::abs(linear_[i]);
    double slope = size;
    for (std::size_t j = 0; j < 3; ++j) {
      const double absolute = std::abs(square_[i][j]);
      factor += square_[i][j] * point[j].value;
      size += absolute * std::abs(point[j].value);
      slope += 2 * absolute * (std::abs(point[j].value) + point[j].error);
    }
    value += factor * point[i].value;
    magnitude += size * std::abs(point[i].value);
    reach += slope * point[i].error;
  }
  // Some thirty roundings, of the coefficients too, of terms whose sum of magnitudes this is.
  const double slack = 0x1p-46 * magnitude + (1 + 0x1p-40) * reach + 1e-290;
  if (!is_usable_) return csg::Membership::Unknown;
  if (value > slack) return csg::Membership::Out;
  return -value > slack ? csg::Membership::In : csg::Membership::Unknown;
}

csg::Membership SurfaceFilter::classify(const std::array<double, 3>& lower,
                                        const std::array<double, 3>& upper) const {
  if (torus_) return class_in(*torus_, lower, upper);
  double low = constant_;
  double high = 0;  // above low
  double magnitude = std::abs(constant_);
  for (std::size_t i = 0; i < 3; ++i) {
    const double middle = 0.5 * (lower[i] + upper[i]);
    const double reach = 0.5 * (upper[i] - lower[i]);
    const double far = std::abs(middle) + reach;
    double slope = linear_[i];
    low += linear_[i] * middle;
    magnitude += std::abs(linear_[i]) * far;
    for (std::size_t j = 0; j < 3; ++j) {
      const double other = 0.5 * (lower[j] + upper[j]);
      const double other_reach = 0.5 * (upper[j] - lower[j]);
      slope += 2 * square_[i][j] * other;
      low += square_[i][j] * middle * other;
      magnitude += 4 * std::abs(square_[i][j]) * far * (std::abs(other) + other_reach);
      if (i == j) continue;
      const double mixed = std::abs(square_[i][j]) * reach * other_reach;
      low -= mixed;
      high += 2 * mixed;
    }
    const auto [least, greatest] = range_along(square_[i][i], slope, reach);
    low += least;
    high += greatest - least;
  }
  // Some fifty roundings of terms whose sum of magnitudes this is: far below a part in 10^12.
  const double slack = 1e-12 * magnitude + 1e-290;
  if (!is_usable_) return csg::Membership::Unknown;
  if (low > slack) return csg::Membership::Out;
  return low + high < -slack ? csg::Membership::In : csg::Membership::Unknown;
}

}  // namespace exactcsg::io::openmc
