// SPDX-License-Identifier: Apache-2.0
#pragma once

// A real number as a double and a bound on how far it is off. [Certified]
//
// LAW certified.1  if the true operands are within the errors of the stored ones, the true result
// is within the error of the stored result. Overflow gives an infinite or NaN error, which no
// comparison `value > error` accepts.

#include <cmath>

#include "exactcsg/number/exact.hpp"

namespace exactcsg {

struct CertifiedDouble {
  double value = 0;
  double error = 0;

  double lower() const { return value - error - 0x1p-52 * std::abs(value); }
  double upper() const { return value + error + 0x1p-52 * std::abs(value); }
};

// Rounding to nearest is off by at most u |value|, or half the least subnormal. Subnormal errors,
// which are slow to compute with, are avoided.
inline CertifiedDouble certified_double_of(const Rational& value) {
  if (value == 0) return {};
  const double nearest = nearest_double(value);
  const double magnitude = std::abs(nearest);
  return {nearest, magnitude < 0x1p-900 ? 0x1p-950 : 0x1p-53 * magnitude * (1 + 0x1p-51)};
}

// Each operation's own rounding is at most u |result| (u = 2^-53) plus half the least subnormal;
// the error terms themselves are rounded, a relative 2^-52 each: doubling u and adding 2^-1000
// covers both.
inline CertifiedDouble operator+(CertifiedDouble a, CertifiedDouble b) {
  const double sum = a.value + b.value;
  return {sum, (a.error + b.error) * (1 + 0x1p-51) + 0x1p-52 * std::abs(sum)};
}

inline CertifiedDouble operator-(CertifiedDouble a) { return {-a.value, a.error}; }
inline CertifiedDouble operator-(CertifiedDouble a, CertifiedDouble b) { return a + (-b); }

inline CertifiedDouble operator*(CertifiedDouble a, CertifiedDouble b) {
  const double product = a.value * b.value;
  const double spread =
      std::abs(a.value) * b.error + std::abs(b.value) * a.error + a.error * b.error;
  return {product, spread * (1 + 0x1p-50) + 0x1p-52 * std::abs(product) + 0x1p-1000};
}

// The error is infinite if the divisor may be zero.
inline CertifiedDouble operator/(CertifiedDouble a, CertifiedDouble b) {
  const double quotient = a.value / b.value;
  const double least = std::abs(b.value) * (1 - 0x1p-50) - b.error;
  if (!(least > 0)) return {quotient, HUGE_VAL};
  const double spread = (a.error + std::abs(quotient) * b.error) / least;
  return {quotient, spread * (1 + 0x1p-50) + 0x1p-51 * std::abs(quotient) + 0x1p-1000};
}

}  // namespace exactcsg
