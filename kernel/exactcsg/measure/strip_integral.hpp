// SPDX-License-Identifier: Apache-2.0
#pragma once

// Integrals of a function of two variables over what curves leave of a square. [Certified]
//
// The square is -1 <= x, y <= 1. Functions on it are polynomials and a remainder (Taylor models); a
// curve is where a function that rises or falls strictly along y is 0.
//
// LAW strip_integral.1  curve_of(d, slope), if there is one, is a polynomial c with: for every x,
//                       the y in the square for which sign(d(x, y)) is not that of y - c(x) (of
//                       c(x) - y, if d falls) have a measure of at most `reach`.
// LAW strip_integral.2  integral_over_strips encloses the integral of the function over the points
//                       of the square where truth(above) is In, above[k] telling whether the point
//                       is above the zeros of function k; where truth is Unknown, of any part.
//
// Proof of 1: with |d| <= e along c and |d_y| >= m > 0 in the square, the zero is within e / m of
// c. Where c leaves the square, d's polynomial is followed there: it rises as well.
//
// Method: the polynomial c is any, found by power series in doubles; that it is good is proved. The
// square is cut along x where two of the curves and of the sides y = -1, y = 1 cross, nearly.
// Between the cuts the order of curves is known, but for overlaps, which are bounded: the integral
// over each strip between two neighbours is that of a polynomial in x, and its remainder.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "exactcsg/csg/membership.hpp"
#include "exactcsg/measure/taylor_series.hpp"

namespace exactcsg::measure::detail {

constexpr std::size_t line_degree = series_order - 1;
// Rounds up sums of few numbers that are not negative.
constexpr double round_up = 1 + 0x1p-40;

// A polynomial and how far off it is, for -1 <= x <= 1.
struct LineModel {
  std::array<CertifiedDouble, line_degree + 1> c{};
  double remainder = 0;

  double bound() const {
    double sum = remainder;
    for (const CertifiedDouble& coefficient : c) sum += magnitude(coefficient);
    return sum * round_up;
  }
};

inline LineModel operator*(const LineModel& f, const LineModel& g) {
  LineModel result;
  double beyond = 0;
  for (std::size_t i = 0; i <= line_degree; ++i) {
    if (is_zero(f.c[i])) continue;
    for (std::size_t j = 0; j <= line_degree; ++j) {
      if (is_zero(g.c[j])) continue;
      if (i + j <= line_degree) {
        result.c[i + j] = result.c[i + j] + f.c[i] * g.c[j];
      } else {
        beyond += magnitude(f.c[i]) * magnitude(g.c[j]);
      }
    }
  }
  const double of_f = f.remainder > 0 ? f.remainder * g.bound() : 0;
  const double of_g = g.remainder > 0 ? g.remainder * f.bound() : 0;
  result.remainder = (beyond + of_f + of_g) * round_up;
  return result;
}

// A polynomial on the square, coefficients c[i][j] of x^i y^j, and how far off it is.
struct SquareModel {
  Series c{};
  double remainder = 0;

  // From its coefficients at the centre of a rectangle below degree n, and those of degree n
  // anywhere there.
  SquareModel(const Series& at_centre, const Series& anywhere, std::size_t n, const Rectangle& r) {
    std::array<CertifiedDouble, series_order + 1> a{exactly(1)};
    std::array<CertifiedDouble, series_order + 1> b{exactly(1)};
    for (std::size_t i = 1; i <= n; ++i) {
      a[i] = a[i - 1] * exactly(r.a);
      b[i] = b[i - 1] * exactly(r.b);
    }
    for_each_term(n, [&](std::size_t i, std::size_t j) {
      const CertifiedDouble weight = a[i] * b[j];
      if (i + j < n) {
        if (!is_zero(at_centre[i][j])) c[i][j] = at_centre[i][j] * weight;
      } else {
        remainder += magnitude(anywhere[i][j]) * magnitude(weight);
      }
    });
    remainder *= round_up;
  }
  explicit SquareModel(const Series& coefficients) : c(coefficients) {}

  SquareModel transposed() const {
    SquareModel result = *this;
    for_each_term(line_degree, [&](std::size_t i, std::size_t j) { result.c[i][j] = c[j][i]; });
    return result;
  }
  // Of the polynomial, but for its constant, for |x| <= 1, |y| <= 1 + beyond.
  double bound_without_constant(double beyond = 0) const {
    double sum = 0;
    double power = 1;
    for (std::size_t j = 0; j <= line_degree; ++j, power *= 1 + beyond) {
      for (std::size_t i = j == 0 ? 1 : 0; i + j <= line_degree; ++i) {
        sum += magnitude(c[i][j]) * power;
      }
    }
    return sum * round_up;
  }
  // The function's sign on the square, if it has but one: Out where it is positive.
  csg::Membership membership() const {
    const CertifiedDouble range = widened(c[0][0], bound_without_constant() + remainder);
    return is_positive(range)   ? csg::Membership::Out
           : is_negative(range) ? csg::Membership::In
                                : csg::Membership::Unknown;
  }
  // f(x, y(x)) without the remainder of f.
  LineModel along(const LineModel& y) const {
    LineModel result;
    for (std::size_t j = line_degree + 1; j-- > 0;) {
      if (j < line_degree) result = result * y;
      for (std::size_t i = 0; i + j <= line_degree; ++i) {
        result.c[i] = result.c[i] + c[i][j];
      }
    }
    return result;
  }
  // By y, 0 at y = 0. REQUIRES no terms of degree line_degree
  SquareModel antiderivative() const {
    SquareModel result(Series{});
    for_each_term(line_degree - 1, [&](std::size_t i, std::size_t j) {
      result.c[i][j + 1] = c[i][j] / exactly(static_cast<double>(j + 1));
    });
    return result;
  }
};

using LinePolynomial = std::array<double, line_degree + 1>;

inline LineModel exactly(const LinePolynomial& f) {
  LineModel result;
  for (std::size_t i = 0; i <= line_degree; ++i) result.c[i] = exactly(f[i]);
  return result;
}
inline double value(const LinePolynomial& f, double x) {
  double result = f[line_degree];
  for (std::size_t i = line_degree; i-- > 0;) result = result * x + f[i];
  return result;
}

struct Curve {
  LinePolynomial c{};
  double reach = 0;
  bool is_rising = true;  // the function is positive above
};

// What curves are sought by. [Approximate]
class CurveGuess {
 public:
  explicit CurveGuess(const SquareModel& d) : d_(d) {}

  std::optional<LinePolynomial> run() const {
    LinePolynomial y{};
    if (!find_at_middle(y[0])) return std::nullopt;
    const double slope = value_and_slope(y[0]).second;
    // Each step leaves an error of one degree more.
    for (std::size_t n = 1; n <= line_degree; ++n) {
      const LinePolynomial error = along(y);
      for (std::size_t i = 1; i <= line_degree; ++i) y[i] -= error[i] / slope;
    }
    return y;
  }

 private:
  std::pair<double, double> value_and_slope(double y) const {
    double f = 0;
    double slope = 0;
    for (std::size_t j = line_degree + 1; j-- > 0;) {
      slope = slope * y + f;
      f = f * y + d_.c[0][j].value;
    }
    return {f, slope};
  }
  bool find_at_middle(double& y) const {
    for (int step = 0; step < 6; ++step) {
      const auto [f, slope] = value_and_slope(y);
      const double change = f / slope;
      if (!(std::abs(change) < 8)) return false;
      y -= change;
      if (std::abs(change) < 0x1p-48) break;
    }
    return true;
  }
  LinePolynomial along(const LinePolynomial& y) const {
    LinePolynomial result{};
    for (std::size_t j = line_degree + 1; j-- > 0;) {
      LinePolynomial next{};
      for (std::size_t i = 0; i <= line_degree; ++i) {
        for (std::size_t k = 0; i + k <= line_degree; ++k) next[i + k] += result[i] * y[k];
        if (i + j <= line_degree) next[i] += d_.c[i][j].value;
      }
      result = next;
    }
    return result;
  }

  const SquareModel& d_;
};

// slope: encloses the derivative of d by y at every point of the square.
inline std::optional<Curve> curve_of(const SquareModel& d, const CertifiedDouble& slope) {
  constexpr double farthest = 4;
  const double least = (std::abs(slope.value) - slope.error) * (1 - 0x1p-50);
  if (!(least > 0)) return std::nullopt;
  const std::optional<LinePolynomial> guess = CurveGuess(d).run();
  if (!guess) return std::nullopt;
  const LineModel y = exactly(*guess);
  const double farthest_y = y.bound();
  if (!(farthest_y < farthest)) return std::nullopt;
  if (farthest_y > 1) {
    double power = 1;
    double others = 0;
    for (std::size_t j = 1; j <= line_degree; ++j, power *= farthest_y) {
      for (std::size_t i = j == 1 ? 1 : 0; i + j <= line_degree; ++i) {
        others += static_cast<double>(j) * magnitude(d.c[i][j]) * power;
      }
    }
    const CertifiedDouble beyond = widened(d.c[0][1], others * round_up);
    if (!(slope.value > 0 ? is_positive(beyond) : is_negative(beyond))) return std::nullopt;
  }
  const double reach = (d.along(y).bound() + d.remainder) / least * round_up;
  if (!(reach < 2)) return std::nullopt;
  return Curve{*guess, reach, slope.value > 0};
}

class StripIntegral {
 public:
  // Curves and the sides, of which the lower one is the last but one.
  StripIntegral(const SquareModel& density, std::vector<Curve> curves)
      : density_(density), curves_(std::move(curves)), count_(curves_.size()) {
    Curve side;
    for (const double y : {-1.0, 1.0}) {
      side.c[0] = y;
      curves_.push_back(side);
    }
    const SquareModel below = density_.antiderivative();
    for (const Curve& curve : curves_) below_.push_back(below.along(exactly(curve.c)));
  }

  // nullopt: the curves' order is not known well enough.
  template <class Truth>
  std::optional<CertifiedDouble> run(Truth&& truth) const {
    const std::vector<double> cuts = cuts_where_curves_cross();
    // 4 is the area of the square.
    CertifiedDouble sum = widened({}, 4 * density_.remainder);
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      const auto part = between(cuts[i], cuts[i + 1], truth);
      if (!part) return std::nullopt;
      sum = sum + *part;
    }
    return sum;
  }

 private:
  LinePolynomial difference(std::size_t k, std::size_t l) const {
    LinePolynomial d{};
    for (std::size_t i = 0; i <= line_degree; ++i) d[i] = curves_[k].c[i] - curves_[l].c[i];
    return d;
  }

  std::vector<double> cuts_where_curves_cross() const {
    std::vector<double> cuts{-1, 1};
    for (std::size_t k = 0; k < curves_.size(); ++k) {
      for (std::size_t l = k + 1; l < curves_.size(); ++l) {
        const LinePolynomial d = difference(k, l);
        double low = -1;
        double high = 1;
        const bool is_rising = value(d, low) < 0;
        if (is_rising == (value(d, high) < 0)) continue;
        for (int step = 0; step < 60 && low < high; ++step) {
          double middle = next_guess(d, low, high, step);
          // Rounded, it may be an end of an interval that is still long.
          if (!(low < middle && middle < high)) middle = low / 2 + high / 2;
          if (!(low < middle && middle < high)) break;
          ((value(d, middle) < 0) == is_rising ? low : high) = middle;
        }
        cuts.push_back(low);
      }
    }
    std::sort(cuts.begin(), cuts.end());
    cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
    return cuts;
  }
  // Of the chord's zero, a little beyond it on the side of the end that is further off; bisection
  // by turns.
  static double next_guess(const LinePolynomial& d, double low, double high, int step) {
    const double middle = low / 2 + high / 2;
    if (step % 3 == 2) return middle;
    const double at_low = value(d, low);
    const double at_high = value(d, high);
    const double chord = low - at_low * (high - low) / (at_high - at_low);
    const double nudge = 0x1p-50 * (std::abs(chord) + 0x1p-10);
    return chord < middle ? chord + nudge : chord - nudge;
  }

  // The greatest excess of curve k over curve l.
  double overlap(std::size_t k, std::size_t l, double from, double to) const {
    LinePolynomial d = difference(k, l);
    double error = 0;  // of the differences
    for (double x : d) error += std::abs(x) * 0x1p-50;
    const auto at = [&](double x) {
      double magnitudes = 0;
      for (double coefficient : d) magnitudes += std::abs(coefficient);
      return value(d, x) + magnitudes * 0x1p-48;
    };
    const double middle = from / 2 + to / 2;
    const double half = (to / 2 - from / 2) * round_up;
    double slope = 0;  // in the middle
    double slope_error = 0;
    double bend = 0;          // no second derivative is greater in magnitude
    double bend_upwards = 0;  // no second derivative is greater
    for (std::size_t i = line_degree; i > 0; --i) {
      const double weight = static_cast<double>(i) * d[i];
      slope = slope * middle + weight;
      slope_error += std::abs(weight) * 0x1p-48;
      const double of_bend = static_cast<double>(i - 1) * weight;
      bend += std::abs(of_bend);
      bend_upwards += i > 2 ? std::abs(of_bend) : of_bend;
    }
    bend_upwards = std::max(0.0, bend_upwards + bend * 0x1p-48);
    const double greatest =
        std::abs(slope) > bend * half + slope_error
            ? std::max(at(from), at(to))
            : at(middle) +
                  (std::abs(slope) + slope_error + bend_upwards * half / 2) * half * round_up;
    return std::max(0.0, greatest + error);
  }

  template <class Truth>
  std::optional<CertifiedDouble> between(double from, double to, Truth&& truth) const {
    const std::vector<std::size_t> order = order_between(from, to);
    double misplaced = 0;
    double greatest_overlap = 0;
    for (std::size_t l = 1; l < order.size(); ++l) {
      double of_this = 0;
      for (std::size_t k = 0; k < l; ++k) {
        of_this = std::max(of_this, overlap(order[k], order[l], from, to));
      }
      greatest_overlap = std::max(greatest_overlap, of_this);
      misplaced += 2 * of_this;
    }
    if (!(greatest_overlap < 1)) return std::nullopt;
    for (std::size_t k = 0; k < count_; ++k) misplaced += curves_[k].reach;

    std::vector<bool> above(count_, false);
    CertifiedDouble sum;
    bool is_within = false;
    for (std::size_t i = 0; i + 1 < order.size(); ++i) {
      if (order[i] < count_) {
        above[order[i]] = true;
      } else {
        is_within = order[i] == count_;
      }
      if (!is_within) continue;
      const csg::Membership value = truth(above);
      if (value == csg::Membership::Out) continue;
      const CertifiedDouble strip = below(order[i + 1], from, to) - below(order[i], from, to);
      sum = sum + (value == csg::Membership::In ? strip : up_to(strip));
    }
    const double greatest =
        magnitude(density_.c[0][0]) + density_.bound_without_constant(greatest_overlap);
    return widened(sum, misplaced * greatest * (to - from) * round_up);
  }

  std::vector<std::size_t> order_between(double from, double to) const {
    std::vector<std::size_t> order(curves_.size());
    std::vector<double> heights(curves_.size());
    for (std::size_t k = 0; k < curves_.size(); ++k) {
      order[k] = k;
      heights[k] = value(curves_[k].c, from / 2 + to / 2);
    }
    std::sort(order.begin(), order.end(),
              [&](std::size_t k, std::size_t l) { return heights[k] < heights[l]; });
    return order;
  }

  // The integral over what is below the curve and above y = 0, negative where it is below that.
  CertifiedDouble below(std::size_t k, double from, double to) const {
    const LineModel& f = below_[k];
    CertifiedDouble sum;
    CertifiedDouble power_from = exactly(from);
    CertifiedDouble power_to = exactly(to);
    for (std::size_t i = 0; i <= line_degree; ++i) {
      sum = sum + f.c[i] * (power_to - power_from) / exactly(static_cast<double>(i + 1));
      power_from = power_from * exactly(from);
      power_to = power_to * exactly(to);
    }
    return widened(sum, f.remainder * (to - from) * round_up);
  }

  const SquareModel& density_;
  std::vector<Curve> curves_;
  std::size_t count_;  // without the sides
  std::vector<LineModel> below_;
};

// curves[k] belongs to above[k].
template <class Truth>
std::optional<CertifiedDouble> integral_over_strips(const SquareModel& density,
                                                    const std::vector<Curve>& curves,
                                                    Truth&& truth) {
  return StripIntegral(density, curves).run(truth);
}

}  // namespace exactcsg::measure::detail
