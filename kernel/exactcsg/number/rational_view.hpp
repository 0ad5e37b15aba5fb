// SPDX-License-Identifier: Apache-2.0
#pragma once

// Rationals and points as they lie in memory, without objects of GMP: for passes over many of them.
// [Exact]

#include <gmp.h>

#include <array>
#include <bit>
#include <compare>
#include <cstddef>
#include <span>

#include "exactcsg/number/exact.hpp"
#include "exactcsg/number/point.hpp"

namespace exactcsg {

// A rational in lowest terms. Refers to limbs of somebody else.
// LAW view.1  denominators have one form each: a power of two below 2^(2^31) is an exponent.
struct RationalView {
  std::span<const mp_limb_t> numerator;  // its magnitude: lowest limb first, the last one not zero
  std::span<const mp_limb_t> denominator;  // likewise; empty: it is 2^exponent
  mp_bitcnt_t exponent = 0;                // of a denominator that is a power of two
  bool negative = false;

  bool is_zero() const { return numerator.empty(); }
  bool has_binary_denominator() const { return denominator.empty(); }
};

using PointView = std::array<RationalView, 3>;  // x, y, z

// Of a value that outlives the view.
RationalView view_of(const Rational& value);
// REQUIRES numerator / denominator in lowest terms, denominator > 0
RationalView view_of(const Integer& numerator, const Integer& denominator);
PointView view_of(const Point3& point);

// Sets `result` to the value. COST: no allocation if it has room
void assign(Rational& result, const RationalView& value);
Rational rational_of(const RationalView& value);
Point3 point_of(const PointView& point);
void set_denominator(Integer& result, const RationalView& value);

// The number of bits of the denominator.
inline std::size_t denominator_bits(const RationalView& value) {
  if (value.has_binary_denominator()) return value.exponent + 1;
  return GMP_NUMB_BITS * (value.denominator.size() - 1) +
         static_cast<std::size_t>(std::bit_width(value.denominator.back()));
}

// LAW view.2  equals rational_of(a) == rational_of(b), and the order of the rationals.
// COST: a few operations on limbs, unless the values agree to 2^-60 of their size, but not quite
bool equal(const RationalView& a, const RationalView& b);
bool equal_denominators(const RationalView& a, const RationalView& b);
std::strong_ordering compare(const RationalView& a, const RationalView& b);
// Lexicographic by x, y, z.
std::strong_ordering compare(const PointView& p, const PointView& q);

}  // namespace exactcsg
