// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/number/algebraic_number.hpp"

// g++ 12 takes one of CGAL's reference counts for a use after its deletion.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wuse-after-free"
#endif
#include <CGAL/Algebraic_kernel_d_1.h>
#include <CGAL/Gmpz.h>
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace exactcsg {

namespace {

// Numbers of the kernel refine themselves when they are asked: none is kept, so that threads share
// none.
using Kernel = CGAL::Algebraic_kernel_d_1<CGAL::Gmpz>;
using KernelNumber = Kernel::Algebraic_real_1;
using KernelPolynomial = Kernel::Polynomial_1;

CGAL::Gmpq bound_of(const Rational& value) { return CGAL::Gmpq(value.get_mpq_t()); }
Rational rational_of_bound(const CGAL::Gmpq& value) { return Rational(value.mpq()); }

KernelPolynomial polynomial_of(std::span<const Integer> coefficients) {
  std::vector<CGAL::Gmpz> converted;
  for (const Integer& coefficient : coefficients) converted.emplace_back(coefficient.get_mpz_t());
  return {converted.begin(), converted.end()};
}

// Times a positive number.
std::vector<Integer> integral(std::span<const Rational> coefficients) {
  Integer denominator = 1;
  for (const Rational& coefficient : coefficients) {
    denominator = lcm(denominator, coefficient.get_den());
  }
  std::vector<Integer> result;
  for (const Rational& coefficient : coefficients) {
    result.push_back(coefficient.get_num() * (denominator / coefficient.get_den()));
  }
  return result;
}

KernelNumber kernel_number(const AlgebraicNumber& x) {
  const auto construct = Kernel().construct_algebraic_real_1_object();
  if (x.quadratic() == nullptr) {
    const AlgebraicNumber::Root& root = x.root();
    return construct(polynomial_of(root.coefficients), bound_of(root.lower), bound_of(root.upper));
  }
  const Rational& a = x.quadratic()->rational_part();
  const Rational& b = x.quadratic()->factor();
  const Rational& c = x.quadratic()->radicand();
  if (b == 0) return construct(bound_of(a));
  // The two roots of (t - a)^2 = b^2 c lie on either side of a, nearer than |b| (c + 1).
  const std::array<Rational, 3> coefficients{Rational(a * a - b * b * c), Rational(-2 * a), 1};
  const Rational end = a + b * (c + 1);
  return construct(polynomial_of(integral(coefficients)), bound_of(b > 0 ? a : end),
                   bound_of(b > 0 ? end : a));
}

// [Certified]
CertifiedDouble approximation_of(const KernelNumber& x) {
  constexpr int bits = 60;
  const auto [low, high] = Kernel().approximate_relative_1_object()(x, bits);
  const Rational lower = rational_of_bound(low);
  const Rational middle = (lower + rational_of_bound(high)) / 2;
  CertifiedDouble result = certified_double_of(middle);
  result.error += certified_double_of(Rational(middle - lower)).value * (1 + 0x1p-50) + 0x1p-950;
  return result;
}

// REQUIRES an irreducible or square-free polynomial of degree at most two, of which x is a root
AlgebraicNumber quadratic_root(const KernelPolynomial& p, const KernelNumber& x) {
  QuadraticPolynomial polynomial;
  polynomial.constant = Integer(p[0].mpz());
  polynomial.linear = Integer(p[1].mpz());
  if (p.degree() == 2) polynomial.square = Integer(p[2].mpz());
  std::vector<RealRoot> roots = real_roots(polynomial);
  if (roots.size() == 1) return roots.front().value;
  // Which one it is: the side of the middle.
  const Rational middle = -polynomial.linear / (2 * polynomial.square);
  const bool is_upper = Kernel().compare_1_object()(x, bound_of(middle)) == CGAL::LARGER;
  return roots[is_upper ? 1 : 0].value;
}

AlgebraicNumber number_of(const KernelNumber& x) {
  const KernelPolynomial p = x.polynomial();
  if (p.degree() <= 2) return quadratic_root(p, x);
  if (x.low() == x.high()) return rational_of_bound(x.low());
  AlgebraicNumber::Root root{
      {}, rational_of_bound(x.low()), rational_of_bound(x.high()), approximation_of(x)};
  for (auto c = p.begin(); c != p.end(); ++c) root.coefficients.emplace_back(c->mpz());
  return AlgebraicNumber(std::move(root));
}

}  // namespace

std::strong_ordering compare(const AlgebraicNumber& x, const AlgebraicNumber& y) {
  if (x.quadratic() != nullptr && y.quadratic() != nullptr) {
    return compare(*x.quadratic(), *y.quadratic());
  }
  const CertifiedDouble filter = x.approximate() - y.approximate();
  if (filter.value > filter.error) return std::strong_ordering::greater;
  if (-filter.value > filter.error) return std::strong_ordering::less;
  return static_cast<int>(Kernel().compare_1_object()(kernel_number(x), kernel_number(y))) <=> 0;
}

Enclosure enclose(const AlgebraicNumber& value, int bits) {
  if (value.quadratic() != nullptr) return enclose(*value.quadratic(), bits);
  const auto [low, high] = Kernel().approximate_absolute_1_object()(kernel_number(value), bits);
  return {rational_of_bound(low), rational_of_bound(high)};
}

Rational rational_between(const AlgebraicNumber& x, const AlgebraicNumber& y) {
  if (x.quadratic() != nullptr && y.quadratic() != nullptr) {
    return rational_between(*x.quadratic(), *y.quadratic());
  }
  for (int bits = 32;; bits *= 2) {
    const Enclosure first = enclose(x, bits);
    const Enclosure second = enclose(y, bits);
    if (first.upper < second.lower) return (first.upper + second.lower) / 2;
  }
}

std::vector<AlgebraicRoot> real_roots(std::span<const Rational> coefficients) {
  // Zeros first: no relative approximation has them.
  int zeros = 0;
  while (coefficients.front() == 0) {
    coefficients = coefficients.subspan(1);
    ++zeros;
  }
  std::vector<std::pair<KernelNumber, Kernel::Multiplicity_type>> roots;
  Kernel().solve_1_object()(polynomial_of(integral(coefficients)), std::back_inserter(roots));
  std::vector<AlgebraicRoot> result;
  for (const auto& root : roots) {
    result.push_back({number_of(root.first), static_cast<int>(root.second)});
  }
  if (zeros > 0) {
    const AlgebraicNumber zero;
    const auto next = std::find_if(result.begin(), result.end(),
                                   [&](const AlgebraicRoot& root) { return root.value > zero; });
    result.insert(next, {zero, zeros});
  }
  return result;
}

}  // namespace exactcsg
