// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/number/exact.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <sstream>

#include "exactcsg/support/error.hpp"

namespace exactcsg {
namespace {

Rational fraction(const char* text) {
  Rational value(text);
  value.canonicalize();
  return value;
}

TEST(ParseRational, ReadsWhatTheTextMeans) {
  // Expected: the decimal read by hand.
  const std::pair<const char*, const char*> cases[] = {
      {"0", "0"},
      {"-12", "-12"},
      {"+7", "7"},
      {"0.1", "1/10"},
      {"-0.25", "-1/4"},
      {".5", "1/2"},
      {"5.", "5"},
      {"1e-7", "1/10000000"},
      {"+1.5E+3", "1500"},
      {"2/3", "2/3"},
      {"-4/6", "-2/3"},
      {"+6/3", "2"},
      {"0/5", "0"},
      {"-0", "0"},
      {"-0.0e5", "0"},
      {"00012", "12"},
      {"1e0000002", "100"},
      {"12.50e-1", "5/4"},
      {"0.000000000000000000001e21", "1"},
  };
  for (const auto& [text, expected] : cases) {
    const auto value = parse_rational(text);
    ASSERT_TRUE(value) << text;
    EXPECT_EQ(*value, fraction(expected)) << text;
    EXPECT_EQ(gcd(value->get_num(), value->get_den()), 1) << text;
    EXPECT_GT(value->get_den(), 0) << text;
  }
}

TEST(ParseRational, RefusesWhatIsNoNumber) {
  for (const char* text :
       {"",      " ",     " 1",    "1 ",   "nan", "inf",   "-inf",  "NaN",      ".",    "+",
        "-",     "e5",    "1e",    "1e+",  "--1", "1.2.3", "1/0",   "1/",       "/2",   "1/-2",
        "1/2/3", "1.5/2", "1/2.5", "0x10", "1,5", "1e5.5", "1_000", "\xd9\xa1", "1e2/3"}) {
    EXPECT_FALSE(parse_rational(text)) << text;
  }
}

TEST(ParseRational, RefusesNumbersThatCostTooMuch) {
  const auto id_of = [](const std::string& text) -> std::optional<ErrorId> {
    try {
      parse_rational(text);
    } catch (const Error& error) {
      return error.id();
    }
    return std::nullopt;
  };
  EXPECT_EQ(id_of("1e1000"), ErrorId::NumberOutOfRange);
  EXPECT_EQ(id_of("1e-1000"), ErrorId::NumberOutOfRange);
  EXPECT_EQ(id_of("1e99999999999999999999"), ErrorId::NumberOutOfRange);
  EXPECT_EQ(id_of(std::string(2001, '7')), ErrorId::NumberOutOfRange);
  EXPECT_EQ(id_of(std::string(1500, '7') + '/' + std::string(1500, '7')),
            ErrorId::NumberOutOfRange);
  EXPECT_EQ(id_of("1e999"), std::nullopt);
  EXPECT_EQ(id_of("1e-999"), std::nullopt);
  EXPECT_EQ(id_of(std::string(2000, '7')), std::nullopt);
}

TEST(ToText, LawExact2) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 2000; ++i) {
    Rational value(static_cast<long>(random()), static_cast<long>(random() >> (1 + i % 62)) + 1);
    value.canonicalize();
    EXPECT_EQ(parse_rational(to_text(value)), value);
  }
  EXPECT_EQ(to_text(fraction("-2/3")), "-2/3");
  EXPECT_EQ(to_text(Rational(7)), "7");
}

TEST(RationalOf, IsTheDoublesValue) {
  // Expected: powers of two by definition of the format.
  EXPECT_EQ(rational_of(0.5), fraction("1/2"));
  EXPECT_EQ(rational_of(-0.0), 0);
  Rational smallest(1);
  smallest >>= 1074;
  EXPECT_EQ(rational_of(std::numeric_limits<double>::denorm_min()), smallest);
  EXPECT_EQ(rational_of(0.1), fraction("3602879701896397/36028797018963968"));
}

// LAW exact.1: rounding back is the identity on doubles, of every size and sign.
TEST(NearestDouble, KeepsDoubles) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 200'000; ++i) {
    const auto value = std::bit_cast<double>(random());
    if (!std::isfinite(value)) continue;
    ASSERT_EQ(nearest_double(rational_of(value)), value) << std::hexfloat << value;
  }
}

// LAW exact.1: the midpoint of two neighbours goes to the even one, and anything beside it to the
// nearer one. The expected value is one of the two by construction.
TEST(NearestDouble, RoundsToNearestTiesToEven) {
  std::mt19937_64 random(4);
  for (int i = 0; i < 50'000; ++i) {
    auto bits = random() & 0x7fffffffffffffffULL;
    if (i % 3 == 0) bits &= 0x000fffffffffffffULL;  // subnormal
    const auto lower = std::bit_cast<double>(bits);
    const auto upper = std::bit_cast<double>(bits + 1);
    if (!std::isfinite(upper)) continue;
    const Rational middle = (rational_of(lower) + rational_of(upper)) / 2;
    const double even = (bits & 1U) == 0 ? lower : upper;
    ASSERT_EQ(nearest_double(middle), even) << std::hexfloat << lower;
    ASSERT_EQ(nearest_double(-middle), -even) << std::hexfloat << lower;
    Rational little = (rational_of(upper) - rational_of(lower)) / Integer(3 + (random() >> 3U));
    if (i % 2 == 0) little >>= 70;
    ASSERT_EQ(nearest_double(middle + little), upper) << std::hexfloat << lower;
    ASSERT_EQ(nearest_double(middle - little), lower) << std::hexfloat << lower;
  }
}

TEST(NearestDouble, AgreesWithTheCLibraryOnDecimals) {
  // strtod of glibc is correctly rounded.
  std::mt19937_64 random(5);
  for (int i = 0; i < 20'000; ++i) {
    std::ostringstream text;
    text << random() << (i % 2 == 0 ? "" : std::to_string(random())) << 'e'
         << static_cast<int>(random() % 700) - 360;
    ASSERT_EQ(nearest_double(*parse_rational(text.str())), std::strtod(text.str().c_str(), nullptr))
        << text.str();
  }
}

TEST(NearestDouble, OverflowsToInfinity) {
  constexpr double largest = std::numeric_limits<double>::max();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  // The midpoint between the largest double and 2^1024 is a tie that rounds to infinity.
  const Rational unit = rational_of(largest) - rational_of(std::nextafter(largest, 0.0));
  const Rational middle = rational_of(largest) + unit / 2;
  EXPECT_EQ(nearest_double(middle), infinity);
  EXPECT_EQ(nearest_double(-middle), -infinity);
  EXPECT_EQ(nearest_double(middle - unit / 1000), largest);
  EXPECT_EQ(nearest_double(*parse_rational("1e999")), infinity);
  EXPECT_EQ(nearest_double(*parse_rational("1e-999")), 0);
}

}  // namespace
}  // namespace exactcsg
