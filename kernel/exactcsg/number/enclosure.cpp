// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/number/enclosure.hpp"

#include "exactcsg/support/error.hpp"

namespace exactcsg {

namespace {

// digits * 10^(exponent - (number of digits - 1)), no zeros at the end
struct Decimal {
  std::string digits;
  long exponent = 0;
};

Rational power_of_ten(long exponent) {
  Integer power;
  mpz_ui_pow_ui(power.get_mpz_t(), 10, static_cast<unsigned long>(std::abs(exponent)));
  return exponent >= 0 ? Rational(power) : Rational(Integer(1), power);
}

// The largest e with 10^e <= value. REQUIRES value > 0
long decimal_exponent(const Rational& value) {
  // mpz_sizeinbase(n, 10) is the number of decimal digits or one more, so that the estimate is off
  // by at most two.
  long e = static_cast<long>(mpz_sizeinbase(value.get_num_mpz_t(), 10)) -
           static_cast<long>(mpz_sizeinbase(value.get_den_mpz_t(), 10));
  while (power_of_ten(e) > value) --e;
  while (power_of_ten(e + 1) <= value) ++e;
  return e;
}

// To the nearest integer, ties to even. REQUIRES value >= 0
Integer round_to_even(const Rational& value) {
  Integer quotient;
  Integer remainder;
  mpz_fdiv_qr(quotient.get_mpz_t(), remainder.get_mpz_t(), value.get_num_mpz_t(),
              value.get_den_mpz_t());
  const int half = cmp(Integer(2 * remainder), value.get_den());
  if (half > 0 || (half == 0 && mpz_odd_p(quotient.get_mpz_t()) != 0)) ++quotient;
  return quotient;
}

// REQUIRES value > 0
Decimal rounded(const Rational& value, int digits) {
  Decimal result;
  result.exponent = decimal_exponent(value);
  result.digits = round_to_even(value * power_of_ten(digits - 1 - result.exponent)).get_str();
  // 9.99 became 10.0
  if (result.digits.size() > static_cast<std::size_t>(digits)) ++result.exponent;
  result.digits.erase(result.digits.find_last_not_of('0') + 1);
  return result;
}

std::string with_point_after(const std::string& digits, std::size_t count) {
  return digits.size() <= count ? digits : digits.substr(0, count) + '.' + digits.substr(count);
}

std::string written(const Decimal& decimal, int precision) {
  const long e = decimal.exponent;
  if (e < -4 || e >= precision) {
    const std::string magnitude = std::to_string(std::abs(e));
    return with_point_after(decimal.digits, 1) + (e < 0 ? "e-" : "e+") +
           (magnitude.size() < 2 ? "0" : "") + magnitude;
  }
  if (e < 0) return "0." + std::string(static_cast<std::size_t>(-e - 1), '0') + decimal.digits;
  std::string padded = decimal.digits;
  const auto whole = static_cast<std::size_t>(e + 1);
  if (padded.size() < whole) padded.resize(whole, '0');
  return with_point_after(padded, whole);
}

}  // namespace

std::string to_decimal(const Rational& value, int digits) {
  if (value == 0) return "0";
  const std::string magnitude = written(rounded(abs(value), digits), digits);
  return value < 0 ? '-' + magnitude : magnitude;
}

std::string to_decimal(const std::function<Enclosure(int bits)>& enclose, int digits) {
  constexpr int maximal_bits = 20000;
  // A decimal digit is log2(10) < 10/3 bits, and 32 bits more make a second try improbable.
  for (int bits = 32 + (digits * 10 + 2) / 3; bits <= maximal_bits; bits *= 2) {
    const Enclosure enclosure = enclose(bits);
    std::string lower = to_decimal(enclosure.lower, digits);
    if (enclosure.lower == enclosure.upper || lower == to_decimal(enclosure.upper, digits)) {
      return lower;
    }
  }
  throw Error(ErrorId::InternalError, {"an enclosure that does not decide the decimal's last digit",
                                       "bounds that agree within 20000 bits"});
}

}  // namespace exactcsg
