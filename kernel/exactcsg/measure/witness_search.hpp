// SPDX-License-Identifier: Apache-2.0
#pragma once

// Guesses in doubles: points where polynomials of a cell are negative, and factors by which a sum
// of two of them may be shown to be nowhere negative. Who uses them checks them exactly.
// [Approximate]
//
// If f + mu g >= 0 everywhere, mu > 0, then f < 0 and g < 0 exclude each other (the S-lemma says
// that for two quadrics nothing else is needed). The least point of f + mu g is in the middle of
// the thin lens in which both are negative, if there is one; where the sets only touch, it is the
// point of contact. So one search along mu serves both ends.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>

#include "exactcsg/measure/unit_quadric.hpp"

namespace exactcsg::measure::detail {

using Position = std::array<double, 3>;

struct ApproximateQuadric {
  double constant = 0;
  Position linear{};
  std::array<Position, 3> square{};

  // Of f, or of -f; to second order about the cell's centre if f is no polynomial.
  explicit ApproximateQuadric(const UnitSurface& f, bool is_negated) {
    const double sign = is_negated ? -1 : 1;
    const UnitSurface::Vector centre{};
    constant = sign * f(centre).value;
    for (std::size_t i = 0; i < 3; ++i) {
      linear[i] = sign * f.derivative(i, centre).value;
      for (std::size_t j = 0; j < 3; ++j) {
        square[i][j] = sign * f.half_second_derivative(i, j, centre).value;
      }
    }
  }
  double operator()(const Position& x) const {
    double value = constant;
    for (std::size_t i = 0; i < 3; ++i) {
      double factor = linear[i];
      for (std::size_t j = 0; j < 3; ++j) factor += square[i][j] * x[j];
      value += factor * x[i];
    }
    return value;
  }
  Position gradient(const Position& x) const {
    Position result = linear;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) result[i] += 2 * square[i][j] * x[j];
    }
    return result;
  }
  double curvature_scale() const {
    double scale = 0;
    for (const Position& row : square) {
      for (const double x : row) scale = std::max(scale, std::abs(x));
    }
    return scale;
  }
  double scale() const {
    double scale = curvature_scale();
    for (const double x : linear) scale = std::max(scale, std::abs(x));
    return scale;
  }
};

// Where f + mu g is least; nullopt if it is not convex. Of several such points about the nearest
// to the origin.
inline std::optional<Position> least_point(const ApproximateQuadric& f, const ApproximateQuadric& g,
                                           double mu) {
  const double regular = 0x1p-40 * (f.curvature_scale() + mu * g.curvature_scale());
  if (!(regular > 0)) return std::nullopt;
  std::array<Position, 3> m{};  // Cholesky's factor, below the diagonal
  Position x{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = 2 * (f.square[i][j] + mu * g.square[i][j]) + (i == j ? regular : 0);
      for (std::size_t k = 0; k < j; ++k) sum -= m[i][k] * m[j][k];
      if (i != j) {
        m[i][j] = sum / m[j][j];
      } else if (sum > 0) {
        m[i][i] = std::sqrt(sum);
      } else {
        return std::nullopt;
      }
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    x[i] = -(f.linear[i] + mu * g.linear[i]);
    for (std::size_t k = 0; k < i; ++k) x[i] -= m[i][k] * x[k];
    x[i] /= m[i][i];
  }
  for (std::size_t i = 3; i-- > 0;) {
    for (std::size_t k = i + 1; k < 3; ++k) x[i] -= m[k][i] * x[k];
    x[i] /= m[i][i];
  }
  return x;
}

struct Balance {
  double factor = 0;
  Position point{};
};

// Where neither is convex, the sum is for factors between two bounds, if for any: the first found,
// from the one that makes both as large outwards.
inline std::optional<Balance> balance_of_saddles(const ApproximateQuadric& f,
                                                 const ApproximateQuadric& g, double even) {
  for (int i = 0; i < 64; ++i) {
    const double mu = std::exp2(even + (i % 2 == 0 ? i : -i - 1) / 8.0);
    if (const auto point = least_point(f, g, mu)) return Balance{mu, *point};
  }
  return std::nullopt;
}

// The factor at which f and g are equal at the least point, in relation to their scales.
inline std::optional<Balance> balance(const ApproximateQuadric& f, const ApproximateQuadric& g) {
  const double f_scale = f.scale();
  const double g_scale = g.scale();
  if (!(f_scale > 0 && g_scale > 0)) return std::nullopt;
  const auto is_convex = [](const ApproximateQuadric& h) {
    return h.curvature_scale() == 0 || least_point(h, h, 1).has_value();
  };
  const bool f_is_convex = is_convex(f);
  const double even = std::log2(f_scale / g_scale);
  if (!f_is_convex && !is_convex(g)) return balance_of_saddles(f, g, even);
  double low = even - 40;
  double high = even + 40;
  std::optional<Balance> best;
  for (int i = 0; i < 64; ++i) {
    const double middle = (low + high) / 2;
    const double mu = std::exp2(middle);
    const auto point = least_point(f, g, mu);
    const bool is_too_large = point ? f(*point) / f_scale > g(*point) / g_scale : f_is_convex;
    (is_too_large ? high : low) = middle;
    if (point) best = Balance{mu, *point};
  }
  return best;
}

// The factor that makes the leading coefficients of both cancel, if one does.
inline std::optional<double> cancelling_factor(const ApproximateQuadric& f,
                                               const ApproximateQuadric& g) {
  const double curvature = g.curvature_scale();
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3 && curvature > 0; ++j) {
      if (std::abs(g.square[i][j]) < curvature) continue;
      const double factor = -f.square[i][j] / g.square[i][j];
      return factor > 0 ? std::optional(factor) : std::nullopt;
    }
  }
  const double slope = g.scale();
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(slope > 0) || std::abs(g.linear[i]) < slope) continue;
    const double factor = -f.linear[i] / g.linear[i];
    return factor > 0 && f.curvature_scale() == 0 ? std::optional(factor) : std::nullopt;
  }
  return std::nullopt;
}

// A point of the cell at which all are negative, perhaps: from the cell's centre, across one
// surface after the other.
inline Position pushed_inside(std::span<const ApproximateQuadric> polynomials) {
  Position x{};
  double margin = 0x1p-4;
  for (int turn = 0; turn < 64; ++turn, margin *= 0.75) {
    bool is_inside = true;
    for (const ApproximateQuadric& f : polynomials) {
      const Position slope = f.gradient(x);
      const double square = slope[0] * slope[0] + slope[1] * slope[1] + slope[2] * slope[2];
      const double excess = f(x) + margin * std::sqrt(square);
      if (excess <= 0 || !(square > 0)) continue;
      is_inside = false;
      for (std::size_t i = 0; i < 3; ++i) {
        x[i] = std::clamp(x[i] - excess / square * slope[i], -0.9375, 0.9375);
      }
    }
    if (is_inside) break;
  }
  return x;
}

// Where a function is least in the closed cell, perhaps: from the centre, by steps along the axes.
// What reaches the cell in a thin lens across one of its walls is found there.
inline Position low_point(const UnitSurface& f, bool is_negated) {
  constexpr int sweeps = 4;
  const double sign = is_negated ? -1 : 1;
  Position x{};
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (std::size_t i = 0; i < 3; ++i) {
      const UnitSurface::Vector at{exactly(x[0]), exactly(x[1]), exactly(x[2])};
      const double slope = sign * f.derivative(i, at).value;
      const double curvature = sign * f.half_second_derivative(i, i, at).value;
      const double step = curvature > 0 ? -slope / (2 * curvature) : slope > 0 ? -2 : 2;
      x[i] = std::clamp(x[i] + step, -1.0, 1.0);
    }
  }
  return x;
}

// The fraction with the least denominator within a relative 2^-26 of the value, which is positive.
inline Rational simple_fraction(double value) {
  Integer p0 = 0;
  Integer q0 = 1;
  Integer p1 = 1;
  Integer q1 = 0;
  double rest = value;
  for (int i = 0; i < 32 && std::abs(rest) < 0x1p60; ++i) {
    const double whole = std::floor(rest);
    const Integer digit(whole);
    Integer p = digit * p1 + p0;
    Integer q = digit * q1 + q0;
    p0.swap(p1);
    q0.swap(q1);
    p1.swap(p);
    q1.swap(q);
    Rational fraction(p1, q1);
    fraction.canonicalize();
    if (std::abs(fraction.get_d() - value) <= 0x1p-26 * value) return fraction;
    rest = 1 / (rest - whole);
  }
  return rational_of(value);
}

}  // namespace exactcsg::measure::detail
