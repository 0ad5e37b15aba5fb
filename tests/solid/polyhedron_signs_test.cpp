// SPDX-License-Identifier: GPL-3.0-or-later
// Every tier of PolyhedronSigns against pure rational arithmetic, on points of few coordinates, so
// that a large part of all questions is degenerate.
#include "exactcsg/solid/polyhedron_signs.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

namespace exactcsg {
namespace {

using Random = std::mt19937_64;

Rational ratio(const Integer& numerator, const Integer& denominator) {
  Rational value(numerator, denominator);
  value.canonicalize();
  return value;
}

Rational power_of_two(int exponent) {
  const Integer power = Integer(1) << static_cast<mp_bitcnt_t>(std::abs(exponent));
  return exponent < 0 ? ratio(1, power) : Rational(power);
}

Sign volume_sign(const Vector3& u, const Vector3& v, const Vector3& w) {
  return sign_of(dot(cross(u, v), w));
}

void compare_with_rationals(const std::function<Rational(int)>& number, Random& random) {
  std::uniform_int_distribution<int> small(-3, 3);
  std::vector<Point3> points;
  for (int i = 0; i < 40; ++i) {
    points.push_back({number(small(random)), number(small(random)), number(small(random))});
  }
  const PolyhedronSigns signs(points);
  std::uniform_int_distribution<std::uint32_t> any(0, 39);
  int zeros = 0;
  for (int round = 0; round < 1000; ++round) {
    const std::uint32_t a = any(random), b = any(random), c = any(random), p = any(random),
                        q = any(random);
    const Vector3 u = points[b] - points[a];
    const Vector3 v = points[c] - points[a];
    const Sign side = volume_sign(u, v, points[p] - points[a]);
    zeros += side == Sign::Zero ? 1 : 0;
    ASSERT_EQ(signs.orientation(a, b, c, p), side);
    ASSERT_EQ(signs.along_normal(a, b, c, p, q), volume_sign(u, v, points[q] - points[p]));
    ASSERT_EQ(signs.collinear(a, b, c), cross(u, v) == Vector3{});
    for (CoordinateIndex k = 0; k < 3; ++k) {
      ASSERT_EQ(signs.turn(k, a, b, c), sign_of(coordinate(cross(u, v), k)));
      ASSERT_EQ(signs.compare(k, a, b), sign_of(coordinate(u, k)));
    }
  }
  EXPECT_GT(zeros, 70);
}

TEST(PolyhedronSigns, EqualRationalArithmetic) {
  Random random(1);
  compare_with_rationals([](int n) { return Rational(n); }, random);
  // Doubles of 53 bits, thirds of them, and what is just above: integers of the stack.
  compare_with_rationals([](int n) { return rational_of(std::sin(n)); }, random);
  compare_with_rationals([](int n) { return rational_of(std::sin(n)) / 3; }, random);
  compare_with_rationals([&](int n) { return Rational(n + (random() % 2) * power_of_two(-200)); },
                         random);
  // Beyond the integers on the stack.
  compare_with_rationals([&](int n) { return Rational(n + (random() % 2) * power_of_two(-500)); },
                         random);
  compare_with_rationals([&](int n) { return Rational(n * power_of_two(4000) + ratio(n, 7)); },
                         random);
}

TEST(PolyhedronSigns, EqualRationalArithmeticWithoutCommonDenominator) {
  Random random(2);
  const auto mersenne = [](int n) {
    Integer p = 1;
    p <<= static_cast<mp_bitcnt_t>(100 + 31 * (n + 4));
    return ratio(p - 2, p - 1);
  };
  compare_with_rationals(mersenne, random);
  compare_with_rationals([&](int n) { return Rational(mersenne(n) * power_of_two(2000)); }, random);
}

}  // namespace
}  // namespace exactcsg
