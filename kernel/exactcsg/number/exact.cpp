// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/number/exact.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>

#include "exactcsg/support/error.hpp"

namespace exactcsg {

namespace {

constexpr std::size_t maximal_digits = 2000;
constexpr long maximal_exponent = 999;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Takes the longest run of digits off the front of `text`.
std::string_view take_digits(std::string_view& text) {
  const auto end = std::find_if_not(text.begin(), text.end(), is_digit);
  const auto count = static_cast<std::size_t>(end - text.begin());
  const std::string_view digits = text.substr(0, count);
  text.remove_prefix(count);
  return digits;
}

bool take(std::string_view& text, char c) {
  if (text.empty() || text.front() != c) return false;
  text.remove_prefix(1);
  return true;
}

// +1 or -1, taken off the front of `text`.
int take_sign(std::string_view& text) {
  if (take(text, '-')) return -1;
  take(text, '+');
  return 1;
}

[[noreturn]] void throw_out_of_range(std::string found, std::string expected) {
  throw Error(ErrorId::NumberOutOfRange, {std::move(found), std::move(expected)});
}

void check_digits(std::size_t count) {
  if (count > maximal_digits) {
    throw_out_of_range("a number of " + std::to_string(count) + " digits",
                       "at most " + std::to_string(maximal_digits) + " digits");
  }
}

// The value of the digits of an exponent. THROWS Error(NumberOutOfRange)
long exponent_of(std::string_view digits) {
  const std::size_t first = std::min(digits.find_first_not_of('0'), digits.size());
  const std::string_view significant = digits.substr(first);
  long value = 0;
  if (significant.size() <= 3) {
    for (const char c : significant) value = value * 10 + (c - '0');
  }
  if (significant.size() > 3 || value > maximal_exponent) {
    throw_out_of_range("a decimal exponent of magnitude above " + std::to_string(maximal_exponent),
                       "an exponent of at most 3 digits");
  }
  return value;
}

Integer integer_of_digits(std::string_view digits) {
  if (digits.size() > std::numeric_limits<unsigned long>::digits10) {
    return Integer(std::string(digits), 10);
  }
  unsigned long value = 0;  // what it stays if there are no digits
  std::from_chars(digits.data(), digits.data() + digits.size(), value);
  return value;
}

Integer power_of_ten(unsigned long exponent) {
  Integer result;
  mpz_ui_pow_ui(result.get_mpz_t(), 10, exponent);
  return result;
}

std::optional<Rational> parse_fraction(std::string_view numerator, std::string_view denominator) {
  const auto not_digit = [](char c) { return !is_digit(c); };
  if (numerator.empty() || denominator.empty() ||
      std::any_of(denominator.begin(), denominator.end(), not_digit)) {
    return std::nullopt;
  }
  check_digits(numerator.size() + denominator.size());
  const Integer below = integer_of_digits(denominator);
  if (below == 0) return std::nullopt;
  Rational value(integer_of_digits(numerator), below);
  value.canonicalize();
  return value;
}

std::size_t bit_length(const Integer& value) { return mpz_sizeinbase(value.get_mpz_t(), 2); }

// mantissa * 2^-shift, the mantissa of 63 or 64 bits. Where bits were cut off, the last bit is one:
// it lies below every position at which a double is rounded (round to odd).
struct Leading {
  std::uint64_t mantissa;
  long shift;
};

// The first 64 bits of the magnitude, the first of them set. REQUIRES value != 0
std::uint64_t first_64_bits(const Integer& value) {
  const mp_limb_t* limbs = mpz_limbs_read(value.get_mpz_t());
  const std::size_t size = mpz_size(value.get_mpz_t());
  const int zeros = std::countl_zero(static_cast<std::uint64_t>(limbs[size - 1]));
  std::uint64_t bits = limbs[size - 1] << zeros;
  if (zeros != 0 && size > 1) bits |= limbs[size - 2] >> (64 - zeros);
  return bits;
}

// |numerator| * 2^-shift. REQUIRES numerator != 0
Leading leading_bits(const Integer& numerator, long shift) {
  std::uint64_t mantissa = first_64_bits(numerator);
  const long cut = static_cast<long>(bit_length(numerator)) - 64;
  if (cut > 0 && static_cast<long>(mpz_scan1(numerator.get_mpz_t(), 0)) < cut) mantissa |= 1U;
  return {mantissa, shift - cut};
}

// The same from the first 64 bits of either, if that is certain. With both cut by less than one the
// quotient below is off by less than five; only the half of the last place decides how it is
// rounded.
std::optional<Leading> leading_bits_quickly(const Integer& numerator, const Integer& denominator,
                                            long shift) {
  __extension__ using Wide = unsigned __int128;
  constexpr long clear_of_subnormals = 1000;
  if (std::abs(shift) > clear_of_subnormals) return std::nullopt;
  const auto quotient = static_cast<std::uint64_t>(
      (static_cast<Wide>(first_64_bits(numerator)) << 63U) / first_64_bits(denominator));
  const int dropped = static_cast<int>(std::bit_width(quotient)) - 53;
  const std::uint64_t rest = quotient & ((std::uint64_t{1} << dropped) - 1U);
  const std::uint64_t half = std::uint64_t{1} << (dropped - 1);
  constexpr std::uint64_t margin = 8;
  if (rest + margin > half && rest < half + margin) return std::nullopt;
  return Leading{quotient | 1U, shift};
}

// |numerator| / denominator, whose bit lengths differ by e.
Leading leading_bits(const Integer& numerator, const Integer& denominator, long e) {
  const long shift = 63 - e;
  if (const auto quick = leading_bits_quickly(numerator, denominator, shift)) return *quick;
  Integer scaled = abs(numerator);
  Integer divisor = denominator;
  if (shift >= 0) {
    scaled <<= static_cast<unsigned long>(shift);
  } else {
    divisor <<= static_cast<unsigned long>(-shift);
  }
  Integer quotient;
  Integer remainder;
  mpz_tdiv_qr(quotient.get_mpz_t(), remainder.get_mpz_t(), scaled.get_mpz_t(), divisor.get_mpz_t());
  return {mpz_getlimbn(quotient.get_mpz_t(), 0) | (remainder != 0 ? 1U : 0U), shift};
}

// The double nearest to the number, ties to even.
double rounded(const Leading& leading) {
  // A double of this size keeps 53 bits, and none below 2^-1074.
  const int length = static_cast<int>(std::bit_width(leading.mantissa));
  const long dropped = std::max<long>(length - 53, leading.shift - 1074);
  std::uint64_t kept = 0;
  if (dropped < 64) {
    kept = leading.mantissa >> dropped;
    const std::uint64_t rest = leading.mantissa & ((std::uint64_t{1} << dropped) - 1U);
    const std::uint64_t half = std::uint64_t{1} << (dropped - 1);
    if (rest > half || (rest == half && (kept & 1U) != 0)) ++kept;
  } else if (dropped == 64) {
    // All of it lies below the last place; more than half of that place rounds up.
    kept = leading.mantissa > (std::uint64_t{1} << 63U) ? 1 : 0;
  }
  return std::ldexp(static_cast<double>(kept), static_cast<int>(dropped - leading.shift));
}

}  // namespace

std::optional<Rational> parse_rational(std::string_view text) {
  const int sign = take_sign(text);
  const std::string_view whole = take_digits(text);
  if (take(text, '/')) {
    std::optional<Rational> value = parse_fraction(whole, text);
    if (value && sign < 0) *value = -*value;
    return value;
  }
  std::string_view fraction;
  if (take(text, '.')) fraction = take_digits(text);
  if (whole.empty() && fraction.empty()) return std::nullopt;
  int exponent_sign = 1;
  std::string_view exponent_digits;
  if (take(text, 'e') || take(text, 'E')) {
    exponent_sign = take_sign(text);
    exponent_digits = take_digits(text);
    if (exponent_digits.empty()) return std::nullopt;
  }
  if (!text.empty()) return std::nullopt;

  check_digits(whole.size() + fraction.size());
  const long exponent =
      exponent_sign * exponent_of(exponent_digits) - static_cast<long>(fraction.size());
  Integer digits = integer_of_digits(std::string(whole).append(fraction));
  if (sign < 0) digits = -digits;
  if (exponent == 0) return Rational(digits);
  if (exponent > 0) {
    return Rational(Integer(digits * power_of_ten(static_cast<unsigned long>(exponent))));
  }
  Rational value(digits, power_of_ten(static_cast<unsigned long>(-exponent)));
  value.canonicalize();
  return value;
}

Rational rational_of(double value) { return Rational(value); }

double nearest_double(const Rational& value) {
  const Integer& numerator = value.get_num();
  const Integer& denominator = value.get_den();
  if (numerator == 0) return 0;
  const auto numerator_bits = static_cast<long>(bit_length(numerator));
  const auto denominator_bits = static_cast<long>(bit_length(denominator));
  // Both operands are exact doubles, and one IEEE division rounds correctly.
  if (numerator_bits <= 53 && denominator_bits <= 53) {
    return numerator.get_d() / denominator.get_d();
  }
  // |value| is in (2^(e-1), 2^(e+1)), e the difference of the lengths.
  const long e = numerator_bits - denominator_bits;
  if (e > 1025) return sgn(numerator) * std::numeric_limits<double>::infinity();
  if (e < -1080) return std::copysign(0.0, sgn(numerator));
  const bool power_of_two = mpz_scan1(denominator.get_mpz_t(), 0) + 1 == bit_length(denominator);
  const Leading leading = power_of_two ? leading_bits(numerator, denominator_bits - 1)
                                       : leading_bits(numerator, denominator, e);
  const double magnitude = rounded(leading);
  return sgn(numerator) < 0 ? -magnitude : magnitude;
}

std::string to_text(const Rational& value) { return value.get_str(); }

}  // namespace exactcsg
