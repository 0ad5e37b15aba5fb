// SPDX-License-Identifier: Apache-2.0
#pragma once

// Real numbers a + b sqrt(c) with rational a, b and c >= 0: the roots of quadratic polynomials with
// rational coefficients. They are compared exactly, also with different c. [Exact]
//
// LAW quadratic.1  compare is the order of the real numbers; == is their equality, not that of the
//                  representations (sqrt(8) == 2 sqrt(2)).
// LAW quadratic.2  a root x of p that real_roots(p) yields has p(x) = 0, and there are no others.
// LAW quadratic.3  enclose(x, bits) contains x and is at most 2^-bits wide.
// COST: certified doubles decide numbers that differ visibly; else some twenty operations on
// rationals of up to four times the length.

#include <compare>
#include <vector>

#include "exactcsg/number/certified_double.hpp"
#include "exactcsg/number/enclosure.hpp"
#include "exactcsg/number/exact.hpp"

namespace exactcsg {

class QuadraticNumber {
 public:
  QuadraticNumber() : QuadraticNumber(Rational(0)) {}
  QuadraticNumber(Rational value);  // every rational is one
  // a + b sqrt(c). REQUIRES c >= 0
  QuadraticNumber(Rational a, Rational b, Rational c);

  const Rational& rational_part() const noexcept { return a_; }
  const Rational& factor() const noexcept { return b_; }
  const Rational& radicand() const noexcept { return c_; }
  // [Certified]
  const CertifiedDouble& approximate() const noexcept { return approximate_; }

 private:
  Rational a_;
  Rational b_;  // 0 if c_ is
  Rational c_;
  CertifiedDouble approximate_;
};

Sign sign_of(const QuadraticNumber& value);
std::strong_ordering compare(const QuadraticNumber& x, const QuadraticNumber& y);
inline bool operator==(const QuadraticNumber& x, const QuadraticNumber& y) {
  return compare(x, y) == 0;
}
inline std::strong_ordering operator<=>(const QuadraticNumber& x, const QuadraticNumber& y) {
  return compare(x, y);
}

// The nearest doubles below and above would do: within one unit in the last place or so.
// [Approximate]
inline double approximate(const QuadraticNumber& value) { return value.approximate().value; }
Enclosure enclose(const QuadraticNumber& value, int bits);

// A rational strictly between. REQUIRES x < y
Rational rational_between(const QuadraticNumber& x, const QuadraticNumber& y);

// square t^2 + linear t + constant
struct QuadraticPolynomial {
  Rational square;
  Rational linear;
  Rational constant;

  bool is_zero() const { return square == 0 && linear == 0 && constant == 0; }
  Rational operator()(const Rational& t) const;
};

struct RealRoot {
  QuadraticNumber value;
  int multiplicity = 1;
};

// In ascending order, each once. REQUIRES not the zero polynomial
std::vector<RealRoot> real_roots(const QuadraticPolynomial& polynomial);

}  // namespace exactcsg
