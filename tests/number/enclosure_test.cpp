// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/number/enclosure.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <random>

#include "exactcsg/support/error.hpp"

namespace exactcsg {
namespace {

Rational number(const char* text) { return *parse_rational(text); }

TEST(ToDecimal, RoundsAndWritesAsDocumented) {
  struct Case {
    const char* value;
    int digits;
    const char* expected;  // rounded by hand
  };
  const Case cases[] = {
      {"0", 5, "0"},
      {"12.5", 17, "12.5"},
      {"12.5", 2, "12"},  // tie to even
      {"13.5", 2, "14"},  // tie to even
      {"-12.5", 2, "-12"},
      {"12.500001", 2, "13"},
      {"1/3", 5, "0.33333"},
      {"2/3", 5, "0.66667"},
      {"9.9999", 3, "10"},
      {"99999", 3, "1e+05"},
      {"999", 3, "999"},
      {"1000", 3, "1e+03"},
      {"1234567", 7, "1234567"},
      {"1234567", 6, "1.23457e+06"},
      {"0.0001", 3, "0.0001"},
      {"0.00012345", 3, "0.000123"},
      {"0.00001", 3, "1e-05"},
      {"0.00000012345", 5, "1.2345e-07"},
      {"100", 17, "100"},
      {"1e-200", 4, "1e-200"},
      {"1.25e300", 2, "1.2e+300"},
      {"5", 1, "5"},
      {"95", 1, "1e+02"},  // 9.5 ties to the even 10
      {"85", 1, "8e+01"},
  };
  for (const Case& c : cases) {
    EXPECT_EQ(to_decimal(number(c.value), c.digits), c.expected) << c.value << ", " << c.digits;
  }
}

TEST(ToDecimal, AgreesWithTheCLibraryOnDoubles) {
  // glibc's printf rounds a double's exact value correctly, and %g has the same notation.
  std::mt19937_64 random(1);
  for (int i = 0; i < 20'000; ++i) {
    const double value = std::ldexp(static_cast<double>(static_cast<std::int64_t>(random())),
                                    static_cast<int>(random() % 200) - 160);
    const int digits = 1 + static_cast<int>(random() % 20);
    char expected[64];
    std::snprintf(expected, sizeof expected, "%.*g", digits, value);
    ASSERT_EQ(to_decimal(rational_of(value), digits), expected);
  }
}

// sqrt(2) by integer square roots.
Enclosure root_of_two(int bits) {
  Integer scaled = Integer(2) << static_cast<unsigned long>(2 * bits);
  const Integer root = sqrt(scaled);
  Rational lower(root);
  Rational upper(Integer(root + 1));
  lower >>= static_cast<unsigned long>(bits);
  upper >>= static_cast<unsigned long>(bits);
  return {lower, upper};
}

// LAW enclosure.1
TEST(ToDecimal, RefinesEnclosures) {
  // Expected: sqrt(2) from the OEIS, A002193.
  // 1.41421356237309504880168872...
  EXPECT_EQ(to_decimal(root_of_two, 16), "1.414213562373095");
  EXPECT_EQ(to_decimal(root_of_two, 17), "1.414213562373095");      // the next digit is 0
  EXPECT_EQ(to_decimal(root_of_two, 21), "1.4142135623730950488");  // and the 21st too
  EXPECT_EQ(to_decimal(root_of_two, 26), "1.4142135623730950488016887");
}

TEST(ToDecimal, RefinesUntilTheDigitIsCertain) {
  // 0.1249999...9 (300 nines) and a bit more than it: only a fine enclosure tells it from 0.125.
  const Rational value = number("0.125") - number("1e-300");
  int asked = 0;
  const auto enclose = [&](int bits) {
    asked = bits;
    Rational width(1);
    width >>= static_cast<unsigned long>(bits);
    return Enclosure{value - width, value + width};
  };
  EXPECT_EQ(to_decimal(enclose, 2), "0.12");
  EXPECT_GT(asked, 900);
}

TEST(ToDecimal, AcceptsAPointAndGivesUpOnAnEternalDoubt) {
  EXPECT_EQ(to_decimal([](int) { return Enclosure{0, 0}; }, 9), "0");
  const auto around_a_tie = [](int bits) {
    Rational width(1);
    width >>= static_cast<unsigned long>(bits);
    return Enclosure{number("0.5") - width, number("0.5") + width};
  };
  EXPECT_EQ(to_decimal(around_a_tie, 3), "0.5");  // not a tie at three digits
  const auto tie = [](int bits) {
    Rational width(1);
    width >>= static_cast<unsigned long>(bits);
    return Enclosure{number("1.5") - width, number("1.5") + width};
  };
  EXPECT_THROW(to_decimal(tie, 1), Error);
}

}  // namespace
}  // namespace exactcsg
