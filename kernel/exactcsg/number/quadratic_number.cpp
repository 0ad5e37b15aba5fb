// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/number/quadratic_number.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "exactcsg/number/certified_root.hpp"

namespace exactcsg {

namespace {

CertifiedDouble approximation(const Rational& a, const Rational& b, const Rational& c) {
  if (b == 0) return certified_double_of(a);
  return certified_double_of(a) + certified_double_of(b) * square_root(certified_double_of(c));
}

// The sign of b sqrt(c) + e sqrt(f)
Sign sign_of_roots(const Rational& b, const Rational& c, const Rational& e, const Rational& f) {
  const Sign first = c == 0 ? Sign::Zero : sign_of(b);
  const Sign second = f == 0 ? Sign::Zero : sign_of(e);
  if (first == second || second == Sign::Zero) return first;
  if (first == Sign::Zero) return second;
  return first * sign_of(Rational(b * b * c - e * e * f));
}

// The sign of a + b sqrt(c)
Sign sign_of_sum(const Rational& a, const Rational& b, const Rational& c) {
  return sign_of_roots(a, Rational(1), b, c);
}

// The sign of a + b sqrt(c) + e sqrt(f), by squaring twice.
Sign sign_of_sum(const Rational& a, const Rational& b, const Rational& c, const Rational& e,
                 const Rational& f) {
  const Sign rational = sign_of(a);
  const Sign roots = sign_of_roots(b, c, e, f);
  if (rational == roots || roots == Sign::Zero) return rational;
  if (rational == Sign::Zero) return roots;
  // a^2 against (b sqrt(c) + e sqrt(f))^2
  const Rational difference = a * a - b * b * c - e * e * f;
  return rational * sign_of_sum(difference, Rational(-2 * b * e), Rational(c * f));
}

// sqrt(value) within 2^-bits: floor(sqrt(n d 4^k)) / (d 2^k)
Enclosure enclose_root(const Rational& value, int bits) {
  const auto shift = static_cast<unsigned long>(std::max(bits, 0));
  const Integer scaled = (value.get_num() * value.get_den()) << (2 * shift);
  Integer root;
  Integer rest;
  mpz_sqrtrem(root.get_mpz_t(), rest.get_mpz_t(), scaled.get_mpz_t());
  const Integer denominator = value.get_den() << shift;
  Rational lower(root, denominator);
  lower.canonicalize();
  if (rest == 0) return {lower, lower};
  Rational upper(Integer(root + 1), denominator);
  upper.canonicalize();
  return {lower, upper};
}

}  // namespace

QuadraticNumber::QuadraticNumber(Rational value)
    : a_(std::move(value)), approximate_(certified_double_of(a_)) {}

QuadraticNumber::QuadraticNumber(Rational a, Rational b, Rational c)
    : a_(std::move(a)), b_(std::move(b)), c_(std::move(c)) {
  if (c_ == 0) b_ = 0;
  if (b_ == 0) c_ = 0;
  if (mpz_perfect_square_p(c_.get_num_mpz_t()) != 0 &&
      mpz_perfect_square_p(c_.get_den_mpz_t()) != 0) {
    a_ += b_ * Rational(sqrt(c_.get_num()), sqrt(c_.get_den()));
    b_ = 0;
    c_ = 0;
  }
  approximate_ = approximation(a_, b_, c_);
}

Sign sign_of(const QuadraticNumber& value) {
  const CertifiedDouble& filter = value.approximate();
  if (std::abs(filter.value) > filter.error) {
    return filter.value > 0 ? Sign::Positive : Sign::Negative;
  }
  return sign_of_sum(value.rational_part(), value.factor(), value.radicand());
}

std::strong_ordering compare(const QuadraticNumber& x, const QuadraticNumber& y) {
  const CertifiedDouble filter = x.approximate() - y.approximate();
  if (filter.value > filter.error) return std::strong_ordering::greater;
  if (-filter.value > filter.error) return std::strong_ordering::less;
  const Sign sign = sign_of_sum(Rational(x.rational_part() - y.rational_part()), x.factor(),
                                x.radicand(), Rational(-y.factor()), y.radicand());
  return static_cast<int>(sign) <=> 0;
}

Enclosure enclose(const QuadraticNumber& value, int bits) {
  const Rational& b = value.factor();
  if (b == 0) return {value.rational_part(), value.rational_part()};
  // |b| < 2^(bits of its numerator - bits of its denominator + 1)
  const int length = static_cast<int>(mpz_sizeinbase(b.get_num_mpz_t(), 2)) -
                     static_cast<int>(mpz_sizeinbase(b.get_den_mpz_t(), 2)) + 1;
  const Enclosure root = enclose_root(value.radicand(), bits + length);
  Rational lower = value.rational_part() + b * root.lower;
  Rational upper = value.rational_part() + b * root.upper;
  if (b < 0) std::swap(lower, upper);
  return {std::move(lower), std::move(upper)};
}

Rational rational_between(const QuadraticNumber& x, const QuadraticNumber& y) {
  // A short decimal point of the doubles, where they tell.
  const double low = x.approximate().upper();
  const double high = y.approximate().lower();
  if (std::isfinite(low) && std::isfinite(high) && low < high) {
    const double middle = low / 2 + high / 2;
    if (low < middle && middle < high) return rational_of(middle);
  }
  for (int bits = 32;; bits *= 2) {
    const Enclosure first = enclose(x, bits);
    const Enclosure second = enclose(y, bits);
    if (first.upper < second.lower) return (first.upper + second.lower) / 2;
  }
}

Rational QuadraticPolynomial::operator()(const Rational& t) const {
  return (square * t + linear) * t + constant;
}

std::vector<RealRoot> real_roots(const QuadraticPolynomial& polynomial) {
  const auto& [square, linear, constant] = polynomial;
  if (square == 0) {
    if (linear == 0) return {};
    return {{QuadraticNumber(Rational(-constant / linear)), 1}};
  }
  const Rational discriminant = linear * linear - 4 * square * constant;
  if (discriminant < 0) return {};
  const Rational middle = -linear / (2 * square);
  if (discriminant == 0) return {{QuadraticNumber(middle), 2}};
  const Rational factor = 1 / abs(Rational(2 * square));
  return {{QuadraticNumber(middle, Rational(-factor), discriminant), 1},
          {QuadraticNumber(middle, factor, discriminant), 1}};
}

}  // namespace exactcsg
