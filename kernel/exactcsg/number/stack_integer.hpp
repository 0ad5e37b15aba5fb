// SPDX-License-Identifier: Apache-2.0
#pragma once

// Integers of a bounded number of limbs that live on the stack: the third tier of the predicates.
// Arithmetic is that of GMP's mpn layer; only the limbs in use are touched, so that a generous
// capacity costs nothing but address space.
//
// LAW stack_integer.1  every operation is exact. REQUIRES that the result, and of a product the sum
// of the operands' limbs, fits the capacity; the caller derives that from bit lengths beforehand
// (exact_tiers.hpp). [Exact]

#include <gmpxx.h>

#include <algorithm>
#include <cassert>
#include <cstdint>

#include "exactcsg/number/exact.hpp"

namespace exactcsg {

template <int capacity>
class StackInteger {
 public:
  static constexpr int limb_capacity = capacity;

  StackInteger() = default;
  explicit StackInteger(std::int64_t value) : size_(value == 0 ? 0 : 1), negative_(value < 0) {
    const auto bits = static_cast<mp_limb_t>(value);
    limbs_[0] = negative_ ? mp_limb_t{0} - bits : bits;
  }
  explicit StackInteger(const Integer& value)
      : size_(static_cast<int>(mpz_size(value.get_mpz_t()))), negative_(sgn(value) < 0) {
    assert(size_ <= capacity);
    std::copy_n(mpz_limbs_read(value.get_mpz_t()), size_, limbs_);
  }
  StackInteger(const StackInteger& other) : size_(other.size_), negative_(other.negative_) {
    std::copy_n(other.limbs_, size_, limbs_);
  }
  StackInteger& operator=(const StackInteger& other) {
    if (this == &other) return *this;
    size_ = other.size_;
    negative_ = other.negative_;
    std::copy_n(other.limbs_, size_, limbs_);
    return *this;
  }

  Sign sign() const {
    return size_ == 0 ? Sign::Zero : negative_ ? Sign::Negative : Sign::Positive;
  }

  friend StackInteger operator-(StackInteger value) {
    value.negative_ = !value.negative_;
    return value;
  }
  friend StackInteger operator+(const StackInteger& a, const StackInteger& b) {
    return sum(a, b, b.negative_);
  }
  friend StackInteger operator-(const StackInteger& a, const StackInteger& b) {
    return sum(a, b, !b.negative_);
  }
  friend StackInteger operator*(const StackInteger& a, const StackInteger& b) {
    StackInteger product;
    if (a.size_ == 0 || b.size_ == 0) return product;
    product.negative_ = a.negative_ != b.negative_;
    product.size_ = a.size_ + b.size_;
    assert(product.size_ <= capacity);
    if (a.size_ == 1 && b.size_ == 1) {
      __extension__ using Wide = unsigned __int128;
      const Wide wide = static_cast<Wide>(a.limbs_[0]) * b.limbs_[0];
      product.limbs_[0] = static_cast<mp_limb_t>(wide);
      product.limbs_[1] = static_cast<mp_limb_t>(wide >> 64U);
    } else if (a.size_ >= b.size_) {
      mpn_mul(product.limbs_, a.limbs_, a.size_, b.limbs_, b.size_);
    } else {
      mpn_mul(product.limbs_, b.limbs_, b.size_, a.limbs_, a.size_);
    }
    product.drop_leading_zeros();
    return product;
  }
  // value * 2^count
  friend StackInteger shifted(const StackInteger& value, int count) {
    StackInteger result;
    if (value.size_ == 0) return result;
    const int whole = count / GMP_NUMB_BITS;
    const auto rest = static_cast<unsigned>(count % GMP_NUMB_BITS);
    assert(value.size_ + whole + 1 <= capacity);
    result.negative_ = value.negative_;
    std::fill_n(result.limbs_, whole, mp_limb_t{0});
    mp_limb_t carry = 0;
    if (rest == 0) {
      std::copy_n(value.limbs_, value.size_, result.limbs_ + whole);
    } else {
      carry = mpn_lshift(result.limbs_ + whole, value.limbs_, value.size_, rest);
    }
    result.limbs_[whole + value.size_] = carry;
    result.size_ = whole + value.size_ + 1;
    result.drop_leading_zeros();
    return result;
  }

 private:
  void drop_leading_zeros() {
    while (size_ > 0 && limbs_[size_ - 1] == 0) --size_;
  }

  // a + b, where b's sign is read as `b_negative`
  static StackInteger sum(const StackInteger& a, const StackInteger& b, bool b_negative) {
    const bool a_is_longer = a.size_ >= b.size_;
    const StackInteger& longer = a_is_longer ? a : b;
    const StackInteger& shorter = a_is_longer ? b : a;
    const bool longer_negative = a_is_longer ? a.negative_ : b_negative;
    StackInteger result;
    result.negative_ = longer_negative;
    result.size_ = longer.size_;
    if (shorter.size_ == 0) {
      std::copy_n(longer.limbs_, longer.size_, result.limbs_);
    } else if (a.negative_ == b_negative) {
      const mp_limb_t carry =
          mpn_add(result.limbs_, longer.limbs_, longer.size_, shorter.limbs_, shorter.size_);
      if (carry != 0) {
        assert(result.size_ < capacity);
        result.limbs_[result.size_++] = carry;
      }
    } else if (longer.size_ == shorter.size_ &&
               mpn_cmp(longer.limbs_, shorter.limbs_, longer.size_) < 0) {
      mpn_sub_n(result.limbs_, shorter.limbs_, longer.limbs_, longer.size_);
      result.negative_ = !longer_negative;
      result.drop_leading_zeros();
    } else {
      mpn_sub(result.limbs_, longer.limbs_, longer.size_, shorter.limbs_, shorter.size_);
      result.drop_leading_zeros();
    }
    return result;
  }

  int size_ = 0;
  bool negative_ = false;
  mp_limb_t limbs_[capacity];  // only the first size_ are meaningful
};

}  // namespace exactcsg
