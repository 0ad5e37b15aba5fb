// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/number/common_denominator.hpp"

#include <algorithm>
#include <bit>

namespace exactcsg {

// Mostly one of the two divides the other, which is seen faster than a greatest common divisor.
void make_multiple(Integer& common, const Integer& denominator) {
  if (mpz_divisible_p(common.get_mpz_t(), denominator.get_mpz_t()) != 0) return;
  if (mpz_divisible_p(denominator.get_mpz_t(), common.get_mpz_t()) != 0) {
    common = denominator;
  } else {
    mpz_lcm(common.get_mpz_t(), common.get_mpz_t(), denominator.get_mpz_t());
  }
}

void set_scaled(Integer& result, const Rational& value, const Integer& denominator) {
  if (value.get_den() == denominator) {
    result = value.get_num();
    return;
  }
  // The product is put where it belongs: it would have to be moved to make room in place.
  thread_local Integer factor;
  mpz_divexact(factor.get_mpz_t(), denominator.get_mpz_t(), value.get_den_mpz_t());
  mpz_mul(result.get_mpz_t(), value.get_num_mpz_t(), factor.get_mpz_t());
}

std::optional<Integer> short_common_denominator(std::span<const Point3> points) {
  Integer common = 1;
  mp_limb_t powers_of_two = 1;  // the short ones among the denominators, all bits in one
  for (const Point3& p : points) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Integer& denominator = coordinate(p, i).get_den();
      const mp_limb_t first = mpz_getlimbn(denominator.get_mpz_t(), 0);
      if (mpz_size(denominator.get_mpz_t()) == 1 && (first & (first - 1U)) == 0) {
        powers_of_two |= first;
      } else {
        make_multiple(common, denominator);
      }
    }
    if (mpz_sizeinbase(common.get_mpz_t(), 2) > common_denominator_bits) return std::nullopt;
  }
  make_multiple(common, Integer(std::bit_floor(powers_of_two)));
  if (mpz_sizeinbase(common.get_mpz_t(), 2) > common_denominator_bits) return std::nullopt;
  return common;
}

std::optional<Integer> short_common_denominator(const ExactPoints& points) {
  Integer common = 1;
  Integer denominator;
  mp_bitcnt_t exponent = 0;  // of the largest power of two
  for (std::size_t v = 0; v < points.size(); ++v) {
    for (const RationalView& value : points.view(v)) {
      if (value.has_binary_denominator()) {
        exponent = std::max(exponent, value.exponent);
        continue;
      }
      set_denominator(denominator, value);
      make_multiple(common, denominator);
    }
    if (std::max<std::size_t>(mpz_sizeinbase(common.get_mpz_t(), 2), exponent + 1) >
        common_denominator_bits) {
      return std::nullopt;
    }
  }
  mpz_mul_2exp(denominator.get_mpz_t(), Integer(1).get_mpz_t(), exponent);
  make_multiple(common, denominator);
  if (mpz_sizeinbase(common.get_mpz_t(), 2) > common_denominator_bits) return std::nullopt;
  return common;
}

}  // namespace exactcsg
