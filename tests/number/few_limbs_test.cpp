// SPDX-License-Identifier: GPL-3.0-or-later
// Integers of few limbs against those of GMP. LAW few_limbs.1

#include "exactcsg/number/few_limbs.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>

namespace exactcsg {
namespace {

class RandomIntegers {
 public:
  explicit RandomIntegers(std::uint64_t seed) : random_(seed) {}

  unsigned long below(unsigned long n) { return random_() % n; }
  // Limbs that are random, or all zeros or ones, where carries go far.
  Integer operator()() {
    Integer result;
    for (unsigned long limbs = below(7); limbs > 0; --limbs) {
      result <<= 64;
      result += below(3) > 0 ? random_() : below(2) == 0 ? 0 : ~0UL;
    }
    return below(2) == 0 ? result : Integer(-result);
  }
  Integer odd() {
    Integer result = abs((*this)());
    mpz_setbit(result.get_mpz_t(), 0);
    return result;
  }

 private:
  std::mt19937_64 random_;
};

FewLimbs few(const Integer& value) {
  FewLimbs result;
  result.set(limbs_of(value), value < 0);
  return result;
}

// Of what is computed in place: from the limbs, and without leading zeros.
Integer integer(const FewLimbs& value) {
  const LimbSpan limbs = value.magnitude();
  EXPECT_TRUE(limbs.empty() || limbs.back() != 0);
  EXPECT_FALSE(value.is_zero() && value.is_negative());
  mpz_t magnitude;
  const Integer result(mpz_roinit_n(magnitude, limbs.data(), static_cast<mp_size_t>(limbs.size())));
  return value.is_negative() ? Integer(-result) : result;
}

TEST(FewLimbs, SumsProductsAndShifts) {
  RandomIntegers random(1);
  for (int round = 0; round < 20000; ++round) {
    const Integer a = random();
    const Integer b = random();
    // Nearly equal ones now and then.
    const Integer c = random.below(4) == 0 ? Integer(a * b + random.below(3) - 1) : random();
    const FewLimbs fa = few(a);
    const FewLimbs fb = few(b);
    FewLimbs x = few(c);
    x.add(fa);
    EXPECT_EQ(integer(x), c + a);
    x.set(few(c));
    x.subtract(fb);
    EXPECT_EQ(integer(x), c - b);
    x.set_product(fa, fb);
    EXPECT_EQ(integer(x), a * b);
    x = few(c);
    x.add_product(fa, fb);
    EXPECT_EQ(integer(x), c + a * b);
    x = few(c);
    x.subtract_product(fa, fb);
    EXPECT_EQ(integer(x), c - a * b);
    x.negate();
    EXPECT_EQ(integer(x), a * b - c);
    const unsigned long factor = random.below(2) == 0 ? random.below(~0UL) : random.below(3);
    x = fa;
    x.multiply(factor);
    EXPECT_EQ(integer(x), a * factor);
    const unsigned long count = random.below(300);
    x = fa;
    x.shift_left(count);
    EXPECT_EQ(integer(x), a << count);
    if (a != 0) {
      EXPECT_EQ(x.count_zeros(), mpz_scan1(Integer(a << count).get_mpz_t(), 0));
    }
    x = fa;
    x.shift_right(count);
    Integer cut;
    mpz_tdiv_q_2exp(cut.get_mpz_t(), a.get_mpz_t(), count);
    EXPECT_EQ(integer(x), cut);
  }
}

TEST(FewLimbs, ExactQuotientsAndCommonDivisors) {
  RandomIntegers random(2);
  for (int round = 0; round < 20000; ++round) {
    const Integer a = random();
    const Integer odd = random.odd();
    FewLimbs x = few(a * odd);
    x.divide_exactly(few(odd));
    EXPECT_EQ(integer(x), a);

    const unsigned long limb = odd.get_ui();
    const Integer dividend = random.below(2) == 0 ? a : Integer(a * limb);
    x = few(dividend);
    const bool divides = mpz_divisible_ui_p(dividend.get_mpz_t(), limb) != 0;
    EXPECT_EQ(x.divide_if_exact(limb), divides);
    EXPECT_EQ(integer(x), divides ? Integer(dividend / limb) : dividend);

    const Integer common = random.below(3) == 0 ? Integer(1) : random.odd();
    const Integer p = random.odd() * common;
    const Integer q = random() * common << random.below(100);
    if (q == 0) continue;
    x.set_odd_gcd(few(p), few(q));
    EXPECT_EQ(integer(x), gcd(p, q));
  }
}

}  // namespace
}  // namespace exactcsg
