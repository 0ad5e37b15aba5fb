// SPDX-License-Identifier: Apache-2.0
#pragma once

// Magnitudes of integers as limbs: the lowest first, the last one not zero. Private to the kernel.
// [Exact]

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "exactcsg/number/exact.hpp"

namespace exactcsg {

using LimbSpan = std::span<const mp_limb_t>;

inline LimbSpan limbs_of(const Integer& value) {
  return {mpz_limbs_read(value.get_mpz_t()), mpz_size(value.get_mpz_t())};
}

inline bool is_power_of_two(LimbSpan limbs) {
  const std::size_t top = limbs.size() - 1;
  if ((limbs[top] & (limbs[top] - 1U)) != 0) return false;
  return std::all_of(limbs.begin(), limbs.begin() + static_cast<std::ptrdiff_t>(top),
                     [](mp_limb_t limb) { return limb == 0; });
}

// The number of zeros below the lowest one. REQUIRES a value that is not zero
inline long count_low_zeros(LimbSpan limbs) {
  std::size_t i = 0;
  while (limbs[i] == 0) ++i;
  return static_cast<long>(i) * GMP_NUMB_BITS + std::countr_zero(limbs[i]);
}

// The first 64 bits of a magnitude, the first of them set, and the length of the whole in bits.
struct Head {
  std::uint64_t bits;
  long length;
};

// REQUIRES a value that is not zero
inline Head head_of(LimbSpan limbs) {
  const std::size_t size = limbs.size();
  const std::uint64_t top = limbs[size - 1];
  const int zeros = std::countl_zero(top);
  std::uint64_t bits = top << zeros;
  if (zeros != 0 && size > 1) bits |= limbs[size - 2] >> (64 - zeros);
  return {bits, static_cast<long>(size) * GMP_NUMB_BITS - zeros};
}

}  // namespace exactcsg
