// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/domain/direction_cells.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace exactcsg::domain {

namespace {

// Coefficients, ascending; none of a polynomial that is 0.
using Polynomial = std::vector<Rational>;

Polynomial trimmed(Polynomial p) {
  while (!p.empty() && p.back() == 0) p.pop_back();
  return p;
}

Polynomial product(const Polynomial& p, const Polynomial& q) {
  if (p.empty() || q.empty()) return {};
  Polynomial result(p.size() + q.size() - 1);
  for (std::size_t i = 0; i < p.size(); ++i) {
    for (std::size_t j = 0; j < q.size(); ++j) result[i + j] += p[i] * q[j];
  }
  return trimmed(std::move(result));
}

Polynomial difference(Polynomial p, const Polynomial& q) {
  if (p.size() < q.size()) p.resize(q.size());
  for (std::size_t i = 0; i < q.size(); ++i) p[i] -= q[i];
  return trimmed(std::move(p));
}

Rational value_at(const Polynomial& p, const Rational& x) {
  Rational value;
  for (std::size_t i = p.size(); i-- > 0;) value = value * x + p[i];
  return value;
}

// A form on (x, y, 1): the sum of in_y[i](x) y^i.
struct Curve {
  std::array<Polynomial, 3> in_y;

  explicit Curve(const Quadric<3>& form) {
    const auto& a = form.square();
    const auto& b = form.linear().normal;
    in_y[2] = trimmed({a[1][1]});
    in_y[1] = trimmed({Rational(2 * a[1][2] + b[1]), Rational(2 * a[0][1])});
    in_y[0] = trimmed({Rational(a[2][2] + b[2]), Rational(2 * a[0][2] + b[0]), a[0][0]});
  }

  Polynomial along_y(const Rational& x) const {
    Polynomial result;
    for (const Polynomial& p : in_y) result.push_back(value_at(p, x));
    return trimmed(std::move(result));
  }
};

// Where the number of the curve's points above x, or their order, may change: two of them meet, or
// one is at infinity, or all above x are.
Polynomial discriminant(const Curve& curve) {
  const auto& [c, b, a] = curve.in_y;
  if (a.empty()) return b.empty() ? c : b;
  return difference(product(b, b), product({4}, product(a, c)));
}

bool is_vertical(const Curve& curve) { return curve.in_y[1].empty() && curve.in_y[2].empty(); }

// Where two curves have a common point above x; 0 if they have a component in common, unless that
// is one of the vertical lines, which are changes anyway.
Polynomial resultant(const Curve& first, const Curve& second) {
  const auto minor = [&](std::size_t i, std::size_t j) {
    return difference(product(first.in_y[i], second.in_y[j]),
                      product(first.in_y[j], second.in_y[i]));
  };
  if (is_vertical(first) && is_vertical(second)) return {1};
  if (first.in_y[2].empty() && second.in_y[2].empty()) return minor(1, 0);
  const Polynomial outer = minor(2, 0);
  return difference(product(outer, outer), product(minor(2, 1), minor(1, 0)));
}

void add_roots(const Polynomial& p, std::vector<AlgebraicNumber>& roots) {
  if (p.size() < 2) return;
  for (AlgebraicRoot& root : real_roots(p)) roots.push_back(std::move(root.value));
}

}  // namespace

std::vector<Rational> rationals_between(std::vector<AlgebraicNumber> numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  if (numbers.empty()) return {Rational(0)};
  std::vector<Rational> result{Rational(enclose(numbers.front(), 1).lower - 1)};
  for (std::size_t i = 0; i + 1 < numbers.size(); ++i) {
    result.push_back(rational_between(numbers[i], numbers[i + 1]));
  }
  result.push_back(Rational(enclose(numbers.back(), 1).upper + 1));
  return result;
}

DirectionCells direction_cells(std::span<const Quadric<3>> forms) {
  DirectionCells result;
  const std::vector<Curve> curves(forms.begin(), forms.end());
  std::vector<AlgebraicNumber> critical;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    add_roots(discriminant(curves[i]), critical);
    for (std::size_t j = 0; j < i; ++j) {
      const Polynomial common = resultant(curves[i], curves[j]);
      result.complete = result.complete && !common.empty();
      add_roots(common, critical);
    }
  }
  for (const Rational& x : rationals_between(std::move(critical))) {
    std::vector<AlgebraicNumber> heights;
    for (const Curve& curve : curves) add_roots(curve.along_y(x), heights);
    for (const Rational& y : rationals_between(std::move(heights))) {
      result.directions.push_back({x, y, 1});
      result.directions.push_back({Rational(-x), Rational(-y), -1});
    }
  }
  return result;
}

}  // namespace exactcsg::domain
