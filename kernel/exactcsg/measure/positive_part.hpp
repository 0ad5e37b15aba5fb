// SPDX-License-Identifier: Apache-2.0
#pragma once

// The mean of the positive part of a function of two variables over a square. [Certified]
//
// Where a polynomial T grows along u, its positive part is that of the points beyond a curve
// u = c(v). The polynomial is integrated beyond a parabola near that curve: what lies between the
// two is narrow, and T is small there. If T(parabola) <= rho and dT/du >= m, the mean is off by at
// most rho^2 / (2 m), which falls as the fifth power of the size of the rectangle that the square
// stands for.
//
// LAW positive_part.1  mean_of_positive_part(d, T, error) encloses the mean over -1 <= u, v <= 1 of
//                      max(0, D) for every D with |D - d - T| <= error.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "exactcsg/measure/implicit_polynomial.hpp"

namespace exactcsg::measure::detail {

// The mean of max(0, d + p u + q v) over -1 <= u, v <= 1. REQUIRES p, q >= 0. Its error is below
// 2^-44 (|d| + p + q): all terms are positive, and errors in where the pieces meet are squared.
inline double mean_of_positive_part(double d, double p, double q) {
  if (p < q) std::swap(p, q);
  if (d >= p + q) return d;
  if (d <= -p - q) return 0;
  // Half the integral over u at one v.
  const auto inner = [&](double v) {
    const double m = d + q * v;
    if (m >= p) return m;
    return m <= -p ? 0.0 : (m + p) * (m + p) / (4 * p);
  };
  // It is a polynomial of degree at most two between these: Simpson's rule is exact.
  const double first = q > 0 ? std::clamp((-p - d) / q, -1.0, 1.0) : -1.0;
  const double second = q > 0 ? std::clamp((p - d) / q, -1.0, 1.0) : 1.0;
  const std::array<double, 4> ends{-1.0, first, second, 1.0};
  double integral = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double from = ends[i];
    const double to = ends[i + 1];
    if (!(from < to)) continue;
    integral += (to - from) / 6 * (inner(from) + 4 * inner(from / 2 + to / 2) + inner(to));
  }
  return integral / 2;
}

// u = c[0] + c[1] v + c[2] v^2
struct Parabola {
  std::array<double, 3> c{};

  double operator()(double v) const { return c[0] + v * (c[1] + v * c[2]); }
  double norm() const { return std::abs(c[0]) + std::abs(c[1]) + std::abs(c[2]); }
  // Of all values between two v.
  std::pair<double, double> range(double from, double to) const {
    double low = std::min((*this)(from), (*this)(to));
    double high = std::max((*this)(from), (*this)(to));
    const double vertex = -c[1] / (2 * c[2]);
    if (vertex > from && vertex < to) {
      low = std::min(low, (*this)(vertex));
      high = std::max(high, (*this)(vertex));
    }
    const double rounding = 0x1p-49 * norm();
    return {low - rounding, high + rounding};
  }
  // Calls visit(v) for v in (-1, 1) at which u is nearly `value`.
  template <class Visit>
  void for_each_crossing(double value, Visit&& visit) const {
    const double discriminant = c[1] * c[1] - 4 * c[2] * (c[0] - value);
    if (!(discriminant >= 0)) return;
    const double q = -0.5 * (c[1] + std::copysign(std::sqrt(discriminant), c[1]));
    for (const double v : {q / c[2], (c[0] - value) / q}) {
      if (v > -1 && v < 1) visit(v);
    }
  }
};

// d + T on the square, turned so that it grows along u, and how it is integrated.
template <std::size_t Degree>
class PositivePart {
 public:
  PositivePart(double d, const PartedPolynomial<Degree>& t) {
    const double along_u = t[1][1];
    const double along_v = t[1][0];
    const bool swaps = std::abs(along_v) > std::abs(along_u);
    const bool mirrors = (swaps ? along_v : along_u) < 0;
    a_[0][0] = d;
    for (std::size_t n = 1; n <= Degree; ++n) {
      for (std::size_t i = 0; i <= n; ++i) {
        const double x = t[n][swaps ? n - i : i];
        a_[i][n - i] = mirrors && i % 2 == 1 ? -x : x;
      }
    }
  }

  // An infinite error where nothing is known.
  CertifiedDouble mean() const {
    const CertifiedDouble nothing{0, HUGE_VAL};
    const Parabola curve = curve_of_zeros();
    const double reach = std::max(1.0, curve.norm()) * (1 + 0x1p-48);
    if (!(reach < 4)) return nothing;
    const double least_slope = slope_within(reach);
    if (!(least_slope > 0)) return nothing;
    const double norm = norm_within(reach);
    constexpr double rounding = 0x1p-45;
    double residual = rounding * norm;
    for (const double x : beyond(curve, a_)) residual += std::abs(x);

    Coefficients antiderivative;  // divided by u
    for (std::size_t i = 0; i <= Degree; ++i) {
      for (std::size_t j = 0; i + j <= Degree; ++j) {
        antiderivative[i][j] = a_[i][j] / static_cast<double>(i + 1);
      }
    }
    const Composed at_parabola = times(curve, beyond(curve, antiderivative));
    Composed at_end = at_side(antiderivative, 1);
    Composed whole = at_end;
    const Composed at_begin = at_side(antiderivative, -1);
    for (std::size_t j = 0; j < whole.size(); ++j) {
      whole[j] -= at_begin[j];
      at_end[j] -= at_parabola[j];
    }

    std::array<double, 6> ends{-1};  // ascending
    std::size_t count = 1;
    for (const double side : {-1.0, 1.0}) {
      curve.for_each_crossing(side, [&](double v) {
        std::size_t at = count++;
        for (; ends[at - 1] > v; --at) ends[at] = ends[at - 1];
        ends[at] = v;
      });
    }
    ends[count++] = 1;
    double integral = 0;
    double excess = 0;  // by how much the parabola is elsewhere than is taken for granted
    for (std::size_t k = 0; k + 1 < count; ++k) {
      const double from = ends[k];
      const double to = ends[k + 1];
      if (!(from < to)) continue;
      const auto [low, high] = curve.range(from, to);
      const double middle = curve(from / 2 + to / 2);
      if (middle >= 1) {
        excess = std::max(excess, 1 - low);
      } else if (middle <= -1) {
        excess = std::max(excess, high + 1);
        integral += integral_of(whole, from, to);
      } else {
        excess = std::max({excess, high - 1, -1 - low});
        integral += integral_of(at_end, from, to);
      }
    }
    const double error =
        residual * residual / (2 * least_slope) + (excess + 4 * rounding) * norm * reach;
    return {integral / 4, error * (1 + 0x1p-40)};
  }

 private:
  // a[i][j] belongs to u^i v^j
  using Coefficients = std::array<std::array<double, Degree + 1>, Degree + 1>;
  // Of powers of v.
  using Composed = std::array<double, 2 * Degree + 3>;

  // Newton's steps, along u at v = 0 first.
  Parabola curve_of_zeros() const {
    Parabola curve;
    curve.c[0] = -a_[0][0] / a_[1][0];
    std::array<double, 3> along_u{};  // T and its first and second derivative along u
    for (int step = 0; step < 4; ++step) {
      along_u = {};
      for (std::size_t i = Degree + 1; i-- > 0;) {
        along_u[2] = along_u[2] * curve.c[0] + 2 * along_u[1];
        along_u[1] = along_u[1] * curve.c[0] + along_u[0];
        along_u[0] = along_u[0] * curve.c[0] + a_[i][0];
      }
      if (step < 3) curve.c[0] -= along_u[0] / along_u[1];
    }
    double along_v = 0;
    double mixed = 0;
    double twice_v = 0;
    for (std::size_t i = Degree; i-- > 0;) {
      mixed = mixed * curve.c[0] + along_v;
      along_v = along_v * curve.c[0] + a_[i][1];
      if (i + 2 <= Degree) twice_v = twice_v * curve.c[0] + a_[i][2];
    }
    const double slope = -along_v / along_u[1];
    curve.c[1] = slope;
    curve.c[2] = -(along_u[2] / 2 * slope * slope + mixed * slope + twice_v) / along_u[1];
    return curve;
  }

  // A lower bound of dT/du in |u| <= reach.
  double slope_within(double reach) const {
    double rest = 0;
    for (std::size_t i = Degree; i > 0; --i) {
      double row = 0;
      for (std::size_t j = i == 1 ? 1 : 0; i + j <= Degree; ++j) row += std::abs(a_[i][j]);
      rest = rest * reach + static_cast<double>(i) * row;
    }
    return a_[1][0] * (1 - 0x1p-45) - rest * (1 + 0x1p-45);
  }
  double norm_within(double reach) const {
    double sum = 0;
    for (std::size_t i = Degree + 1; i-- > 0;) {
      double row = 0;
      for (std::size_t j = 0; i + j <= Degree; ++j) row += std::abs(a_[i][j]);
      sum = sum * reach + row;
    }
    return sum;
  }

  static Composed times(const Parabola& curve, const Composed& p) {
    Composed result{};
    for (std::size_t j = 0; j + 2 < p.size(); ++j) {
      for (std::size_t k = 0; k < 3; ++k) result[j + k] += curve.c[k] * p[j];
    }
    return result;
  }
  // a at u = curve, up to degree 2 Degree.
  static Composed beyond(const Parabola& curve, const Coefficients& a) {
    Composed result{};
    for (std::size_t i = Degree + 1; i-- > 0;) {
      const std::size_t degree = 2 * (Degree - i);  // of what comes
      for (std::size_t j = degree + 1; j-- > 0;) {
        double sum = curve.c[0] * result[j];
        if (j >= 1) sum += curve.c[1] * result[j - 1];
        if (j >= 2) sum += curve.c[2] * result[j - 2];
        result[j] = sum;
      }
      for (std::size_t j = 0; i + j <= Degree; ++j) result[j] += a[i][j];
    }
    return result;
  }
  // u a at u = side.
  static Composed at_side(const Coefficients& a, double side) {
    Composed result{};
    double power = side;
    for (std::size_t i = 0; i <= Degree; ++i, power *= side) {
      for (std::size_t j = 0; i + j <= Degree; ++j) result[j] += power * a[i][j];
    }
    return result;
  }
  static double integral_of(const Composed& p, double from, double to) {
    double at_from = 0;
    double at_to = 0;
    for (std::size_t j = p.size(); j-- > 0;) {
      const double x = p[j] / static_cast<double>(j + 1);
      at_from = (at_from + x) * from;
      at_to = (at_to + x) * to;
      if (j == 0) break;
    }
    return at_to - at_from;
  }

  Coefficients a_{};
};

template <std::size_t Degree>
CertifiedDouble mean_of_positive_part(double d, const PartedPolynomial<Degree>& t, double error) {
  // Of a linear function, between two bounds: the mean grows at most as fast as d, and half as fast
  // as p and as q.
  const double p = std::abs(t[1][1]);
  const double q = std::abs(t[1][0]);
  const double curvature = t.norm() - t.norm_of_part(1);
  const double off = (error + curvature) * (1 + 0x1p-40);
  const double rounding = 0x1p-44 * (std::abs(d) + off + p + q) + 0x1p-1000;
  const double low = mean_of_positive_part(d - off, p, q) - rounding;
  const double high = mean_of_positive_part(d + off, p, q) + rounding;
  const CertifiedDouble linear = between(low, high);
  if (!(curvature > 0) || high <= rounding) return linear;
  const CertifiedDouble curved = PositivePart<Degree>(d, t).mean();
  const CertifiedDouble better = widened(curved, error);
  return better.error < linear.error ? better : linear;
}

}  // namespace exactcsg::measure::detail
