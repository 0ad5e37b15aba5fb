// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/number/rounding.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <optional>

#include "exactcsg/number/limbs.hpp"

namespace exactcsg {

namespace {

__extension__ using Wide = unsigned __int128;

// As head_of of the limbs, without a call of the library. REQUIRES a value that is not zero
Head integer_head(const Integer& value) {
  const auto size = static_cast<mp_size_t>(mpz_size(value.get_mpz_t()));
  const std::uint64_t top = mpz_getlimbn(value.get_mpz_t(), size - 1);
  const std::uint64_t next = mpz_getlimbn(value.get_mpz_t(), size - 2);  // 0 if there is none
  const int zeros = std::countl_zero(top);
  return {top << zeros | next >> 1U >> (63 - zeros),
          static_cast<long>(size) * GMP_NUMB_BITS - zeros};
}

// mantissa * 2^-shift, the mantissa of 63 or 64 bits. Where bits were cut off, the last bit is one:
// it lies below every position at which a double is rounded (round to odd).
struct Leading {
  std::uint64_t mantissa;
  long shift;
};

// numerator * 2^-shift. REQUIRES numerator != 0
Leading leading_bits(LimbSpan numerator, const Head& head, long shift) {
  const long cut = head.length - 64;
  const bool cut_off = cut > 0 && count_low_zeros(numerator) < cut;
  return {head.bits | (cut_off ? 1U : 0U), shift - cut};
}

// numerator / denominator, whose bit lengths differ by e.
Leading leading_bits(LimbSpan numerator, LimbSpan denominator, long e) {
  const long shift = 63 - e;
  mpz_t limbs;
  Integer scaled(mpz_roinit_n(limbs, numerator.data(), static_cast<mp_size_t>(numerator.size())));
  Integer divisor(
      mpz_roinit_n(limbs, denominator.data(), static_cast<mp_size_t>(denominator.size())));
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

// REQUIRES -1022 <= exponent <= 1023
double power_of_two(long exponent) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(1023 + exponent) << 52U);
}

// Results this far from the limits of doubles are rounded by the processor: a mantissa of 64 bits
// to the nearest double, ties to even, times a power of two.
constexpr long clear_of_limits = 900;

// numerator / denominator from their heads, if that is certain. With both cut by less than one the
// quotient of heads is off by less than five; only the half of the last place decides how it is
// rounded.
std::optional<double> quotient_of_heads(const Head& numerator, const Head& denominator) {
  const long e = numerator.length - denominator.length;
  if (std::abs(e) > clear_of_limits) return std::nullopt;
  const auto quotient =
      static_cast<std::uint64_t>((Wide{numerator.bits} << 63U) / denominator.bits);
  const int dropped = 11 - std::countl_zero(quotient);
  const std::uint64_t rest = quotient & ((std::uint64_t{1} << dropped) - 1U);
  const std::uint64_t half = std::uint64_t{1} << (dropped - 1);
  constexpr std::uint64_t margin = 8;
  if (rest + margin > half && rest < half + margin) return std::nullopt;
  return static_cast<double>(quotient | 1U) * power_of_two(e - 63);
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

// numerator * 2^-shift of at most 128 bits. REQUIRES numerator != 0
NearestDouble round_short(LimbSpan numerator, const Head& head, long shift) {
  const long cut = head.length - 64;
  const bool cut_off = cut > 0 && (numerator[0] << (64 - cut)) != 0;
  const double magnitude =
      static_cast<double>(head.bits | (cut_off ? 1U : 0U)) * power_of_two(cut - shift);
  const bool is_exact = !cut_off && std::countr_zero(head.bits) >= 11;
  return {magnitude, is_exact};
}

NearestDouble round_magnitude(const RationalView& number) {
  const LimbSpan numerator = number.numerator;
  const Head above = head_of(numerator);
  const bool is_dyadic = number.has_binary_denominator();
  const auto shift = static_cast<long>(number.exponent);
  if (is_dyadic) {
    if (shift < clear_of_limits && above.length <= 128) {
      return round_short(numerator, above, shift);
    }
  } else if (const auto quotient = quotient_of_heads(above, head_of(number.denominator))) {
    return {*quotient, false};
  }
  // The number is in (2^(e-1), 2^(e+1)), e the difference of the lengths.
  const long e = above.length - (is_dyadic ? shift + 1 : head_of(number.denominator).length);
  if (e > 1025) return {std::numeric_limits<double>::infinity(), false};
  if (e < -1080) return {0, false};
  if (!is_dyadic) return {rounded(leading_bits(numerator, number.denominator, e)), false};
  // The numerator of a double has few significant bits.
  const bool is_exact =
      std::abs(e) <= clear_of_limits + 1 && above.length - count_low_zeros(numerator) <= 53;
  return {rounded(leading_bits(numerator, above, shift)), is_exact};
}

}  // namespace

NearestDouble round_to_nearest(const RationalView& number) {
  if (number.is_zero()) return {0, true};
  const NearestDouble magnitude = round_magnitude(number);
  return {number.negative ? -magnitude.value : magnitude.value, magnitude.is_exact};
}

NearestDouble round_to_nearest(const Rational& number) {
  const Integer& numerator = number.get_num();
  const Integer& denominator = number.get_den();
  if (mpz_size(numerator.get_mpz_t()) == 1 && mpz_size(denominator.get_mpz_t()) == 1) {
    const mp_limb_t above = mpz_getlimbn(numerator.get_mpz_t(), 0);
    const mp_limb_t below = mpz_getlimbn(denominator.get_mpz_t(), 0);
    // Both are doubles, of which the processor rounds the quotient. In lowest terms only a power of
    // two leaves no remainder.
    if ((above | below) >> std::numeric_limits<double>::digits == 0) {
      const double magnitude = static_cast<double>(above) / static_cast<double>(below);
      return {sgn(numerator) < 0 ? -magnitude : magnitude, (below & (below - 1U)) == 0};
    }
  }
  // A power of two has but one bit: most other denominators are told from one by their heads.
  if (const Head below = integer_head(denominator); below.bits << 1U != 0 && sgn(numerator) != 0) {
    if (const auto quotient = quotient_of_heads(integer_head(numerator), below)) {
      return {sgn(numerator) < 0 ? -*quotient : *quotient, false};
    }
  }
  return round_to_nearest(view_of(number));
}

double nearest_double(const Rational& value) { return round_to_nearest(value).value; }

}  // namespace exactcsg
