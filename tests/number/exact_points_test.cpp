// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/number/exact_points.hpp"

#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "exactcsg/support/sanitizer.hpp"

namespace exactcsg {
namespace {

Integer power(unsigned long base, unsigned long exponent) {
  Integer result;
  mpz_ui_pow_ui(result.get_mpz_t(), base, exponent);
  return result;
}

Rational fraction(const Integer& numerator, const Integer& denominator) {
  Rational result(numerator, denominator);
  result.canonicalize();
  return result;
}

// Numbers of every form that a record has: zero, integers, denominators that are powers of two or
// not, of less and of more limbs than a short header can tell, and those next to such limits.
std::vector<Rational> numbers_of_all_kinds() {
  std::vector<Rational> numbers{0, 1, 2, 7, {1, 2}, {3, 8}, {1, 3}, {22, 7}, {4, 6}};
  for (const unsigned long bits : {52UL, 63UL, 64UL, 65UL, 127UL, 128UL, 1023UL, 1024UL, 5000UL,
                                   511 * 64UL, 512 * 64UL, 1023 * 64UL, 1024 * 64UL, 1100 * 64UL}) {
    const Integer two = power(2, bits);
    const Integer odd = two + 1;
    const Integer three = power(3, bits);
    for (const Rational& number :
         {Rational(two), Rational(odd), fraction(1, two), fraction(odd, power(2, bits / 2)),
          fraction(two, odd), fraction(odd, two - 1), fraction(two, three), fraction(5, two * 3)}) {
      numbers.push_back(number);
    }
  }
  const std::size_t positive = numbers.size();
  for (std::size_t i = 0; i < positive; ++i) numbers.push_back(-numbers[i]);
  return numbers;
}

Rational random_number(std::mt19937_64& random) {
  Integer numerator = power(static_cast<unsigned long>(random() % 1000 + 2), random() % 40);
  numerator += static_cast<unsigned long>(random());
  if (random() % 2 == 0) numerator = -numerator;
  switch (random() % 4) {
    case 0:
      return Rational(numerator);
    case 1:
      return fraction(numerator, power(2, random() % 200));
    case 2:
      return fraction(numerator, power(10, random() % 30));
    default:
      return fraction(numerator, power(static_cast<unsigned long>(random() | 1U), random() % 20));
  }
}

std::vector<Point3> random_points(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Point3> points;
  for (std::size_t i = 0; i < count; ++i) {
    points.push_back({random_number(random), random_number(random), random_number(random)});
  }
  return points;
}

// LAW points.1
void expect_points(const ExactPoints& found, const std::vector<Point3>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_EQ(found[i], expected[i]) << i;
    ASSERT_EQ(point_of(found.view(i)), expected[i]) << i;
  }
  EXPECT_TRUE(std::equal(found.begin(), found.end(), expected.begin(), expected.end()));
  EXPECT_EQ(to_vector(found), expected);
}

TEST(RationalView, IsTheNumber) {
  for (const Rational& number : numbers_of_all_kinds()) {
    const RationalView view = view_of(number);
    EXPECT_EQ(rational_of(view), number);
    EXPECT_EQ(view.is_zero(), number == 0);
    EXPECT_EQ(view.has_binary_denominator(), mpz_popcount(number.get_den_mpz_t()) == 1);
    EXPECT_EQ(denominator_bits(view), mpz_sizeinbase(number.get_den_mpz_t(), 2));
    Integer denominator;
    set_denominator(denominator, view);
    EXPECT_EQ(denominator, number.get_den());
    Rational assigned(-17, 5);
    assign(assigned, view);
    EXPECT_EQ(assigned, number);
  }
}

// LAW view.2, by GMP's comparison.
void expect_compared(const Rational& a, const Rational& b) {
  const RationalView p = view_of(a);
  const RationalView q = view_of(b);
  EXPECT_EQ(compare(p, q), cmp(a, b) <=> 0) << a << " and " << b;
  EXPECT_EQ(compare(q, p), cmp(b, a) <=> 0) << b << " and " << a;
  EXPECT_EQ(equal(p, q), a == b) << a << " and " << b;
  EXPECT_EQ(equal_denominators(p, q), a.get_den() == b.get_den()) << a << " and " << b;
}

TEST(RationalView, ComparesLikeRationals) {
  std::vector<Rational> numbers = numbers_of_all_kinds();
  std::erase_if(numbers, [](const Rational& number) {
    return std::max(mpz_size(number.get_num_mpz_t()), mpz_size(number.get_den_mpz_t())) > 100;
  });
  std::mt19937_64 random(11);
  for (int i = 0; i < 200; ++i) numbers.push_back(random_number(random));
  for (const Rational& a : numbers) {
    for (const Rational& b : numbers) expect_compared(a, b);
  }
}

// Neighbours that agree in more bits than heads have, also where one is a power of two, so that
// what was cut off decides in which binade a product lies.
TEST(RationalView, ComparesNumbersThatNearlyAgree) {
  for (const unsigned long bits : {20UL, 60UL, 64UL, 66UL, 70UL, 128UL, 200UL, 700UL}) {
    const Rational tiny = fraction(1, power(2, bits));
    const Rational tiny_third = fraction(1, power(3, bits));
    for (const Rational& number :
         {Rational(1), Rational(2), Rational(1, 3), Rational(power(2, 300)), Rational(5, 7),
          fraction(power(7, 90), power(3, 100)), fraction(1, power(2, 300))}) {
      for (const Rational& step : {tiny, tiny_third}) {
        const Rational above = number * (1 + step);
        const Rational below = number * (1 - step);
        expect_compared(number, above);
        expect_compared(number, below);
        expect_compared(below, above);
        expect_compared(-number, -above);
        expect_compared(-below, -above);
      }
    }
  }
}

TEST(RationalView, ComparesPointsLexicographically) {
  const std::vector<Rational> values{-1, {1, 3}, 2};
  std::vector<Point3> points;
  for (const Rational& x : values) {
    for (const Rational& y : values) {
      for (const Rational& z : values) points.push_back({x, y, z});
    }
  }
  for (const Point3& p : points) {
    for (const Point3& q : points) EXPECT_EQ(compare(view_of(p), view_of(q)), compare(p, q));
  }
}

TEST(ExactPoints, AreThePointsThatWereAppended) {
  expect_points({}, {});
  const std::vector<Rational> numbers = numbers_of_all_kinds();
  std::vector<Point3> points;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto number = [&](std::size_t k) { return numbers[k % numbers.size()]; };
    points.push_back({number(i), number(7 * i + 1), number(11 * i + 2)});
    points.push_back({number(i), number(i), number(i)});
  }
  expect_points(ExactPoints(points), points);
  const std::vector<Point3> many = random_points(20000, 1);
  const ExactPoints found(many);
  expect_points(found, many);
  EXPECT_EQ(found.front(), many.front());
  EXPECT_EQ(found.back(), many.back());
}

// LAW points.2
TEST(ExactPoints, AreEqualIffAllPointsAre) {
  const std::vector<Point3> points = random_points(300, 2);
  const ExactPoints reference(points);
  EXPECT_EQ(ExactPoints(points), reference);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (const Rational& change : {fraction(1, power(2, 80)), fraction(1, power(3, 80))}) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        std::vector<Point3> others = points;
        Point3& p = others[i];
        (axis == 0 ? p.x : axis == 1 ? p.y : p.z) += change;
        EXPECT_FALSE(ExactPoints(others) == reference);
      }
    }
  }
  std::vector<Point3> fewer = points;
  fewer.pop_back();
  EXPECT_FALSE(ExactPoints(fewer) == reference);
  EXPECT_FALSE(reference == ExactPoints(fewer));
  // Of long headers, and of a prefix of the other's limbs.
  const Integer longest = power(2, 64 * 600) - 1;
  const ExactPoints one{{Rational(longest), 0, 0}};
  EXPECT_EQ(one, (ExactPoints{{Rational(longest), 0, 0}}));
  EXPECT_FALSE(one == (ExactPoints{{Rational(longest), 0, Rational(longest)}}));
  EXPECT_FALSE(one == (ExactPoints{{Rational(-longest), 0, 0}}));
}

TEST(ExactPoints, AreConcatenated) {
  const std::vector<Point3> points = random_points(5000, 3);
  ExactPoints all;
  std::vector<Point3> expected;
  std::mt19937_64 random(4);
  for (std::size_t begin = 0; begin < points.size();) {
    const std::size_t end = std::min<std::size_t>(begin + random() % 400, points.size());
    const auto some = std::span<const Point3>(points).subspan(begin, end - begin);
    ExactPoints part(some);
    all.append(std::move(part));
    expected.insert(expected.end(), points.begin() + static_cast<std::ptrdiff_t>(begin),
                    points.begin() + static_cast<std::ptrdiff_t>(end));
    // What is moved from may be used again, and what was appended to goes on.
    part = ExactPoints{{1, 2, 3}};
    expect_points(part, {{1, 2, 3}});
    all.push_back({static_cast<long>(end), {1, 3}, -1});
    expected.push_back({static_cast<long>(end), {1, 3}, -1});
    begin = end;
  }
  expect_points(all, expected);
}

TEST(ExactPoints, CopiesDoNotChangeWithEachOther) {
  std::vector<Point3> points = random_points(100, 5);
  ExactPoints original(points);
  ExactPoints copy = original;
  std::vector<Point3> of_copy = points;
  for (const Point3& p : random_points(200, 6)) {
    original.push_back(p);
    points.push_back(p);
    copy.push_back({p.z, p.y, p.x});
    of_copy.push_back({p.z, p.y, p.x});
  }
  expect_points(original, points);
  expect_points(copy, of_copy);
  ExactPoints moved = std::move(original);
  expect_points(moved, points);
  moved = {};
  expect_points(moved, {});
  expect_points(copy, of_copy);  // the blocks it shared are still there
}

TEST(ExactPoints, AreReordered) {
  const std::vector<Point3> points = random_points(1000, 7);
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0U);
  std::shuffle(order.begin(), order.end(), std::mt19937_64(8));
  ExactPoints found(points);
  found.reorder(order);
  std::vector<Point3> expected;
  for (const std::uint32_t i : order) expected.push_back(points[i]);
  expect_points(found, expected);
}

// By what the heap says: 16 bytes a point, and 8 for each of its limbs.
TEST(ExactPoints, TakeLittleMemory) {
  if (has_shadow_memory) GTEST_SKIP() << "the heap is the sanitizer's";
  const auto in_use = [] {
    const struct mallinfo2 info = mallinfo2();
    return info.uordblks + info.hblkhd;
  };
  constexpr std::size_t count = 1000000;
  const Rational eighth(1, 8);
  const std::size_t before = in_use();
  ExactPoints points;
  points.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto n = static_cast<long>(i) + 1;
    points.push_back({n, n + eighth, -n - eighth});
  }
  const std::size_t taken = in_use() - before;
  EXPECT_GE(taken, count * (16 + 3 * 8));  // the heap tells of them
  EXPECT_LE(taken, count * (16 + 3 * 8) * 101 / 100);
  EXPECT_EQ(points[count - 1], (Point3{1000000, 1000000 + eighth, -1000000 - eighth}));
}

}  // namespace
}  // namespace exactcsg
