// SPDX-License-Identifier: Apache-2.0
#pragma once

// Bounds as decimals, rounded outwards. [Certified]
//
// LAW decimal_bounds.1  the decimals enclose the bounds, and differ from them by a relative
//                       2 * 10^(1 - digits) at most.

#include <string>
#include <utility>

#include "exactcsg/number/enclosure.hpp"

namespace exactcsg::measure {

struct DecimalBounds {
  std::string lower;
  std::string upper;
};

namespace detail {

// REQUIRES digits >= 2
inline std::string decimal_not_above(const Rational& value, int digits) {
  std::string nearest = to_decimal(value, digits);
  if (*parse_rational(nearest) <= value) return nearest;
  // At least one unit of the last digit, of which rounding takes back a half.
  Integer scale;
  mpz_ui_pow_ui(scale.get_mpz_t(), 10, static_cast<unsigned long>(digits - 1));
  return to_decimal(Rational(value - abs(value) / scale), digits);
}

}  // namespace detail

// REQUIRES digits >= 2
inline DecimalBounds decimal_bounds(const Enclosure& value, int digits) {
  std::string upper = detail::decimal_not_above(Rational(-value.upper), digits);
  if (upper.front() == '-') {
    upper.erase(0, 1);
  } else if (upper != "0") {
    upper.insert(0, 1, '-');
  }
  return {detail::decimal_not_above(value.lower, digits), std::move(upper)};
}

}  // namespace exactcsg::measure
