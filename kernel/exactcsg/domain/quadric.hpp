// SPDX-License-Identifier: Apache-2.0
#pragma once

// Polynomials of degree at most two in D variables with rational coefficients: their sign at a
// point, their range over a box, their restriction to a line, all exact. [Exact]
//
// With f(x) = x' A x + b' x + c, A symmetric:
// LAW quadric.1  f.sign(p) is the sign of f(p).
// LAW quadric.2  range(f, box) is the least and the greatest value of f on the box.
// LAW quadric.3  restrict(f, section)(t) == f(section.at(t)).
// LAW quadric.4  substitute(f, M)(x) == f(M x), M an affine map.
// LAW quadric.5  f.range_bounds(box) encloses the least and the greatest value, tight but for
//                rounding.
// LAW quadric.6  is_nowhere_negative(f, box) iff range(f, box).minimum >= 0.
// COST: sign a dozen operations in certified doubles; near zero, O(D^2) in integers on the stack
// (fixed_width_sign.hpp), or in rationals if these would be too long; range the
// solution of at most 3^D systems of at most D linear equations.
//
// Range: the least value is taken at a point of the relative interior of some face of the box,
// where the gradient along the face vanishes. If the second derivatives along the face are regular,
// that is one point, found by solving a linear system. If they are singular, f is constant on a
// line through that point in the face, which ends in a smaller face: so such faces need no
// solution.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "exactcsg/domain/fixed_width_sign.hpp"
#include "exactcsg/domain/point.hpp"
#include "exactcsg/number/quadratic_number.hpp"
#include "exactcsg/number/tier_statistics.hpp"

namespace exactcsg::domain {

// normal' x + constant
template <std::size_t D>
struct LinearForm {
  Coordinates<D> normal;
  Rational constant;

  Rational operator()(const Coordinates<D>& x) const {
    Rational value = constant;
    for (std::size_t i = 0; i < D; ++i) value += normal[i] * x[i];
    return value;
  }
  bool is_constant() const {
    for (const Rational& coefficient : normal) {
      if (coefficient != 0) return false;
    }
    return true;
  }
};

// Bounds of the least and of the greatest value on a box.
struct RangeBounds {
  double least_lower = 0;
  double least_upper = 0;
  double greatest_lower = 0;
  double greatest_upper = 0;
};

template <std::size_t D>
class Quadric {
 public:
  static constexpr std::size_t dimension = D;
  using Matrix = std::array<Coordinates<D>, D>;

  Quadric() : Quadric({}, {}) {}
  Quadric(LinearForm<D> linear) : Quadric({}, std::move(linear)) {}
  // REQUIRES square is symmetric
  Quadric(Matrix square, LinearForm<D> linear)
      : square_(std::move(square)), linear_(std::move(linear)) {
    approximate_constant_ = certified_double_of(linear_.constant);
    for (std::size_t i = 0; i < D; ++i) {
      approximate_linear_[i] = certified_double_of(linear_.normal[i]);
      for (std::size_t j = 0; j < D; ++j) {
        approximate_square_[i][j] = certified_double_of(square_[i][j]);
        is_linear_ = is_linear_ && square_[i][j] == 0;
        has_mixed_terms_ = has_mixed_terms_ || (i != j && square_[i][j] != 0);
      }
    }
    fixed_width_ = FixedWidthPolynomial<D>(coefficients());
  }

  const Matrix& square() const noexcept { return square_; }
  const LinearForm<D>& linear() const noexcept { return linear_; }
  bool is_linear() const noexcept { return is_linear_; }
  // Products of different variables.
  bool has_mixed_terms() const noexcept { return has_mixed_terms_; }

  Rational operator()(const Coordinates<D>& x) const {
    Rational value = linear_.constant;
    for (std::size_t i = 0; i < D; ++i) {
      Rational factor = linear_.normal[i];
      if (!is_linear_) {
        for (std::size_t j = 0; j < D; ++j) {
          if (square_[i][j] != 0) factor += square_[i][j] * x[j];
        }
      }
      value += factor * x[i];
    }
    return value;
  }

  // [Certified]
  CertifiedDouble approximate(const std::array<CertifiedDouble, D>& x) const {
    CertifiedDouble value = approximate_constant_;
    for (std::size_t i = 0; i < D; ++i) {
      CertifiedDouble factor = approximate_linear_[i];
      if (!is_linear_) {
        for (std::size_t j = 0; j < D; ++j) {
          const CertifiedDouble& coefficient = approximate_square_[i][j];
          if (!is_exactly_zero(coefficient)) factor = factor + coefficient * x[j];
        }
      }
      value = value + factor * x[i];
    }
    return value;
  }

  // Counts which tier answered, if asked to.
  Sign sign(const Point<D>& point, TierStatistics* statistics = nullptr) const {
    const CertifiedDouble filter = approximate(point.approximate());
    if (std::abs(filter.value) > filter.error) {
      if (statistics != nullptr) statistics->record(Tier::Double, false);
      return filter.value > 0 ? Sign::Positive : Sign::Negative;
    }
    if (const std::optional<Sign> fixed = fixed_width_.sign(point.coordinates())) {
      if (statistics != nullptr) statistics->record(Tier::Fixed, *fixed == Sign::Zero);
      return *fixed;
    }
    const Sign exact = sign_of((*this)(point.coordinates()));
    if (statistics != nullptr) statistics->record(Tier::Unbounded, exact == Sign::Zero);
    return exact;
  }

  Coordinates<D> gradient(const Coordinates<D>& x) const {
    Coordinates<D> result = linear_.normal;
    for (std::size_t i = 0; i < D; ++i) {
      for (std::size_t j = 0; j < D; ++j) result[i] += 2 * square_[i][j] * x[j];
    }
    return result;
  }

  // The derivative along an axis. [Certified]
  CertifiedDouble approximate_slope(std::size_t axis,
                                    const std::array<CertifiedDouble, D>& x) const {
    CertifiedDouble slope = approximate_linear_[axis];
    for (std::size_t j = 0; j < D && !is_linear_; ++j) {
      const CertifiedDouble& coefficient = approximate_square_[axis][j];
      if (!is_exactly_zero(coefficient)) slope = slope + CertifiedDouble{2, 0} * coefficient * x[j];
    }
    return slope;
  }

  // Half the second derivative along an axis. [Approximate]
  double approximate_curvature(std::size_t axis) const {
    return approximate_square_[axis][axis].value;
  }

  // v' A v, half the second derivative along v.
  Rational half_curvature(const Coordinates<D>& v) const {
    Rational value;
    for (std::size_t i = 0; i < D; ++i) {
      for (std::size_t j = 0; j < D; ++j) value += square_[i][j] * v[i] * v[j];
    }
    return value;
  }

  // An upper bound of |h' A h| for all |h_i| <= extent_i. [Certified]
  double curvature(const std::array<double, D>& extent) const {
    double bound = 0;
    for (std::size_t i = 0; i < D && !is_linear_; ++i) {
      for (std::size_t j = 0; j < D; ++j) {
        bound += magnitude(approximate_square_[i][j]) * extent[i] * extent[j];
      }
    }
    return bound * (1 + 0x1p-40);
  }

  // An upper bound of |f(m + h) - f(m)| for all |h_i| <= extent_i. [Certified]
  double variation(const std::array<CertifiedDouble, D>& m,
                   const std::array<double, D>& extent) const {
    double bound = 0;
    for (std::size_t i = 0; i < D; ++i) {
      double slope = magnitude(approximate_slope(i, m));
      for (std::size_t j = 0; j < D && !is_linear_; ++j) {
        slope += magnitude(approximate_square_[i][j]) * extent[j];
      }
      bound += slope * extent[i];
    }
    return bound * (1 + 0x1p-40);
  }

  // Tight but for rounding: the sum of what its parts in one variable take on.
  // REQUIRES no mixed terms. [Certified]
  RangeBounds range_bounds(const Box<D>& box) const {
    const double constant = approximate_constant_.value;
    RangeBounds sum{constant, constant, constant, constant};
    double magnitudes = std::abs(constant);
    for (std::size_t i = 0; i < D; ++i) {
      const RangeBounds part =
          bounds_along(i, box.lower().approximate()[i], box.upper().approximate()[i]);
      sum.least_lower += part.least_lower;
      sum.least_upper += part.least_upper;
      sum.greatest_lower += part.greatest_lower;
      sum.greatest_upper += part.greatest_upper;
      magnitudes += std::max({std::abs(part.least_lower), std::abs(part.least_upper),
                              std::abs(part.greatest_lower), std::abs(part.greatest_upper)});
    }
    const double rounding = approximate_constant_.error + 0x1p-48 * magnitudes;
    sum.least_lower -= rounding;
    sum.least_upper += rounding;
    sum.greatest_lower -= rounding;
    sum.greatest_upper += rounding;
    return sum;
  }

  friend bool operator==(const Quadric& f, const Quadric& g) {
    return f.square_ == g.square_ && f.linear_.normal == g.linear_.normal &&
           f.linear_.constant == g.linear_.constant;
  }

 private:
  // As FixedWidthPolynomial takes them.
  std::vector<Rational> coefficients() const {
    std::vector<Rational> result{linear_.constant};
    result.insert(result.end(), linear_.normal.begin(), linear_.normal.end());
    for (std::size_t i = 0; i < D && !is_linear_; ++i) {
      result.push_back(square_[i][i]);
      for (std::size_t j = i + 1; j < D; ++j) result.push_back(2 * square_[i][j]);
    }
    return result;
  }

  // Of a x^2 + b x, at the ends and where the derivative vanishes between them.
  RangeBounds bounds_along(std::size_t axis, const CertifiedDouble& from,
                           const CertifiedDouble& to) const {
    const CertifiedDouble& a = approximate_square_[axis][axis];
    const CertifiedDouble& b = approximate_linear_[axis];
    const CertifiedDouble at_from = (a * from + b) * from;
    const CertifiedDouble at_to = (a * to + b) * to;
    RangeBounds result{
        std::min(at_from.lower(), at_to.lower()), std::min(at_from.upper(), at_to.upper()),
        std::max(at_from.lower(), at_to.lower()), std::max(at_from.upper(), at_to.upper())};
    if (is_exactly_zero(a)) return result;
    const CertifiedDouble vertex = -b / (CertifiedDouble{2, 0} * a);
    const CertifiedDouble after = vertex - from;
    const CertifiedDouble before = to - vertex;
    if (-after.value > after.error || -before.value > before.error) return result;
    const bool is_between = after.value > after.error && before.value > before.error;
    const CertifiedDouble there = b * vertex / CertifiedDouble{2, 0};
    if (a.value > 0) {
      result.least_lower = std::min(result.least_lower, there.lower());
      if (is_between) result.least_upper = std::min(result.least_upper, there.upper());
    } else {
      result.greatest_upper = std::max(result.greatest_upper, there.upper());
      if (is_between) result.greatest_lower = std::max(result.greatest_lower, there.lower());
    }
    return result;
  }

  static bool is_exactly_zero(const CertifiedDouble& x) { return x.value == 0 && x.error == 0; }
  static double magnitude(CertifiedDouble x) { return std::abs(x.value) + x.error; }

  // The filter's data first: they are what is usually read.
  bool is_linear_ = true;
  bool has_mixed_terms_ = false;
  CertifiedDouble approximate_constant_;
  std::array<CertifiedDouble, D> approximate_linear_;
  std::array<std::array<CertifiedDouble, D>, D> approximate_square_;
  FixedWidthPolynomial<D> fixed_width_;
  Matrix square_;
  LinearForm<D> linear_;
};

template <std::size_t D>
Quadric<D> operator+(const Quadric<D>& f, const Quadric<D>& g) {
  auto square = f.square();
  LinearForm<D> linear = f.linear();
  linear.constant += g.linear().constant;
  for (std::size_t i = 0; i < D; ++i) {
    linear.normal[i] += g.linear().normal[i];
    for (std::size_t j = 0; j < D; ++j) square[i][j] += g.square()[i][j];
  }
  return {std::move(square), std::move(linear)};
}

template <std::size_t D>
Quadric<D> operator*(const Rational& factor, const Quadric<D>& f) {
  auto square = f.square();
  LinearForm<D> linear = f.linear();
  linear.constant *= factor;
  for (std::size_t i = 0; i < D; ++i) {
    linear.normal[i] *= factor;
    for (Rational& coefficient : square[i]) coefficient *= factor;
  }
  return {std::move(square), std::move(linear)};
}

template <std::size_t D>
Quadric<D> product(const LinearForm<D>& f, const LinearForm<D>& g) {
  typename Quadric<D>::Matrix square;
  LinearForm<D> linear{{}, Rational(f.constant * g.constant)};
  for (std::size_t i = 0; i < D; ++i) {
    linear.normal[i] = f.normal[i] * g.constant + g.normal[i] * f.constant;
    for (std::size_t j = 0; j < D; ++j) {
      square[i][j] = (f.normal[i] * g.normal[j] + f.normal[j] * g.normal[i]) / 2;
    }
  }
  return {std::move(square), std::move(linear)};
}

// An affine map x -> M x + t, row by row: {M_i0, ..., M_i(D-1), t_i}.
template <std::size_t D>
using AffineRows = std::array<std::array<Rational, D + 1>, D>;

template <std::size_t D>
LinearForm<D> substitute(const LinearForm<D>& f, const AffineRows<D>& rows) {
  LinearForm<D> result{{}, f.constant};
  for (std::size_t i = 0; i < D; ++i) {
    result.constant += f.normal[i] * rows[i][D];
    for (std::size_t j = 0; j < D; ++j) result.normal[j] += f.normal[i] * rows[i][j];
  }
  return result;
}

template <std::size_t D>
Quadric<D> substitute(const Quadric<D>& f, const AffineRows<D>& rows) {
  Quadric<D> result(substitute(f.linear(), rows));
  for (std::size_t i = 0; i < D; ++i) {
    for (std::size_t j = 0; j < D; ++j) {
      if (f.square()[i][j] == 0) continue;
      const auto form = [&](std::size_t row) {
        LinearForm<D> image{{}, rows[row][D]};
        for (std::size_t k = 0; k < D; ++k) image.normal[k] = rows[row][k];
        return image;
      };
      result = result + f.square()[i][j] * product(form(i), form(j));
    }
  }
  return result;
}

template <std::size_t D>
QuadraticPolynomial restrict(const Quadric<D>& f, const LineSection<D>& section) {
  QuadraticPolynomial result{f.half_curvature(section.direction), 0, f(section.origin)};
  const Coordinates<D> gradient = f.gradient(section.origin);
  for (std::size_t i = 0; i < D; ++i) result.linear += gradient[i] * section.direction[i];
  return result;
}

namespace detail {

enum class FaceSide : unsigned char { Lower, Upper, Free };

// Gauss's elimination; nullopt if the first `size` equations in as many unknowns are singular.
template <std::size_t D>
std::optional<Coordinates<D>> solved(std::array<std::array<Rational, D + 1>, D> m,
                                     std::size_t size) {
  for (std::size_t column = 0; column < size; ++column) {
    std::size_t pivot = column;
    while (pivot < size && m[pivot][column] == 0) ++pivot;
    if (pivot == size) return std::nullopt;
    std::swap(m[pivot], m[column]);
    for (std::size_t row = 0; row < size; ++row) {
      if (row == column || m[row][column] == 0) continue;
      const Rational factor = m[row][column] / m[column][column];
      for (std::size_t k = column; k < size; ++k) m[row][k] -= factor * m[column][k];
      m[row][D] -= factor * m[column][D];
    }
  }
  Coordinates<D> x;
  for (std::size_t i = 0; i < size; ++i) x[i] = m[i][D] / m[i][i];
  return x;
}

// The point of the face's relative interior at which the gradient along the face vanishes, if it is
// one single point.
template <std::size_t D>
std::optional<Coordinates<D>> critical_point(const Quadric<D>& f, const Box<D>& box,
                                             const std::array<FaceSide, D>& face) {
  Coordinates<D> point;
  std::array<std::size_t, D> free{};
  std::size_t count = 0;
  for (std::size_t i = 0; i < D; ++i) {
    if (face[i] == FaceSide::Free) {
      free[count++] = i;
    } else {
      point[i] = face[i] == FaceSide::Lower ? box.lower()[i] : box.upper()[i];
    }
  }
  if (count == 0) return point;
  if (f.is_linear()) return std::nullopt;
  const Coordinates<D> gradient = f.gradient(point);  // with 0 for the free ones
  std::array<std::array<Rational, D + 1>, D> equations;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < count; ++j) equations[i][j] = 2 * f.square()[free[i]][free[j]];
    equations[i][D] = -gradient[free[i]];
  }
  const auto solution = solved<D>(std::move(equations), count);
  if (!solution) return std::nullopt;
  for (std::size_t i = 0; i < count; ++i) {
    const Rational& value = (*solution)[i];
    if (!(box.lower()[free[i]] < value && value < box.upper()[free[i]])) return std::nullopt;
    point[free[i]] = value;
  }
  return point;
}

}  // namespace detail

// visit(point) -> bool for points of the box among which are one where f is least and one where it
// is greatest; the corners come first; ends when visit says false.
template <std::size_t D, class Visit>
void for_each_extreme_candidate(const Quadric<D>& f, const Box<D>& box, Visit&& visit) {
  using detail::FaceSide;
  for (std::size_t free_axes = 0; free_axes < (std::size_t{1} << D); ++free_axes) {
    for (std::size_t upper = 0; upper < (std::size_t{1} << D); ++upper) {
      if ((free_axes & upper) != 0) continue;
      std::array<FaceSide, D> face{};
      for (std::size_t i = 0; i < D; ++i) {
        face[i] = (free_axes >> i & 1U) != 0 ? FaceSide::Free
                  : (upper >> i & 1U) != 0   ? FaceSide::Upper
                                             : FaceSide::Lower;
      }
      const auto point = detail::critical_point(f, box, face);
      if (point && !visit(*point)) return;
    }
  }
}

struct Range {
  Rational minimum;
  Rational maximum;
};

template <std::size_t D>
Range range(const Quadric<D>& f, const Box<D>& box) {
  std::optional<Range> result;
  for_each_extreme_candidate(f, box, [&](const Coordinates<D>& point) {
    Rational value = f(point);
    if (!result) {
      result = Range{value, value};
    } else if (value < result->minimum) {
      result->minimum = std::move(value);
    } else if (value > result->maximum) {
      result->maximum = std::move(value);
    }
    return true;
  });
  return *result;
}

// f >= 0 on the box.
template <std::size_t D>
bool is_nowhere_negative(const Quadric<D>& f, const Box<D>& box) {
  if (!f.has_mixed_terms()) {
    const RangeBounds bounds = f.range_bounds(box);
    if (bounds.least_lower >= 0) return true;
    if (bounds.least_upper < 0) return false;
  }
  return range(f, box).minimum >= 0;
}

}  // namespace exactcsg::domain
