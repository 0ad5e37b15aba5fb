// SPDX-License-Identifier: Apache-2.0
#pragma once

// Exact integers and rationals (GMP), and how text and doubles become exact and back. [Exact]

#include <gmpxx.h>

#include <optional>
#include <string>
#include <string_view>

namespace exactcsg {

using Integer = mpz_class;
// Always canonical: coprime, positive denominator.
using Rational = mpq_class;

enum class Sign : signed char { Negative = -1, Zero = 0, Positive = 1 };

constexpr Sign operator-(Sign s) { return static_cast<Sign>(-static_cast<int>(s)); }
constexpr Sign operator*(Sign a, Sign b) {
  return static_cast<Sign>(static_cast<int>(a) * static_cast<int>(b));
}
constexpr Sign sign_of(int value) {
  return value > 0 ? Sign::Positive : value < 0 ? Sign::Negative : Sign::Zero;
}
inline Sign sign_of(const Integer& value) { return sign_of(sgn(value)); }
inline Sign sign_of(const Rational& value) { return sign_of(sgn(value)); }

// The rational that the text means: "-12", "0.1" (one tenth), "1e-7", "2/3", "+1.5E+3".
// nullopt: the text is no number of this form (also for "nan", "inf", "" and blanks).
// THROWS Error(NumberOutOfRange) if the decimal exponent exceeds 999 in magnitude or the text has
// more than 2000 digits: a file must not make us compute 10^(10^9).
std::optional<Rational> parse_rational(std::string_view text);

// Exactly the value of a finite double. REQUIRES std::isfinite(value).
Rational rational_of(double value);

// LAW exact.1  |nearest_double(r) - r| <= half a unit in the last place (round to nearest even);
// overflow gives +-infinity.
double nearest_double(const Rational& value);

// "7", "-2/3". LAW exact.2  parse_rational(to_text(r)) == r
std::string to_text(const Rational& value);

}  // namespace exactcsg
