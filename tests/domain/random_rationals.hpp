// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Random rational input of the kinds that break filters: small integers (many coincidences),
// decimals, long fractions, neighbours by a tiny amount.

#include <random>

#include "exactcsg/domain/point.hpp"

namespace exactcsg::domain::test {

class Random {
 public:
  // The first `kinds` kinds of numbers: 1 to 4, ever longer ones.
  explicit Random(std::uint64_t seed, int kinds = 4) : engine_(seed), kinds_(kinds) {}

  std::int64_t integer(std::int64_t low, std::int64_t high) {
    return std::uniform_int_distribution<std::int64_t>(low, high)(engine_);
  }
  bool one_in(std::int64_t count) { return integer(1, count) == 1; }

  Rational rational() {
    switch (integer(1, kinds_)) {
      case 1:
        return Rational(integer(-4, 4));
      case 2:
        return fraction(integer(-40, 40), integer(1, 9));
      case 3:
        return fraction(integer(-5000, 5000), 1000);
      default:
        return fraction(integer(-(1LL << 50), 1LL << 50), (1LL << 48) + integer(0, 100));
    }
  }
  Rational positive() {
    const Rational value = rational();
    return value == 0 ? Rational(1) : Rational(abs(value));
  }
  // 2^-exponent, either sign
  Rational tiny() {
    const Rational value(Integer(1), Integer(1) << static_cast<unsigned long>(integer(30, 200)));
    return one_in(2) ? value : Rational(-value);
  }
  template <std::size_t D>
  Coordinates<D> coordinates() {
    Coordinates<D> result;
    for (Rational& value : result) value = rational();
    return result;
  }
  template <std::size_t D>
  Coordinates<D> direction() {
    Coordinates<D> result;
    do {
      for (Rational& value : result) value = one_in(2) ? Rational(integer(-3, 3)) : rational();
    } while (result == Coordinates<D>{});
    return result;
  }
  template <std::size_t D>
  Box<D> box() {
    const Coordinates<D> lower = coordinates<D>();
    Coordinates<D> upper;
    const Rational size = one_in(3) ? Rational(abs(tiny())) : positive();
    for (std::size_t i = 0; i < D; ++i) upper[i] = lower[i] + size * integer(1, 3);
    return {Point<D>(lower), Point<D>(upper)};
  }

 private:
  static Rational fraction(std::int64_t numerator, std::int64_t denominator) {
    Rational value{Integer(numerator), Integer(denominator)};
    value.canonicalize();
    return value;
  }
  std::mt19937_64 engine_;
  int kinds_;
};

}  // namespace exactcsg::domain::test
