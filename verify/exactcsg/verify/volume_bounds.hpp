// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Two bounds of one volume, compared and printed. [Exact]

#include <algorithm>
#include <string>

#include "exactcsg/measure/decimal_bounds.hpp"
#include "exactcsg/number/enclosure.hpp"

namespace exactcsg::verify {

// 0 if they have a number in common.
inline Rational gap_between(const Enclosure& a, const Enclosure& b) {
  const Rational gap = std::max(Rational(a.lower - b.upper), Rational(b.lower - a.upper));
  return std::max(gap, Rational(0));
}

// "10.5413 to 10.5414", rounded outwards.
inline std::string text_of(const Enclosure& bounds) {
  constexpr int digits = 8;
  const measure::DecimalBounds text = measure::decimal_bounds(bounds, digits);
  return text.lower + " to " + text.upper;
}

}  // namespace exactcsg::verify
