// SPDX-License-Identifier: GPL-3.0-or-later
// The sums of fixed width against those of GMP, on loops of random points: none of the laws needs
// faces to be planar or boundaries to be closed.
#include "exactcsg/solid/surface_sums.hpp"

#include <gtest/gtest.h>

#include <random>

#include "exactcsg/number/digits.hpp"

namespace exactcsg {
namespace {

enum class Numbers { Short, Decimals, Long, FarAway, Tiny };

class RandomBoundary {
 public:
  explicit RandomBoundary(std::uint64_t seed) : random_(seed) {}

  Boundary operator()(Numbers numbers) {
    Boundary boundary;
    const std::uint32_t count = 3 + below(40);
    for (std::uint32_t v = 0; v < count; ++v) {
      boundary.vertices.push_back({number(numbers), number(numbers), number(numbers)});
    }
    for (std::uint32_t f = 1 + below(20); f > 0; --f) {
      BoundaryFace face;
      for (std::uint32_t l = 1 + below(3); l > 0; --l) face.loops.push_back(loop(count));
      boundary.faces.push_back(std::move(face));
    }
    // Axis-parallel, with a whole area.
    const Point3 p = boundary.vertices.front();
    const Point3 q = boundary.vertices.back();
    boundary.vertices.push_back({q.x, p.y, p.z});
    boundary.vertices.push_back({p.x, q.y, p.z});
    boundary.faces.push_back({0, {{0, count, count + 1}}});
    return boundary;
  }

 private:
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(random_() % n); }

  Integer integer(unsigned limbs) {
    Integer result;
    for (; limbs > 0; --limbs) result = (result << 64) + static_cast<unsigned long>(random_());
    return below(2) == 0 ? Integer(-result) : result;
  }
  Rational ratio(const Integer& numerator, const Integer& denominator) {
    Rational result(numerator, abs(denominator) + 1);
    result.canonicalize();
    return result;
  }
  Rational number(Numbers numbers) {
    switch (numbers) {
      case Numbers::Short:
        return ratio(integer(1) >> (20 + below(40)), 2 + below(6));
      case Numbers::Decimals:
        return ratio(integer(1), Integer(1000000007) << below(30));
      case Numbers::Long:
        return below(4) == 0 ? Rational(below(5)) : ratio(integer(6 + below(20)), integer(20));
      case Numbers::FarAway:
        return ratio(integer(13) + (Integer(1) << 1200), integer(10));
      case Numbers::Tiny:
        return ratio(integer(4), integer(30));
    }
    return 0;
  }
  std::vector<std::uint32_t> loop(std::uint32_t vertices) {
    std::vector<std::uint32_t> result;
    for (std::uint32_t n = 3 + below(below(4) == 0 ? 60 : 4); n > 0; --n) {
      result.push_back(below(vertices));
    }
    return result;
  }

  std::mt19937_64 random_;
};

constexpr std::array all_numbers{Numbers::Short, Numbers::Decimals, Numbers::Long, Numbers::FarAway,
                                 Numbers::Tiny};

TEST(ScaledVertices, HoldTheVertices) {
  RandomBoundary random(1);
  for (int round = 0; round < 100; ++round) {
    const Boundary boundary = random(all_numbers[static_cast<std::size_t>(round) % 5]);
    for (const int bits : {10, 64, 110, 300}) {
      const ScaledVertices scaled = scale_vertices(boundary, bits);
      EXPECT_LT(scaled.largest, Integer(1) << (60 * scaled.width - 2));
      std::array<Integer, 3> coordinates;
      for (std::uint32_t v = 0; v < boundary.vertices.size(); ++v) {
        set_coordinates(coordinates, scaled, v);
        for (std::size_t i = 0; i < 3; ++i) {
          EXPECT_GE(coordinates[i], 0);
          EXPECT_LE(coordinates[i], scaled.largest);  // LAW scaled.2
          const Rational e =
              (coordinate(boundary.vertices[v], i) - coordinate(scaled.origin, i)) / scaled.unit -
              coordinates[i];
          EXPECT_GE(e, 0);  // LAW scaled.1
          EXPECT_LT(e, 1);
          EXPECT_TRUE(!scaled.exact || e == 0);
        }
      }
    }
  }
}

// LAW sums.3
TEST(SurfaceSums, ShortAndLongAgree) {
  RandomBoundary random(2);
  int by_digits = 0;
  for (int round = 0; round < 300; ++round) {
    const Boundary boundary = random(all_numbers[static_cast<std::size_t>(round) % 5]);
    for (const int bits : {20, 50, 57, 58, 60, 100, 116}) {
      const ScaledVertices vertices = scale_vertices(boundary, bits);
      const SurfaceSums expected =
          long_surface_sums(boundary, vertices, Wanted::Everything, bits + 20);
      for (const Wanted wanted : {Wanted::Everything, Wanted::VolumeAndArea}) {
        const auto sums = short_surface_sums(boundary, vertices, wanted, bits);
        EXPECT_EQ(sums.has_value(), vertices.width <= 2);
        if (!sums) continue;
        ++by_digits;
        EXPECT_EQ(sums->six_volumes.value, expected.six_volumes.value);
        EXPECT_EQ(sums->six_volumes.error, expected.six_volumes.error);
        for (std::size_t i = 0; wanted == Wanted::Everything && i < 3; ++i) {
          EXPECT_EQ(sums->moments[i].value, expected.moments[i].value);
          EXPECT_EQ(sums->moments[i].error, expected.moments[i].error);
        }
        const auto rational = [](const Integer& value, mp_bitcnt_t shift) {
          Rational result(value);
          mpq_div_2exp(result.get_mpq_t(), result.get_mpq_t(), shift);
          return result;
        };
        const Rational area = rational(sums->two_areas.value, sums->area_shift);
        const Rational difference =
            abs(area - rational(expected.two_areas.value, expected.area_shift));
        // Both are within the bits asked for of the area, or of one largest coordinate a face.
        const Rational unit = rational(1, static_cast<mp_bitcnt_t>(bits));
        const Rational faces(static_cast<unsigned long>(boundary.faces.size()));
        EXPECT_LE(difference, (area + faces * vertices.largest) * unit + faces);
        EXPECT_LE(difference, (area + faces) * rational(1, 115) +
                                  rational(expected.two_areas.error, expected.area_shift));
      }
    }
  }
  EXPECT_GT(by_digits, 2000);
}

// The doubled area of the triangle (1, 0, 0), (0, b, 0), (0, 0, c) is the root of
// b^2 + c^2 + b^2 c^2: 7 for b = 2, c = 3 (also scaled by 2^1 ... 2^110), and no integer for
// b = 1, c = 1: the root of 3, here enclosed to nearly 120 bits.
TEST(SurfaceSums, RootsThatAreWholeAreExact) {
  const auto sums_of = [](const Integer& scale, long b, long c) {
    Boundary boundary;
    boundary.vertices = {{scale, 0, 0}, {0, scale * b, 0}, {0, 0, scale * c}};
    boundary.faces = {{0, {{0, 1, 2}}}};
    return *short_surface_sums(boundary, scale_vertices(boundary, 100), Wanted::VolumeAndArea, 100);
  };
  for (unsigned shift = 0; shift <= 110; ++shift) {
    const Integer scale = Integer(1) << shift;
    const SurfaceSums whole = sums_of(scale, 2, 3);
    EXPECT_EQ(whole.two_areas.value, 7 * scale * scale << whole.area_shift);
    EXPECT_EQ(whole.two_areas.error, 0);
    const SurfaceSums cut = sums_of(scale, 1, 1);
    const Integer three = 3 * scale * scale * scale * scale << 2 * cut.area_shift;
    const Integer lower = cut.two_areas.value - cut.two_areas.error;
    const Integer upper = cut.two_areas.value + cut.two_areas.error;
    EXPECT_LT(lower * lower, three);
    EXPECT_GT(upper * upper, three);
    EXPECT_LT(cut.two_areas.error << 120, cut.two_areas.value);
  }
}

TEST(Digits, AgreeWithIntegers) {
  std::mt19937_64 random(3);
  for (int round = 0; round < 1000; ++round) {
    const std::array<mp_limb_t, 3> limbs{random(), random(), random() >> (12 + random() % 50)};
    Integer value;
    for (std::size_t i = 3; i > 0; --i) value = (value << 64) + Integer(limbs[i - 1]);
    const Digits<3> digits = digits_of_limbs<3>(limbs.data());
    DigitColumns<5> columns;
    add(columns, digits);
    EXPECT_EQ(integer_of(columns), value);
    add_product(columns, digits, digits);
    EXPECT_EQ(integer_of(columns), value + value * value);
    carry(columns);
    EXPECT_EQ(integer_of(columns), value + value * value);
    DigitColumns<3> negative;
    for (std::size_t i = 0; i < 3; ++i) negative.column[i] = -static_cast<Int128>(digits.digit[i]);
    EXPECT_EQ(integer_of(negative), -value);
    const Digits<4> carried = digits_of<4>(negative);
    DigitColumns<4> again;
    add(again, carried);
    EXPECT_EQ(integer_of(again), -value);
    EXPECT_LE(carried.digit[3], 0);
    DigitColumns<4> positive;
    add(positive, magnitude(carried));
    EXPECT_EQ(integer_of(positive), value);
  }
}

}  // namespace
}  // namespace exactcsg
