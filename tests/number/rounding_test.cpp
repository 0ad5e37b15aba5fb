// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/number/rounding.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace exactcsg {
namespace {

Rational power_of_two(long exponent) {
  Integer power;
  mpz_ui_pow_ui(power.get_mpz_t(), 2, static_cast<unsigned long>(std::abs(exponent)));
  return exponent >= 0 ? Rational(power) : Rational(Integer(1), power);
}

bool has_even_mantissa(double value) {
  int exponent = 0;
  const double mantissa = std::frexp(std::fabs(value), &exponent);
  return std::fmod(std::ldexp(mantissa, 53), 2) == 0;
}

// LAW rounding.1 and rounding.2, by exact distances from the neighbours of the answer.
void expect_nearest(const Rational& number) {
  const NearestDouble rounded = round_to_nearest(number);
  ASSERT_TRUE(std::isfinite(rounded.value)) << number;
  const Rational distance = abs(rational_of(rounded.value) - number);
  EXPECT_EQ(rounded.is_exact, distance == 0) << number;
  for (const double towards :
       {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()}) {
    const double neighbour = std::nextafter(rounded.value, towards);
    const Rational other = abs(rational_of(neighbour) - number);
    EXPECT_LE(distance, other) << number;
    EXPECT_TRUE(distance != other || has_even_mantissa(rounded.value)) << number;
  }
}

TEST(RoundToNearest, OfRandomFractionsOfEveryLength) {
  std::mt19937_64 random(7);
  gmp_randclass bits(gmp_randinit_mt);
  bits.seed(11);
  for (int i = 0; i < 20000; ++i) {
    Integer numerator = bits.get_z_bits(1 + random() % 260);
    if (numerator == 0) numerator = 1;
    if (random() % 2 == 0) numerator = -numerator;
    Rational number(numerator);
    if (random() % 3 != 0) {
      number *= power_of_two(-static_cast<long>(random() % 300));
    } else {
      Integer denominator = bits.get_z_bits(1 + random() % 260);
      number = Rational(numerator, denominator == 0 ? Integer(1) : denominator);
      number.canonicalize();
    }
    expect_nearest(number);
  }
}

// Halfway between two doubles, and one unit of a long tail beside it.
TEST(RoundToNearest, BesideTies) {
  std::mt19937_64 random(5);
  for (int i = 0; i < 2000; ++i) {
    const Integer mantissa = Integer(static_cast<unsigned long>(random() >> 11U)) +
                             Integer(static_cast<unsigned long>(1UL << 52U));
    const Rational tie = (mantissa * 2 + 1) * power_of_two(static_cast<long>(random() % 140) - 70);
    for (const long tail : {-60L, -120L, -400L}) {
      for (const int sign : {-1, 0, 1}) {
        const Rational number = tie * (1 + sign * power_of_two(tail));
        expect_nearest(number);
        expect_nearest(-number);
      }
    }
  }
}

TEST(RoundToNearest, OfLargeAndSmallDoubles) {
  for (const long exponent : {-900L, -701L, -699L, -64L, 0L, 63L, 64L, 127L, 128L, 700L, 899L}) {
    for (const double mantissa : {1.0, 1.5, 0x1.fffffffffffffp0, -0x1.0000000000001p0}) {
      const Rational number = rational_of(mantissa) * power_of_two(exponent);
      const NearestDouble rounded = round_to_nearest(number);
      EXPECT_EQ(rounded.value, std::ldexp(mantissa, static_cast<int>(exponent)));
      EXPECT_TRUE(rounded.is_exact) << exponent;
      expect_nearest(number * (1 + power_of_two(-80)));
    }
  }
  EXPECT_TRUE(round_to_nearest(0).is_exact);
  EXPECT_EQ(round_to_nearest(power_of_two(1030)).value, std::numeric_limits<double>::infinity());
  EXPECT_EQ(round_to_nearest(-power_of_two(-1090)).value, 0);
}

}  // namespace
}  // namespace exactcsg
