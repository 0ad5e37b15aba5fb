// SPDX-License-Identifier: Apache-2.0
#pragma once

// Taylor coefficients of functions of two variables, and the integral of such a function over a
// rectangle. [Certified]
//
// c[i][j] belongs to s^i t^j, i + j <= order; what is beyond is not there. Coefficients may be
// those at one point, or enclose those at every point of a rectangle: sums, products and roots of
// such series have the same meaning.
//
// LAW taylor_series.1  the coefficients of a result up to `degree` enclose those of the function,
// if
//                      those of the operands do.
// LAW taylor_series.2  integral encloses that of the function, if `at_centre` has its coefficients
//                      at the rectangle's centre below degree n, and `anywhere` those at every
//                      point of degree n; the error falls as the rectangle's size to the power n
//                      + 2.
//
// Lagrange's remainder: the terms of degree n have coefficients from somewhere in the rectangle.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "exactcsg/measure/certified_arithmetic.hpp"

namespace exactcsg::measure::detail {

constexpr std::size_t series_order = 6;
using Series = std::array<std::array<CertifiedDouble, series_order + 1>, series_order + 1>;

// The values of one variable at the points that `at` encloses: a coordinate itself.
inline Series coordinate_series(std::size_t variable, const CertifiedDouble& at) {
  Series result{};
  result[0][0] = at;
  result[variable == 0 ? 1 : 0][variable == 0 ? 0 : 1] = exactly(1);
  return result;
}
inline Series constant_series(const CertifiedDouble& value) {
  Series result{};
  result[0][0] = value;
  return result;
}

// visit(i, j) for i + j <= degree, lower degrees first.
template <class Visit>
void for_each_term(std::size_t degree, Visit&& visit) {
  for (std::size_t n = 0; n <= degree; ++n) {
    for (std::size_t i = 0; i <= n; ++i) visit(i, n - i);
  }
}

inline Series sum(const Series& a, const Series& b, std::size_t degree) {
  Series result{};
  for_each_term(degree, [&](std::size_t i, std::size_t j) { result[i][j] = a[i][j] + b[i][j]; });
  return result;
}
inline Series scaled(const CertifiedDouble& factor, const Series& a, std::size_t degree) {
  Series result{};
  for_each_term(degree, [&](std::size_t i, std::size_t j) { result[i][j] = factor * a[i][j]; });
  return result;
}
inline Series product(const Series& a, const Series& b, std::size_t degree) {
  Series result{};
  for_each_term(degree, [&](std::size_t i, std::size_t j) {
    for (std::size_t k = 0; k <= i; ++k) {
      for (std::size_t l = 0; l <= j; ++l) {
        if (is_zero(a[k][l]) || is_zero(b[i - k][j - l])) continue;
        result[i][j] = result[i][j] + a[k][l] * b[i - k][j - l];
      }
    }
  });
  return result;
}
// Along one variable, up to a degree below that of the series.
inline Series derivative(const Series& a, std::size_t variable, std::size_t degree) {
  Series result{};
  for_each_term(degree, [&](std::size_t i, std::size_t j) {
    result[i][j] = variable == 0 ? exactly(static_cast<double>(i + 1)) * a[i + 1][j]
                                 : exactly(static_cast<double>(j + 1)) * a[i][j + 1];
  });
  return result;
}

// Of a number that is at least 1, whatever its enclosure says.
inline CertifiedDouble root_of_at_least_one(const CertifiedDouble& x) {
  const double low = std::sqrt(std::max(1.0, (x.value - x.error) * (1 - 0x1p-50)));
  const double high = std::sqrt(std::max(1.0, (x.value + x.error) * (1 + 0x1p-50)));
  const double middle = low / 2 + high / 2;
  return {middle, (high - middle) * (1 + 0x1p-48) + middle * 0x1p-50};
}
// root_of_constant: that of the constant coefficient.
// REQUIRES the function is positive where the coefficients are taken.
inline Series root(const Series& a, const CertifiedDouble& root_of_constant, std::size_t degree) {
  Series result{};
  result[0][0] = root_of_constant;
  const CertifiedDouble twice = exactly(2) * result[0][0];
  for_each_term(degree, [&](std::size_t i, std::size_t j) {
    if (i + j == 0) return;
    CertifiedDouble rest = a[i][j];
    for (std::size_t k = 0; k <= i; ++k) {
      for (std::size_t l = 0; l <= j; ++l) {
        if (k + l == 0 || k + l == i + j) continue;
        rest = rest - result[k][l] * result[i - k][j - l];
      }
    }
    result[i][j] = rest / twice;
  });
  return result;
}

inline CertifiedDouble integral(const Rectangle& r, const Series& at_centre, const Series& anywhere,
                                std::size_t degree) {
  const auto powers = [](double x) {
    std::array<double, series_order + 1> result{1};
    for (std::size_t i = 1; i <= series_order; ++i) result[i] = result[i - 1] * x;
    return result;
  };
  const auto powers_a = powers(r.a);
  const auto powers_b = powers(r.b);
  CertifiedDouble sum;
  for_each_term(degree, [&](std::size_t i, std::size_t j) {
    const bool is_remainder = i + j == degree;
    const bool is_even = i % 2 == 0 && j % 2 == 0;
    if (!is_remainder && !is_even) return;  // odd powers integrate to 0
    // The mean of |s^i t^j|; its rounding is relative.
    const double mean = powers_a[i] * powers_b[j] / static_cast<double>((i + 1) * (j + 1));
    const CertifiedDouble weight{mean, mean * 0x1p-48};
    if (!is_remainder) {
      sum = sum + at_centre[i][j] * weight;
    } else if (is_even) {
      sum = sum + anywhere[i][j] * weight;
    } else {
      sum = widened(sum, magnitude(anywhere[i][j]) * magnitude(weight));
    }
  });
  return sum * exactly(4) * exactly(r.a) * exactly(r.b);
}

}  // namespace exactcsg::measure::detail
