// SPDX-License-Identifier: Apache-2.0
#pragma once

// The sign of a polynomial of degree at most two at a rational point, in integers on the stack: no
// allocation, and no fraction is ever reduced. [Exact]
//
// LAW fixed_width.1  sign(x), where there is one, is the sign of the polynomial at x.
// LAW fixed_width.2  there is one if c + 2 p + 2 <= capacity, in limbs: c of the longest
//                    coefficient over the common denominator of all; p of the product of the
//                    coordinates' denominators (of their only one if they are equal), and what the
//                    longest numerator has more than its denominator.
// COST: O(D^2) products of at most `capacity` limbs together.

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "exactcsg/number/exact.hpp"
#include "exactcsg/number/stack_integer.hpp"

namespace exactcsg::domain {

template <std::size_t D>
class FixedWidthPolynomial {
 public:
  static constexpr int capacity = 32;

  FixedWidthPolynomial() = default;  // REQUIRES is not asked
  // The constant; the D linear coefficients; and, of a quadratic polynomial, those of x_i x_j for
  // i <= j, row by row.
  explicit FixedWidthPolynomial(std::span<const Rational> coefficients) {
    Integer denominator = 1;
    for (const Rational& coefficient : coefficients) {
      if (coefficient.get_den() != 1) denominator = lcm(denominator, coefficient.get_den());
    }
    coefficients_.reserve(coefficients.size());
    for (const Rational& coefficient : coefficients) {
      coefficients_.push_back(coefficient.get_num() * (denominator / coefficient.get_den()));
      limbs_ = std::max(limbs_, limbs_of(coefficients_.back()));
    }
  }

  std::optional<Sign> sign(const std::array<Rational, D>& x) const {
    const int point_limbs = limbs_of_point(x);
    if (limbs_ + 2 * point_limbs + 2 > capacity) return std::nullopt;
    const Homogeneous p(x);
    auto coefficient = coefficients_.begin();
    Number sum = Number(*coefficient++) * p.denominator;
    for (std::size_t i = 0; i < D; ++i) sum = sum + Number(*coefficient++) * p.numerators[i];
    if (coefficient == coefficients_.end()) return sum.sign();
    sum = sum * p.denominator;
    for (std::size_t i = 0; i < D; ++i) {
      Number factor;
      for (std::size_t j = i; j < D; ++j, ++coefficient) {
        if (*coefficient != 0) factor = factor + Number(*coefficient) * p.numerators[j];
      }
      sum = sum + factor * p.numerators[i];
    }
    return sum.sign();
  }

 private:
  using Number = StackInteger<capacity>;

  static int limbs_of(const Integer& value) {
    return static_cast<int>(mpz_size(value.get_mpz_t()));
  }
  static bool has_one_denominator(const std::array<Rational, D>& x) {
    return std::all_of(x.begin() + 1, x.end(),
                       [&](const Rational& r) { return r.get_den() == x[0].get_den(); });
  }

  // Of the longest of the homogeneous coordinates, or more.
  static int limbs_of_point(const std::array<Rational, D>& x) {
    int denominators = 0;
    int excess = 0;  // of a numerator over its denominator
    for (const Rational& r : x) {
      denominators += limbs_of(r.get_den());
      excess = std::max(excess, limbs_of(r.get_num()) - limbs_of(r.get_den()));
    }
    if (has_one_denominator(x)) denominators = limbs_of(x[0].get_den());
    return denominators + excess;
  }

  // numerators / denominator, not reduced
  struct Homogeneous {
    explicit Homogeneous(const std::array<Rational, D>& x) {
      denominator = Number(x[0].get_den());
      for (std::size_t i = 0; i < D; ++i) numerators[i] = Number(x[i].get_num());
      if (has_one_denominator(x)) return;
      for (std::size_t i = 0; i < D; ++i) {
        if (i > 0) denominator = denominator * Number(x[i].get_den());
        for (std::size_t j = 0; j < D; ++j) {
          if (j != i) numerators[j] = numerators[j] * Number(x[i].get_den());
        }
      }
    }
    Number denominator;
    std::array<Number, D> numerators;
  };

  std::vector<Integer> coefficients_;
  int limbs_ = 0;
};

}  // namespace exactcsg::domain
