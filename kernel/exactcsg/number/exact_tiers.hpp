// SPDX-License-Identifier: Apache-2.0
#pragma once

// The third and fourth tier: one formula, evaluated in the narrowest integers that a bound on its
// bits allows: 128 bits, stack limbs, or unbounded. Private to the kernel. [Exact]

#include "exactcsg/number/exact.hpp"
#include "exactcsg/number/stack_integer.hpp"
#include "exactcsg/number/tier_statistics.hpp"

namespace exactcsg {

__extension__ using Int128 = __int128;
using WideInteger = StackInteger<64>;

// The largest bounds |value| < 2^bits for which the types hold every intermediate result. A product
// of limb counts may have two limbs more than its bits need, hence the margin.
inline constexpr int narrow_bits = 126;
inline constexpr int wide_bits = (WideInteger::limb_capacity - 2) * GMP_NUMB_BITS;

inline Sign sign_of(const Int128& value) {
  return value > 0 ? Sign::Positive : value < 0 ? Sign::Negative : Sign::Zero;
}
template <int capacity>
Sign sign_of(const StackInteger<capacity>& value) {
  return value.sign();
}

// Conversions by which formulas load their operands.
template <class T>
T integer_from(const Integer& value) {
  return T(value);
}
template <>
inline Int128 integer_from<Int128>(const Integer& value) {
  const mp_size_t size = static_cast<mp_size_t>(mpz_size(value.get_mpz_t()));
  const mp_limb_t* limbs = mpz_limbs_read(value.get_mpz_t());
  __extension__ using Wide = unsigned __int128;
  Wide magnitude = size == 0 ? Wide{0} : Wide{limbs[0]};
  if (size > 1) magnitude |= Wide{limbs[1]} << 64U;
  return sgn(value) < 0 ? -static_cast<Int128>(magnitude) : static_cast<Int128>(magnitude);
}

// mantissa * 2^shift
template <class T>
T integer_from(std::int64_t mantissa, int shift) {
  if constexpr (std::is_same_v<T, Integer>) {
    return Integer(mantissa) << static_cast<unsigned long>(shift);
  } else if constexpr (std::is_same_v<T, Int128>) {
    return static_cast<Int128>(mantissa) * (static_cast<Int128>(1) << shift);
  } else {
    return shifted(T(mantissa), shift);
  }
}

struct Decision {
  Sign sign;
  Tier tier;
};

// `formula.template operator()<T>()` gives the sign. REQUIRES every intermediate value of the
// formula to be below 2^bits in magnitude.
template <class Formula>
Decision decide(int bits, const Formula& formula) {
  if (bits <= narrow_bits) return {formula.template operator()<Int128>(), Tier::Fixed};
  if (bits <= wide_bits) return {formula.template operator()<WideInteger>(), Tier::Fixed};
  return {formula.template operator()<Integer>(), Tier::Unbounded};
}

}  // namespace exactcsg
