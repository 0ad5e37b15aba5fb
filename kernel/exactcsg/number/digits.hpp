// SPDX-License-Identifier: Apache-2.0
#pragma once

// Integers of a fixed number of digits of 60 bits, for long sums of products: the products of
// digits are added up column by column in 128 bits, and carries are made once a sum. No branches,
// no allocation. Private to the kernel. [Exact]
//
// LAW digits.1  every operation is exact. REQUIRES that no column and no digit overflows: a product
// of digits is below 2^120 (below 2^122 of digits that are sums of two or three), so that many of
// them fit a column; callers say how many they add up between carries.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "exactcsg/number/exact.hpp"
#include "exactcsg/number/exact_tiers.hpp"

namespace exactcsg {

__extension__ using UnsignedInt128 = unsigned __int128;

inline constexpr int digit_bits = 60;
inline constexpr std::int64_t digit_mask = (std::int64_t{1} << digit_bits) - 1;

// sum of digit[i] * 2^(60 i)
template <std::size_t n>
struct Digits {
  std::array<std::int64_t, n> digit{};
};

// sum of column[i] * 2^(60 i)
template <std::size_t n>
struct DigitColumns {
  std::array<Int128, n> column{};
};

template <std::size_t n>
Digits<n> operator+(const Digits<n>& a, const Digits<n>& b) {
  Digits<n> sum;
  for (std::size_t i = 0; i < n; ++i) sum.digit[i] = a.digit[i] + b.digit[i];
  return sum;
}

template <std::size_t n>
Digits<n> operator-(const Digits<n>& a, const Digits<n>& b) {
  Digits<n> difference;
  for (std::size_t i = 0; i < n; ++i) difference.digit[i] = a.digit[i] - b.digit[i];
  return difference;
}

template <std::size_t n, std::size_t m>
void add(DigitColumns<n>& sum, const Digits<m>& value) {
  static_assert(m <= n);
  for (std::size_t i = 0; i < m; ++i) sum.column[i] += value.digit[i];
}

template <std::size_t n, std::size_t m>
void add(DigitColumns<n>& sum, const DigitColumns<m>& value) {
  static_assert(m <= n);
  for (std::size_t i = 0; i < m; ++i) sum.column[i] += value.column[i];
}

// Column k of x y.
template <std::size_t a, std::size_t b>
Int128 product_column(const Digits<a>& x, const Digits<b>& y, std::size_t k) {
  Int128 sum = 0;
  for (std::size_t i = 0; i < a; ++i) {
    if (i <= k && k - i < b) sum += static_cast<Int128>(x.digit[i]) * y.digit[k - i];
  }
  return sum;
}

template <std::size_t n, std::size_t a, std::size_t b>
void add_product(DigitColumns<n>& sum, const Digits<a>& x, const Digits<b>& y) {
  static_assert(a + b - 1 <= n);
  for (std::size_t k = 0; k < a + b - 1; ++k) sum.column[k] += product_column(x, y, k);
}

// x u - y v
template <std::size_t a>
DigitColumns<2 * a - 1> difference_of_products(const Digits<a>& x, const Digits<a>& u,
                                               const Digits<a>& y, const Digits<a>& v) {
  DigitColumns<2 * a - 1> result;
  for (std::size_t k = 0; k < 2 * a - 1; ++k) {
    result.column[k] = product_column(x, u, k) - product_column(y, v, k);
  }
  return result;
}

template <std::size_t a, std::size_t b>
DigitColumns<a + b - 1> dot(const std::array<Digits<a>, 3>& x, const std::array<Digits<b>, 3>& y) {
  DigitColumns<a + b - 1> result;
  for (std::size_t k = 0; k < a + b - 1; ++k) {
    result.column[k] = product_column(x[0], y[0], k) + product_column(x[1], y[1], k) +
                       product_column(x[2], y[2], k);
  }
  return result;
}

// All columns but the last to 0 <= column < 2^60.
template <std::size_t n>
void carry(DigitColumns<n>& sum) {
  for (std::size_t i = 0; i + 1 < n; ++i) {
    sum.column[i + 1] += sum.column[i] >> digit_bits;
    sum.column[i] &= digit_mask;
  }
}

// All digits but the last are in [0, 2^60), and the sign is that of the last.
template <std::size_t n, std::size_t m>
Digits<n> digits_of(const DigitColumns<m>& sum) {
  static_assert(m <= n);
  Digits<n> result;
  Int128 carried = 0;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    if (i < m) carried += sum.column[i];
    result.digit[i] = static_cast<std::int64_t>(carried) & digit_mask;
    carried >>= digit_bits;
  }
  if (n == m) carried += sum.column[m - 1];
  result.digit[n - 1] = static_cast<std::int64_t>(carried);
  return result;
}

// Of digits as digits_of makes them.
template <std::size_t n>
Digits<n> magnitude(const Digits<n>& value) {
  if (value.digit[n - 1] >= 0) return value;
  DigitColumns<n> negative;
  for (std::size_t i = 0; i < n; ++i) negative.column[i] = -static_cast<Int128>(value.digit[i]);
  return digits_of<n>(negative);
}

// Of n limbs of 64 bits, the lowest first. REQUIRES a value below 2^(60 n)
template <std::size_t n>
Digits<n> digits_of_limbs(const mp_limb_t* limbs) {
  static_assert(GMP_NUMB_BITS == 64);
  Digits<n> result;
  mp_limb_t carried = 0;  // the upper 4 i bits of limb i - 1
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t bits = (64 - digit_bits) * i;
    result.digit[i] = static_cast<std::int64_t>(limbs[i] << bits | carried) & digit_mask;
    carried = limbs[i] >> (digit_bits - bits);
  }
  return result;
}

inline Integer integer_of(Int128 value) {
  const bool negative = value < 0;
  const UnsignedInt128 size =
      negative ? -static_cast<UnsignedInt128>(value) : static_cast<UnsignedInt128>(value);
  Integer result = static_cast<unsigned long>(size >> 64U);
  result <<= 64;
  result += static_cast<unsigned long>(size);
  return negative ? Integer(-result) : result;
}

template <std::size_t n>
Integer integer_of(const DigitColumns<n>& sum) {
  Integer result;
  for (std::size_t i = n; i > 0; --i) {
    result <<= digit_bits;
    result += integer_of(sum.column[i - 1]);
  }
  return result;
}

}  // namespace exactcsg
