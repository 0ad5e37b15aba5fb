// SPDX-License-Identifier: Apache-2.0
#pragma once

// A polynomial of degree at most two in the coordinates of one cell, which run from -1 to 1, and
// the graph of its zero over a rectangle of the first two. [Certified]
//
// LAW unit_quadric.1  the coefficients enclose those of f(centre + half_width u).
// LAW graph.1  if a graph is found over a rectangle, f has exactly one zero Z(s, t) with
//              lower < Z < upper over each of its points, df/du > 0 there, and Z is analytic.
// LAW graph.2  integral encloses that of Z; the error falls as the eighth power of the rectangle's
//              size. linear_model encloses Z by a linear function and a remainder.
//
// Taylor's formula: with x0 on the surface, 0 = f(x0 + d) = f'(x0) d + d'Ad is solved for the
// power series of d's last component, coefficient by coefficient. At the centre of the rectangle
// this gives the polynomial; over the whole rectangle, in intervals, Lagrange's remainder.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "exactcsg/domain/quadric.hpp"
#include "exactcsg/measure/taylor_series.hpp"

namespace exactcsg::measure::detail {

struct UnitQuadric {
  using Vector = std::array<CertifiedDouble, 3>;

  CertifiedDouble constant;
  Vector linear;
  std::array<Vector, 3> square;

  CertifiedDouble operator()(const Vector& x) const {
    CertifiedDouble value = constant;
    for (std::size_t i = 0; i < 3; ++i) {
      CertifiedDouble factor = linear[i];
      for (std::size_t j = 0; j < 3; ++j) factor = factor + square[i][j] * x[j];
      value = value + factor * x[i];
    }
    return value;
  }
  CertifiedDouble derivative(std::size_t axis, const Vector& x) const {
    CertifiedDouble value = linear[axis];
    for (std::size_t j = 0; j < 3; ++j) value = value + exactly(2) * square[axis][j] * x[j];
    return value;
  }
  // On the points of the rectangle at one height.
  CertifiedDouble range_at(const Rectangle& r, double height) const {
    const Vector centre{exactly(r.s), exactly(r.t), exactly(height)};
    const std::array<double, 2> extent{r.a, r.b};
    double reach = 0;
    for (std::size_t i = 0; i < 2; ++i) {
      double slope = magnitude(derivative(i, centre));
      for (std::size_t j = 0; j < 2; ++j) slope += magnitude(square[i][j]) * extent[j];
      reach += slope * extent[i];
    }
    return widened((*this)(centre), reach * (1 + 0x1p-48));
  }
  UnitQuadric operator-() const {
    UnitQuadric result{-constant, {}, {}};
    for (std::size_t i = 0; i < 3; ++i) {
      result.linear[i] = -linear[i];
      for (std::size_t j = 0; j < 3; ++j) result.square[i][j] = -square[i][j];
    }
    return result;
  }
  // With the axes in another order: the last is `height`.
  UnitQuadric with_height(std::size_t height) const {
    UnitQuadric result{constant, {}, {}};
    for (std::size_t i = 0; i < 3; ++i) {
      result.linear[i] = linear[(height + 1 + i) % 3];
      for (std::size_t j = 0; j < 3; ++j) {
        result.square[i][j] = square[(height + 1 + i) % 3][(height + 1 + j) % 3];
      }
    }
    return result;
  }
};

inline UnitQuadric unit_quadric(const domain::Quadric<3>& f, const domain::Box<3>& box) {
  domain::Coordinates<3> centre;
  domain::Coordinates<3> half;
  for (std::size_t i = 0; i < 3; ++i) {
    centre[i] = (box.lower()[i] + box.upper()[i]) / 2;
    half[i] = box.upper()[i] - centre[i];
  }
  const domain::Coordinates<3> gradient = f.gradient(centre);
  UnitQuadric result{certified_double_of(f(centre)), {}, {}};
  for (std::size_t i = 0; i < 3; ++i) {
    result.linear[i] = certified_double_of(Rational(gradient[i] * half[i]));
    for (std::size_t j = 0; j < 3; ++j) {
      if (f.square()[i][j] == 0) continue;
      result.square[i][j] = certified_double_of(Rational(f.square()[i][j] * half[i] * half[j]));
    }
  }
  return result;
}

// c0 + p (s - centre) + q (t - centre), and how far off that is.
struct LinearModel {
  CertifiedDouble constant;
  CertifiedDouble along_s;
  CertifiedDouble along_t;
  double remainder = 0;
};

// The height of the surface over a rectangle.
class Graph {
 public:
  double lower() const { return lower_; }
  double upper() const { return upper_; }

  // nullopt if no graph is recognised, which need not mean that there is none.
  // REQUIRES the partial derivative by the height is positive where the graph is sought.
  static std::optional<Graph> find(const UnitQuadric& f, const Rectangle& r) {
    const double middle = approximate_zero(f, r);
    if (!(std::abs(middle) < 8)) return std::nullopt;
    const UnitQuadric::Vector centre{exactly(r.s), exactly(r.t), exactly(middle)};
    const double slope = f.derivative(2, centre).value;
    if (!(slope > 0)) return std::nullopt;
    const double first = std::abs(f.derivative(0, centre).value) * r.a +
                         std::abs(f.derivative(1, centre).value) * r.b;
    const double second = std::abs(f.square[0][0].value) * r.a * r.a +
                          2 * std::abs(f.square[0][1].value) * r.a * r.b +
                          std::abs(f.square[1][1].value) * r.b * r.b;
    double reach = (first + second) / slope * 1.0625 + 0x1p-44;
    for (int attempt = 0; attempt < 4; ++attempt, reach *= 1.5) {
      if (!(reach < 8)) break;
      Graph graph(f, r, middle, reach);
      if (graph.is_proved()) return graph;
    }
    return std::nullopt;
  }

  CertifiedDouble integral() const {
    return detail::integral(rectangle_, series_at_centre(order - 1), series_anywhere(), order);
  }
  // Of the height, in s and t relative to the points.
  Series series_at_centre(std::size_t degree) const { return series(centre_point(), degree); }
  Series series_anywhere(std::size_t degree = order) const { return series(all_points(), degree); }

  LinearModel linear_model() const {
    const Series at_centre = series_at_centre(1);
    const Series anywhere = series_anywhere(2);
    const double a = rectangle_.a;
    const double b = rectangle_.b;
    const double remainder = magnitude(anywhere[2][0]) * a * a + magnitude(anywhere[1][1]) * a * b +
                             magnitude(anywhere[0][2]) * b * b;
    return {at_centre[0][0], at_centre[1][0], at_centre[0][1], remainder * (1 + 0x1p-48)};
  }

 private:
  static constexpr std::size_t order = series_order;

  Graph(const UnitQuadric& f, const Rectangle& r, double middle, double reach)
      : f_(&f), rectangle_(r), middle_(middle), lower_(middle - reach), upper_(middle + reach) {}

  static double approximate_zero(const UnitQuadric& f, const Rectangle& r) {
    const UnitQuadric::Vector foot{exactly(r.s), exactly(r.t), exactly(0)};
    const double a = f.square[2][2].value;
    const double b = f.derivative(2, foot).value;
    const double c = f(foot).value;
    // Where the derivative is positive, it is the root of the discriminant.
    return -2 * c / (b + std::sqrt(b * b - 4 * a * c));
  }

  bool is_proved() const {
    return is_positive(f_->derivative(2, all_points())) &&
           is_negative(f_->range_at(rectangle_, lower_)) &&
           is_positive(f_->range_at(rectangle_, upper_));
  }

  double half_height() const {
    return std::max(upper_ - middle_, middle_ - lower_) * (1 + 0x1p-50) + 0x1p-1000;
  }
  UnitQuadric::Vector all_points() const {
    return {CertifiedDouble{rectangle_.s, rectangle_.a},
            CertifiedDouble{rectangle_.t, rectangle_.b}, CertifiedDouble{middle_, half_height()}};
  }
  UnitQuadric::Vector centre_point() const {
    const UnitQuadric::Vector guess{exactly(rectangle_.s), exactly(rectangle_.t), exactly(middle_)};
    // Between the guess and the zero, the derivative is one of those of the whole graph.
    const CertifiedDouble step = (*f_)(guess) / f_->derivative(2, all_points());
    return {guess[0], guess[1], widened(guess[2], magnitude(step))};
  }
  // The coefficients of s^i t^j in the height about points of the surface, up to degree `degree`.
  Series series(const UnitQuadric::Vector& at, std::size_t degree = order) const {
    const auto& square = f_->square;
    const CertifiedDouble slope = f_->derivative(2, at);
    Series z{};
    z[0][0] = at[2];
    z[1][0] = -f_->derivative(0, at) / slope;
    z[0][1] = -f_->derivative(1, at) / slope;
    for (std::size_t n = 2; n <= degree; ++n) {
      for (std::size_t i = 0; i <= n; ++i) {
        const std::size_t j = n - i;
        CertifiedDouble sum;
        if (n == 2) {
          sum = i == 2 ? square[0][0] : j == 2 ? square[1][1] : exactly(2) * square[0][1];
        }
        if (i > 0 && !is_zero(square[0][2])) {
          sum = sum + exactly(2) * square[0][2] * z[i - 1][j];
        }
        if (j > 0 && !is_zero(square[1][2])) {
          sum = sum + exactly(2) * square[1][2] * z[i][j - 1];
        }
        if (!is_zero(square[2][2])) sum = sum + square[2][2] * square_coefficient(z, i, j);
        z[i][j] = -sum / slope;
      }
    }
    return z;
  }
  // Of the square of the series without its constant.
  static CertifiedDouble square_coefficient(const Series& z, std::size_t i, std::size_t j) {
    CertifiedDouble sum;
    for (std::size_t k = 0; 2 * k <= i; ++k) {
      for (std::size_t l = 0; l <= j; ++l) {
        if (k + l == 0 || k + l == i + j || (2 * k == i && 2 * l > j)) continue;
        const CertifiedDouble product = z[k][l] * z[i - k][j - l];
        sum =
            sum + (2 * k == i && 2 * l == j ? product : exactly(2) * product);  // twice by symmetry
      }
    }
    return sum;
  }

  const UnitQuadric* f_;
  Rectangle rectangle_;
  double middle_;
  double lower_;
  double upper_;
};

}  // namespace exactcsg::measure::detail
