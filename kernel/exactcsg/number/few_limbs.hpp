// SPDX-License-Identifier: Apache-2.0
#pragma once

// Integers of few limbs that are computed in place: loops over limbs instead of calls, and no
// allocation. Private to number/. [Exact]
//
// LAW few_limbs.1  every operation is exact. REQUIRES that results have at most `capacity` limbs,
// which callers derive from the lengths of what they begin with.

#include <gmp.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstddef>

#include "exactcsg/number/limbs.hpp"

namespace exactcsg {

class FewLimbs {
 public:
  static constexpr std::size_t capacity = 48;

  LimbSpan magnitude() const { return {limbs_.data(), size_}; }
  bool is_zero() const { return size_ == 0; }
  bool is_negative() const { return negative_; }
  bool is_magnitude_one() const { return size_ == 1 && limbs_[0] == 1; }
  // REQUIRES a value that is not zero
  unsigned long count_zeros() const {
    return static_cast<unsigned long>(count_low_zeros(magnitude()));
  }

  void set(LimbSpan magnitude, bool negative) {
    assert(magnitude.size() <= capacity);
    size_ = magnitude.size();
    negative_ = negative;
    for (std::size_t i = 0; i < size_; ++i) limbs_[i] = magnitude[i];
  }
  void set(mp_limb_t value) {
    limbs_[0] = value;
    size_ = value == 0 ? 0 : 1;
    negative_ = false;
  }
  void set(const FewLimbs& value) { set(value.magnitude(), value.negative_); }
  void negate() { negative_ = size_ > 0 && !negative_; }

  // To sums of this and others.
  void add(const FewLimbs& value) { add(value.magnitude(), value.negative_); }
  void subtract(const FewLimbs& value) { add(value.magnitude(), !value.negative_); }

  // The product of two others.
  void set_product(const FewLimbs& a, const FewLimbs& b) {
    size_ = write_product(limbs_.data(), a.magnitude(), b.magnitude());
    negative_ = size_ > 0 && a.negative_ != b.negative_;
  }
  void add_product(const FewLimbs& a, const FewLimbs& b) {
    std::array<mp_limb_t, capacity> product;
    const std::size_t size = write_product(product.data(), a.magnitude(), b.magnitude());
    add({product.data(), size}, a.negative_ != b.negative_);
  }
  void subtract_product(const FewLimbs& a, const FewLimbs& b) {
    std::array<mp_limb_t, capacity> product;
    const std::size_t size = write_product(product.data(), a.magnitude(), b.magnitude());
    add({product.data(), size}, a.negative_ == b.negative_);
  }

  void multiply(mp_limb_t factor) {
    if (factor == 1) return;
    mp_limb_t carry = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      const Wide wide = Wide{limbs_[i]} * factor + carry;
      limbs_[i] = static_cast<mp_limb_t>(wide);
      carry = static_cast<mp_limb_t>(wide >> 64U);
    }
    append(carry);
    drop_leading_zeros();
  }

  void shift_left(unsigned long count) {
    if (count == 0 || size_ == 0) return;
    const std::size_t whole = count / GMP_NUMB_BITS;
    const auto rest = static_cast<unsigned>(count % GMP_NUMB_BITS);
    assert(size_ + whole < capacity);
    mp_limb_t upper = 0;
    for (std::size_t i = size_; i > 0; --i) {
      const mp_limb_t limb = limbs_[i - 1];
      limbs_[i + whole] = upper << rest | limb >> 1U >> (63 - rest);
      upper = limb;
    }
    limbs_[whole] = upper << rest;
    std::fill_n(limbs_.begin(), whole, mp_limb_t{0});
    size_ += whole + 1;
    drop_leading_zeros();
  }

  // Towards zero.
  void shift_right(unsigned long count) {
    if (count == 0) return;
    const std::size_t whole = count / GMP_NUMB_BITS;
    const auto rest = static_cast<unsigned>(count % GMP_NUMB_BITS);
    if (whole >= size_) {
      size_ = 0;
    } else {
      size_ -= whole;
      for (std::size_t i = 0; i < size_; ++i) {
        const mp_limb_t above = i + 1 < size_ ? limbs_[i + whole + 1] : 0;
        limbs_[i] = limbs_[i + whole] >> rest | above << 1U << (63 - rest);
      }
    }
    drop_leading_zeros();
  }

  // Whether an odd number of one limb divides this, which is then divided by it.
  bool divide_if_exact(mp_limb_t odd) {
    if (odd == 1) return true;
    std::array<mp_limb_t, capacity> quotient;
    const mp_limb_t inverse = inverse_of(odd);
    mp_limb_t borrow = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      const mp_limb_t digit = (limbs_[i] - borrow) * inverse;
      quotient[i] = digit;
      borrow = static_cast<mp_limb_t>(Wide{digit} * odd >> 64U) + (limbs_[i] < borrow ? 1 : 0);
    }
    if (borrow != 0) return false;
    std::copy_n(quotient.begin(), size_, limbs_.begin());
    drop_leading_zeros();
    return true;
  }

  // REQUIRES an odd number that divides this; its sign is not looked at
  void divide_exactly(const FewLimbs& odd) {
    if (odd.size_ == 1) {
      divide_if_exact(odd.limbs_[0]);
      return;
    }
    if (size_ == 0) return;
    // From the lowest limb on: each limb of the quotient is what makes the lowest one left zero.
    const mp_limb_t inverse = inverse_of(odd.limbs_[0]);
    const std::size_t size = size_ - odd.size_ + 1;
    for (std::size_t i = 0; i < size; ++i) {
      const mp_limb_t digit = limbs_[i] * inverse;
      mp_limb_t borrow = 0;
      for (std::size_t j = 0; j < odd.size_ && i + j < size; ++j) {
        const Wide product = Wide{digit} * odd.limbs_[j] + borrow;
        const auto low = static_cast<mp_limb_t>(product);
        borrow = static_cast<mp_limb_t>(product >> 64U) + (limbs_[i + j] < low ? 1 : 0);
        limbs_[i + j] -= low;
      }
      for (std::size_t j = i + odd.size_; j < size && borrow != 0; ++j) {
        const mp_limb_t limb = limbs_[j];
        limbs_[j] = limb - borrow;
        borrow = limb < borrow ? 1 : 0;
      }
      limbs_[i] = digit;
    }
    size_ = size;
    drop_leading_zeros();
  }

  // The greatest common divisor of an odd number and a number that is not zero, > 0.
  void set_odd_gcd(const FewLimbs& odd, const FewLimbs& other) {
    negative_ = false;
    if (odd.is_magnitude_one() || other.is_magnitude_one()) {
      set(1);
      return;
    }
    if (odd.size_ == 1 || other.size_ == 1) {
      const FewLimbs& shorter = odd.size_ == 1 ? odd : other;
      const FewLimbs& longer = odd.size_ == 1 ? other : odd;
      limbs_[0] =
          mpn_gcd_1(longer.limbs_.data(), static_cast<mp_size_t>(longer.size_), shorter.limbs_[0]);
      size_ = 1;
      return;
    }
    // Without the power of two, which is not common; both are overwritten.
    FewLimbs u;
    FewLimbs v;
    u.set(other);
    u.shift_right(u.count_zeros());
    v.set(odd);
    const bool u_is_longer =
        u.size_ != v.size_ ? u.size_ > v.size_ : u.limbs_[u.size_ - 1] >= v.limbs_[v.size_ - 1];
    FewLimbs& longer = u_is_longer ? u : v;
    FewLimbs& shorter = u_is_longer ? v : u;
    size_ = static_cast<std::size_t>(
        mpn_gcd(limbs_.data(), longer.limbs_.data(), static_cast<mp_size_t>(longer.size_),
                shorter.limbs_.data(), static_cast<mp_size_t>(shorter.size_)));
  }

 private:
  __extension__ using Wide = unsigned __int128;

  // Modulo 2^64, by Newton's iteration from 5 bits.
  static mp_limb_t inverse_of(mp_limb_t odd) {
    mp_limb_t inverse = (3 * odd) ^ 2U;
    for (int bits = 5; bits < 64; bits *= 2) inverse *= 2 - odd * inverse;
    return inverse;
  }

  static std::size_t write_product(mp_limb_t* to, LimbSpan a, LimbSpan b) {
    if (a.empty() || b.empty()) return 0;
    assert(a.size() + b.size() <= capacity);
    mp_limb_t carry = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      const Wide wide = Wide{a[i]} * b[0] + carry;
      to[i] = static_cast<mp_limb_t>(wide);
      carry = static_cast<mp_limb_t>(wide >> 64U);
    }
    to[a.size()] = carry;
    for (std::size_t j = 1; j < b.size(); ++j) {
      carry = 0;
      for (std::size_t i = 0; i < a.size(); ++i) {
        const Wide wide = Wide{a[i]} * b[j] + to[i + j] + carry;
        to[i + j] = static_cast<mp_limb_t>(wide);
        carry = static_cast<mp_limb_t>(wide >> 64U);
      }
      to[a.size() + j] = carry;
    }
    const std::size_t size = a.size() + b.size();
    return to[size - 1] == 0 ? size - 1 : size;
  }

  void append(mp_limb_t limb) {
    if (limb == 0) return;
    assert(size_ < capacity);
    limbs_[size_++] = limb;
  }

  void drop_leading_zeros() {
    while (size_ > 0 && limbs_[size_ - 1] == 0) --size_;
    if (size_ == 0) negative_ = false;
  }

  void add(LimbSpan value, bool negative) {
    if (value.empty()) return;
    if (size_ == 0) {
      set(value, negative);
      return;
    }
    // The shorter one is read as if it were as long.
    assert(value.size() <= capacity);
    for (; size_ < value.size(); ++size_) limbs_[size_] = 0;
    const auto limb = [&](std::size_t i) { return i < value.size() ? value[i] : 0; };
    if (negative == negative_) {
      mp_limb_t carry = 0;
      for (std::size_t i = 0; i < size_; ++i) {
        const Wide wide = Wide{limbs_[i]} + limb(i) + carry;
        limbs_[i] = static_cast<mp_limb_t>(wide);
        carry = static_cast<mp_limb_t>(wide >> 64U);
      }
      append(carry);
      return;
    }
    mp_limb_t borrow = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      const Wide wide = Wide{limbs_[i]} - limb(i) - borrow;
      limbs_[i] = static_cast<mp_limb_t>(wide);
      borrow = static_cast<mp_limb_t>(wide >> 127U);
    }
    if (borrow != 0) {
      // It was the other way round.
      negative_ = negative;
      mp_limb_t carry = 1;
      for (std::size_t i = 0; i < size_; ++i) {
        limbs_[i] = ~limbs_[i] + carry;
        carry = carry != 0 && limbs_[i] == 0 ? 1 : 0;
      }
    }
    drop_leading_zeros();
  }

  std::size_t size_ = 0;
  bool negative_ = false;
  std::array<mp_limb_t, capacity> limbs_;  // only the first size_ are meaningful
};

}  // namespace exactcsg
