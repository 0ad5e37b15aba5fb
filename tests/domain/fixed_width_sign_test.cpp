// SPDX-License-Identifier: GPL-3.0-or-later
// Signs of fixed width against the polynomial evaluated in rational arithmetic.

#include "exactcsg/domain/fixed_width_sign.hpp"

#include <gtest/gtest.h>

#include "domain/laws.hpp"

namespace exactcsg::domain::test {
namespace {

template <std::size_t D>
struct Polynomial {
  Rational constant;
  Coordinates<D> linear;
  std::vector<Rational> square;  // of x_i x_j, i <= j, row by row; none if linear

  Rational operator()(const Coordinates<D>& x) const {
    Rational value = constant + scalar_product(linear, x);
    auto coefficient = square.begin();
    for (std::size_t i = 0; i < D && !square.empty(); ++i) {
      for (std::size_t j = i; j < D; ++j) value += *coefficient++ * x[i] * x[j];
    }
    return value;
  }
  FixedWidthPolynomial<D> of_fixed_width() const {
    std::vector<Rational> all{constant};
    all.insert(all.end(), linear.begin(), linear.end());
    all.insert(all.end(), square.begin(), square.end());
    return FixedWidthPolynomial<D>(all);
  }
};

// Half of the polynomials go through the point.
template <std::size_t D>
void expect_signs(Random& random) {
  Polynomial<D> f{random.rational(), random.template coordinates<D>(), {}};
  if (random.one_in(2)) {
    for (std::size_t i = 0; i < D * (D + 1) / 2; ++i) f.square.push_back(random.rational());
  }
  const auto x = random.template coordinates<D>();
  if (random.one_in(2)) f.constant -= f(x);
  const auto at = nearby(x, random);
  ASSERT_EQ(f.of_fixed_width().sign(at), std::optional(sign_of(f(at))));
}

TEST(FixedWidthSigns, EqualThoseInRationalArithmetic) {
  Random random(5);
  for (int i = 0; i < 20'000; ++i) {
    expect_signs<1>(random);
    expect_signs<2>(random);
    expect_signs<3>(random);
  }
}

// The sum of the coordinates at x, y = 1: the bits are those of x.
TEST(FixedWidthSigns, AreGivenUpOnWhereTheyWouldNotFit) {
  const std::vector<Rational> ones(3, 1);
  const FixedWidthPolynomial<2> sum(ones);
  const auto power = [](unsigned long bits) { return Rational(-(Integer(1) << bits)); };
  constexpr unsigned long limb = GMP_NUMB_BITS;
  EXPECT_EQ(sum.sign({power(13 * limb), 1}), std::optional(Sign::Negative));
  EXPECT_EQ(sum.sign({power(20 * limb), 1}), std::nullopt);
  EXPECT_EQ(sum.sign({Rational(1 / power(20 * limb)), 1}), std::nullopt);
  const std::vector<Rational> long_ones{power(40 * limb), 1, 1};
  EXPECT_EQ(FixedWidthPolynomial<2>(long_ones).sign({1, 1}), std::nullopt);
}

}  // namespace
}  // namespace exactcsg::domain::test
