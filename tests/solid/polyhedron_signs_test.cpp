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

// Whether a determinant of the differences may be nearly zero without being so.
enum class Degeneracy { Any, Exact };

void compare_with_rationals(const std::function<Rational(int)>& number, Random& random,
                            Degeneracy degeneracy = Degeneracy::Any) {
  std::uniform_int_distribution<int> small(-3, 3);
  std::vector<Point3> points;
  for (int i = 0; i < 40; ++i) {
    points.push_back({number(small(random)), number(small(random)), number(small(random))});
  }
  const PolyhedronSigns signs(points);
  std::uniform_int_distribution<std::uint32_t> any(0, 39);
  int zeros = 0;
  int uncertain = 0;
  for (int round = 0; round < 1000; ++round) {
    const std::uint32_t a = any(random), b = any(random), c = any(random), p = any(random),
                        q = any(random);
    const Vector3 u = points[b] - points[a];
    const Vector3 v = points[c] - points[a];
    const Sign side = volume_sign(u, v, points[p] - points[a]);
    zeros += side == Sign::Zero ? 1 : 0;
    ASSERT_EQ(signs.orientation(a, b, c, p), side);
    const Sign certain = signs.certain_side(signs.near_plane(a, b, c), p);
    if (certain == Sign::Zero) {
      ++uncertain;
    } else {
      ASSERT_EQ(certain, side);
    }
    ASSERT_EQ(signs.along_normal(a, b, c, p, q), volume_sign(u, v, points[q] - points[p]));
    ASSERT_EQ(signs.collinear(a, b, c), cross(u, v) == Vector3{});
    for (CoordinateIndex k = 0; k < 3; ++k) {
      ASSERT_EQ(signs.turn(k, a, b, c), sign_of(coordinate(cross(u, v), k)));
      ASSERT_EQ(signs.compare(k, a, b), sign_of(coordinate(u, k)));
    }
  }
  EXPECT_GT(zeros, 70);
  // What doubles tell apart at all, they tell.
  if (degeneracy == Degeneracy::Exact) {
    EXPECT_EQ(uncertain, zeros);
  }
}

TEST(PolyhedronSigns, EqualRationalArithmetic) {
  Random random(1);
  compare_with_rationals([](int n) { return Rational(n); }, random, Degeneracy::Exact);
  compare_with_rationals([](int n) { return ratio(n, 7); }, random, Degeneracy::Exact);
  compare_with_rationals([](int n) { return Rational(n * power_of_two(36)); }, random,
                         Degeneracy::Exact);
  compare_with_rationals([](int n) { return Rational(ratio(n, 7) * power_of_two(-300)); }, random);
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

// Means of points, whether these are machine integers or not.
TEST(PolyhedronSigns, OfMeansEqualRationalArithmetic) {
  Random random(3);
  const std::vector<std::function<Rational(int)>> numbers{
      [](int n) { return ratio(n, 7); }, [](int n) { return rational_of(std::sin(n)); },
      [](int n) { return Rational(n + power_of_two(-100)); }};
  for (const auto& number : numbers) {
    std::uniform_int_distribution<int> small(-3, 3);
    std::vector<Point3> points;
    for (int i = 0; i < 12; ++i) {
      points.push_back({number(small(random)), number(small(random)), number(small(random))});
    }
    PolyhedronSigns signs(points);
    std::uniform_int_distribution<std::uint32_t> given(0, 11);
    for (int i = 0; i < 12; ++i) {
      const std::array<std::pair<std::uint32_t, unsigned>, 3> weighted{
          {{given(random), 1 + random() % 3}, {given(random), 2}, {given(random), 5}}};
      const std::uint32_t mean = signs.add_mean(weighted);
      ASSERT_EQ(mean, points.size());
      Vector3 sum{0, 0, 0};
      Rational total = 0;
      for (const auto& [index, weight] : weighted) {
        const Point3& p = points[index];
        sum = {sum.x + weight * p.x, sum.y + weight * p.y, sum.z + weight * p.z};
        total += weight;
      }
      points.push_back({sum.x / total, sum.y / total, sum.z / total});
    }
    std::uniform_int_distribution<std::uint32_t> any(0, 23);
    for (int round = 0; round < 1000; ++round) {
      const std::uint32_t a = any(random), b = any(random), c = any(random), d = any(random);
      const Vector3 u = points[b] - points[a];
      const Vector3 v = points[c] - points[a];
      ASSERT_EQ(signs.orientation(a, b, c, d), volume_sign(u, v, points[d] - points[a]));
      for (CoordinateIndex k = 0; k < 3; ++k) {
        ASSERT_EQ(signs.turn(k, a, b, c), sign_of(coordinate(cross(u, v), k)));
        ASSERT_EQ(signs.compare(k, a, b), sign_of(coordinate(u, k)));
      }
    }
  }
}

// Of a tetrahedron: the sign of the determinant of three of its edges.
TEST(PolyhedronSigns, OfVolumesEqualRationalArithmetic) {
  Random random(4);
  const std::vector<std::array<std::uint32_t, 3>> surface{
      {0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  int zeros = 0;
  for (int round = 0; round < 300; ++round) {
    // With and without machine integers.
    const Integer denominator = round % 2 == 0 ? Integer(7) : Integer((Integer(1) << 100) - 1);
    std::vector<Point3> points;
    const auto number = [&] { return ratio(static_cast<int>(random() % 5) - 2, denominator); };
    for (int i = 0; i < 4; ++i) points.push_back({number(), number(), number()});
    const Sign expected =
        volume_sign(points[1] - points[0], points[2] - points[0], points[3] - points[0]);
    zeros += expected == Sign::Zero ? 1 : 0;
    ASSERT_EQ(PolyhedronSigns(points).volume(surface), expected);
  }
  EXPECT_GT(zeros, 20);
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
