// SPDX-License-Identifier: Apache-2.0
#pragma once

// Real numbers that are roots of polynomials with rational coefficients. Those of degree two keep
// the form of quadratic_number.hpp, and its speed. [Exact]
//
// LAW algebraic.1  compare is the order of the real numbers, == their equality, however they came
//                  about: sqrt(2) as a root of t^4 - 4 equals QuadraticNumber(0, 1, 2).
// LAW algebraic.2  real_roots(p) are all real roots of p, ascending, each once, with its
//                  multiplicity.
// LAW algebraic.3  enclose(x, bits) contains x and is at most 2^-bits wide.
// COST: certified doubles decide numbers that differ visibly; quadratic ones as there; others by
// CGAL's univariate algebraic kernel, which isolates the roots as well.

#include <compare>
#include <memory>
#include <span>
#include <vector>

#include "exactcsg/number/quadratic_number.hpp"

namespace exactcsg {

class AlgebraicNumber {
 public:
  AlgebraicNumber() = default;
  AlgebraicNumber(Rational value) : quadratic_(std::move(value)) {}
  AlgebraicNumber(QuadraticNumber value) : quadratic_(std::move(value)) {}

  // The only root of a polynomial without multiple roots between two bounds, at which it has
  // different signs.
  struct Root {
    std::vector<Integer> coefficients;  // ascending
    Rational lower;
    Rational upper;
    CertifiedDouble approximation;
  };
  // REQUIRES what Root says.
  explicit AlgebraicNumber(Root root) : root_(std::make_shared<const Root>(std::move(root))) {}

  // nullptr if it is not known to be one.
  const QuadraticNumber* quadratic() const noexcept { return root_ ? nullptr : &quadratic_; }
  // REQUIRES quadratic() == nullptr
  const Root& root() const noexcept { return *root_; }
  // [Certified]
  const CertifiedDouble& approximate() const noexcept {
    return root_ ? root_->approximation : quadratic_.approximate();
  }

 private:
  QuadraticNumber quadratic_;
  std::shared_ptr<const Root> root_;
};

std::strong_ordering compare(const AlgebraicNumber& x, const AlgebraicNumber& y);
inline bool operator==(const AlgebraicNumber& x, const AlgebraicNumber& y) {
  return compare(x, y) == 0;
}
inline std::strong_ordering operator<=>(const AlgebraicNumber& x, const AlgebraicNumber& y) {
  return compare(x, y);
}

// [Approximate]
inline double approximate(const AlgebraicNumber& value) { return value.approximate().value; }
Enclosure enclose(const AlgebraicNumber& value, int bits);

// A rational strictly between. REQUIRES x < y
Rational rational_between(const AlgebraicNumber& x, const AlgebraicNumber& y);

struct AlgebraicRoot {
  AlgebraicNumber value;
  int multiplicity = 1;
};

// Of the polynomial with these coefficients, in ascending powers. REQUIRES one that is not 0
std::vector<AlgebraicRoot> real_roots(std::span<const Rational> coefficients);

}  // namespace exactcsg
