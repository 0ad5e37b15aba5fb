// SPDX-License-Identifier: Apache-2.0
#pragma once

// What the certified measures ask of certified doubles, and the rectangles they integrate over.
// [Certified]

#include <cmath>

#include "exactcsg/number/certified_double.hpp"

namespace exactcsg::measure::detail {

// Bounds of what a certified double can be, whose own computation is off by a little more.
inline double magnitude(const CertifiedDouble& x) {
  return (std::abs(x.value) + x.error) * (1 + 0x1p-50);
}
inline bool is_positive(const CertifiedDouble& x) { return x.value > x.error; }
inline bool is_negative(const CertifiedDouble& x) { return -x.value > x.error; }
inline bool is_zero(const CertifiedDouble& x) { return x.value == 0 && x.error == 0; }
inline CertifiedDouble exactly(double value) { return {value, 0}; }
// Every number within `reach` of x.
inline CertifiedDouble widened(const CertifiedDouble& x, double reach) {
  return {x.value, (x.error + reach) * (1 + 0x1p-50)};
}
// Every number between 0 and x.
inline CertifiedDouble up_to(const CertifiedDouble& x) {
  const CertifiedDouble half = exactly(0.5) * x;
  return widened(half, magnitude(half));
}
// Every number between two that are exact.
inline CertifiedDouble between(double low, double high) {
  const double middle = low / 2 + high / 2;
  return {middle, (high - low) / 2 * (1 + 0x1p-50) + std::abs(middle) * 0x1p-51 + 0x1p-1000};
}

// [s - a, s + a] x [t - b, t + b], of numbers that are exact.
struct Rectangle {
  double s = 0;
  double t = 0;
  double a = 1;
  double b = 1;
  double area() const { return 4 * a * b; }
};

}  // namespace exactcsg::measure::detail
