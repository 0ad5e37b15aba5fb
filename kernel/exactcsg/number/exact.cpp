// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/number/exact.hpp"

#include <algorithm>
#include <charconv>
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

std::string to_text(const Rational& value) { return value.get_str(); }

}  // namespace exactcsg
