// SPDX-License-Identifier: GPL-3.0-or-later
// Expected values: polynomials multiplied out from roots that are chosen, and quadratic numbers.

#include "exactcsg/number/algebraic_number.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace exactcsg {
namespace {

using Coefficients = std::vector<Rational>;

Coefficients product(const Coefficients& p, const Coefficients& q) {
  Coefficients result(p.size() + q.size() - 1);
  for (std::size_t i = 0; i < p.size(); ++i) {
    for (std::size_t j = 0; j < q.size(); ++j) result[i + j] += p[i] * q[j];
  }
  return result;
}

TEST(AlgebraicNumbers, RootsOfProductsAreThoseOfTheFactors) {
  // t^2 (t - 1/3)^2, with t^2 + 1 that has none
  const Coefficients linear{Rational(-1, 3), 1};
  const auto roots = real_roots(product(product({0, 0, 1}, product(linear, linear)), {1, 0, 1}));
  ASSERT_EQ(roots.size(), 2U);
  EXPECT_EQ(roots[0].value, AlgebraicNumber(Rational(0)));
  EXPECT_EQ(roots[0].multiplicity, 2);
  EXPECT_EQ(roots[1].value, AlgebraicNumber(Rational(1, 3)));
  EXPECT_EQ(roots[1].multiplicity, 2);
}

TEST(AlgebraicNumbers, AreEqualHoweverTheyCameAbout) {
  // t^4 - 4 = (t^2 - 2)(t^2 + 2); t^4 - 10 t^2 + 1 is the least polynomial of sqrt 2 + sqrt 3.
  const auto twos = real_roots(Coefficients{-4, 0, 0, 0, 1});
  ASSERT_EQ(twos.size(), 2U);
  EXPECT_EQ(twos[1].value, AlgebraicNumber(QuadraticNumber(0, 1, 2)));
  EXPECT_EQ(twos[0].value, AlgebraicNumber(QuadraticNumber(0, -1, 2)));
  const auto sums = real_roots(Coefficients{1, 0, -10, 0, 1});
  const auto again = real_roots(product({1, 0, -10, 0, 1}, {-7, 1}));
  ASSERT_EQ(sums.size(), 4U);
  ASSERT_EQ(again.size(), 5U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(sums[i].value, again[i].value);
    EXPECT_TRUE(sums[i].value < again[i + 1].value);
    const Enclosure bounds = enclose(sums[i].value, 300);
    EXPECT_LE(Rational(bounds.upper - bounds.lower), Rational(Integer(1), Integer(1) << 300));
  }
  EXPECT_NEAR(approximate(sums[3].value), std::sqrt(2.0) + std::sqrt(3.0), 1e-15);
  EXPECT_LT(sums[3].value.approximate().error, 1e-14);
}

// Apart by less than doubles tell.
TEST(AlgebraicNumbers, NeighboursAreOrdered) {
  const Rational tiny(Integer(1), Integer(1) << 200);
  const auto root = real_roots(Coefficients{-1, 3, -7, 0, 0, 1}).back().value;
  const Enclosure bounds = enclose(root, 150);
  const Enclosure narrower = enclose(root, 250);
  EXPECT_TRUE(AlgebraicNumber(bounds.lower) <= root && root <= AlgebraicNumber(bounds.upper));
  EXPECT_TRUE(AlgebraicNumber(Rational(narrower.lower - tiny)) < root);
  EXPECT_TRUE(root < AlgebraicNumber(QuadraticNumber(narrower.upper, tiny, 2)));
  const Rational between = rational_between(Rational(narrower.lower - tiny), root);
  EXPECT_TRUE(Rational(narrower.lower - tiny) < between && AlgebraicNumber(between) < root);
}

// Random products of quadratic polynomials: the roots are quadratic numbers, sorted.
TEST(AlgebraicNumbers, ProductsOfQuadraticPolynomials) {
  std::mt19937_64 engine(1);
  std::uniform_int_distribution<int> digit(-6, 6);
  for (int i = 0; i < 200; ++i) {
    Coefficients whole{1};
    std::vector<QuadraticNumber> expected;
    for (int k = 0; k < 2; ++k) {
      const QuadraticPolynomial p{1 + std::abs(digit(engine)), digit(engine), digit(engine)};
      whole = product(whole, {p.constant, p.linear, p.square});
      for (const RealRoot& root : real_roots(p)) expected.push_back(root.value);
    }
    std::sort(expected.begin(), expected.end());
    expected.erase(std::unique(expected.begin(), expected.end()), expected.end());
    const auto roots = real_roots(whole);
    ASSERT_EQ(roots.size(), expected.size());
    for (std::size_t k = 0; k < roots.size(); ++k) {
      ASSERT_EQ(roots[k].value, AlgebraicNumber(expected[k]));
    }
  }
}

}  // namespace
}  // namespace exactcsg
