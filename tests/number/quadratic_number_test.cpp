// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers a + b sqrt(c). Expected orders: closed forms, enclosures of 2000 bits by bisection, and
// the definition of a root.

#include "exactcsg/number/quadratic_number.hpp"

#include <gtest/gtest.h>

#include <random>

namespace exactcsg {
namespace {

TEST(QuadraticNumber, EqualNumbersAreEqualHoweverWritten) {
  EXPECT_EQ(QuadraticNumber(0, 1, 8), QuadraticNumber(0, 2, 2));
  EXPECT_EQ(QuadraticNumber(1, 3, 4), QuadraticNumber(Rational(7)));
  EXPECT_EQ(QuadraticNumber(1, 3, 4).factor(), 0);
  EXPECT_EQ(QuadraticNumber(0, 1, Rational(1, 2)), QuadraticNumber(0, Rational(1, 2), 2));
  EXPECT_EQ(QuadraticNumber(5, 0, 3), QuadraticNumber(5, 7, 0));
  EXPECT_LT(QuadraticNumber(0, -1, 2), QuadraticNumber(0, -1, Rational(19, 10)));
  EXPECT_EQ(sign_of(QuadraticNumber(-7, 5, 2)), Sign::Positive);    // 50 > 49
  EXPECT_EQ(sign_of(QuadraticNumber(-17, 12, 2)), Sign::Negative);  // 288 < 289
}

// Convergents of sqrt(2): p^2 - 2 q^2 = +-1, closer than any double can tell.
TEST(QuadraticNumber, NearlyEqualNumbersAreOrdered) {
  Integer p = 1;
  Integer q = 1;
  for (int i = 0; i < 300; ++i) {
    const QuadraticNumber root(0, 1, 2);
    const QuadraticNumber near(Rational(p, q));
    const bool below = p * p < 2 * q * q;
    EXPECT_EQ(near < root, below);
    EXPECT_EQ(root > near, below);
    EXPECT_FALSE(near == root);
    // 1 + sqrt(2) against p/q + sqrt(1 + tiny)
    const Rational tiny(Integer(1), Integer(4 * q * q));
    EXPECT_EQ(QuadraticNumber(1, 1, 2) < QuadraticNumber(Rational(p, q), 1, 1 + tiny),
              below ? (Rational(p, q) + tiny / 4) * (Rational(p, q) + tiny / 4) > 2 : true);
    const Rational between = below ? rational_between(near, root) : rational_between(root, near);
    EXPECT_EQ(between * between > 2, !below);
    const Integer next = p + 2 * q;
    q = p + q;
    p = next;
  }
}

// Random numbers, many of them equal, against enclosures so narrow that only equal numbers overlap
// (root separation: the differences are algebraic of degree 4 with coefficients below 2^60).
TEST(QuadraticNumber, OrderAgreesWithNarrowEnclosures) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> small(-3, 3);
  std::uniform_int_distribution<int> positive(0, 12);
  int equal = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto number = [&] {
      Rational a(small(random), 1 + positive(random) % 3);
      a.canonicalize();
      return QuadraticNumber(a, small(random), positive(random));
    };
    const QuadraticNumber x = number();
    const QuadraticNumber y = number();
    const Enclosure ex = enclose(x, 2000);
    const Enclosure ey = enclose(y, 2000);
    const auto expected = ex.upper < ey.lower   ? std::strong_ordering::less
                          : ex.lower > ey.upper ? std::strong_ordering::greater
                                                : std::strong_ordering::equal;
    ASSERT_EQ(compare(x, y), expected);
    if (expected == 0) ++equal;
    const Rational width(Integer(1), Integer(1) << 2000);
    ASSERT_LE(ex.upper - ex.lower, width);
    ASSERT_LE(std::abs(approximate(x) - nearest_double(ex.lower)), x.approximate().error + 1e-300);
  }
  EXPECT_GT(equal, 100);
}

TEST(QuadraticNumber, RootsAreZerosInOrder) {
  std::mt19937 random(8);
  std::uniform_int_distribution<int> small(-5, 5);
  for (int i = 0; i < 5000; ++i) {
    const QuadraticPolynomial p{small(random), small(random), small(random)};
    if (p.is_zero()) continue;
    const auto roots = real_roots(p);
    int count = 0;
    for (std::size_t k = 0; k < roots.size(); ++k) {
      // p(a + b r) = (s (a^2 + b^2 c) + l a + k) + (2 s a b + l b) r
      const Rational& a = roots[k].value.rational_part();
      const Rational& b = roots[k].value.factor();
      const Rational& c = roots[k].value.radicand();
      EXPECT_EQ(p.square * (a * a + b * b * c) + p.linear * a + p.constant, 0);
      EXPECT_EQ(2 * p.square * a * b + p.linear * b, 0);
      if (k > 0) {
        EXPECT_LT(roots[k - 1].value, roots[k].value);
      }
      count += roots[k].multiplicity;
    }
    const Rational discriminant = p.linear * p.linear - 4 * p.square * p.constant;
    EXPECT_EQ(count, p.square == 0 ? (p.linear == 0 ? 0 : 1) : discriminant < 0 ? 0 : 2);
  }
}

}  // namespace
}  // namespace exactcsg
