// SPDX-License-Identifier: GPL-3.0-or-later
// Expected: the same points sorted as rationals, each rounded alone.
#include "exactcsg/solid/ordered_vertices.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "exactcsg/number/exact.hpp"

namespace exactcsg {
namespace {

// Among them points that are different and have the same nearest doubles.
std::vector<Point3> shuffled_points() {
  const Rational third(1, 3);
  const Rational hair(1, (Integer(1) << 80U));
  const std::array<Rational, 5> values{Rational(-2), Rational(0), Rational(third - hair), third,
                                       Rational(third + hair)};
  std::vector<Point3> points;
  for (const Rational& x : values) {
    for (const Rational& y : values) {
      for (const Rational& z : values) points.push_back({x, y, z});
    }
  }
  for (int i = 0; i < 5000; ++i) points.push_back({Rational(i % 7), Rational(i), third});
  std::shuffle(points.begin(), points.end(), std::mt19937(5));
  return points;
}

// LAW order.1, LAW order.2
TEST(OrderedVertices, AreThoseThatAreWantedInLexicographicOrder) {
  const std::vector<Point3> points = shuffled_points();
  Geometry::Builder builder;
  std::vector<PointId> ids;
  for (const Point3& point : points) ids.push_back(builder.add_point(point));
  const Geometry geometry = std::move(builder).build();
  VertexRow vertices(geometry);
  std::vector<unsigned char> is_wanted;
  std::vector<Point3> expected;
  for (std::size_t i = 0; i < points.size(); ++i) {
    vertices.push_back(geometry.vertex(ids[i]));
    is_wanted.push_back(i % 3 == 0 ? 0 : 1);
    if (is_wanted[i]) expected.push_back(points[i]);
  }
  std::sort(expected.begin(), expected.end());
  for (const unsigned threads : {1U, 3U}) {
    const OrderedVertices result = ordered_vertices(geometry, vertices, is_wanted, threads);
    ASSERT_EQ(to_vector(result.exact), expected);
    ASSERT_EQ(result.nearest.size(), expected.size());
    ASSERT_EQ(result.number.size(), vertices.size());
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      const std::uint32_t number = result.number[v];
      if (!is_wanted[v]) {
        EXPECT_EQ(number, OrderedVertices::none);
        continue;
      }
      ASSERT_LT(number, expected.size());
      EXPECT_EQ(expected[number], points[v]);
      EXPECT_EQ(result.nearest[number][0], nearest_double(points[v].x));
      EXPECT_EQ(result.nearest[number][1], nearest_double(points[v].y));
      EXPECT_EQ(result.nearest[number][2], nearest_double(points[v].z));
    }
  }
}

}  // namespace
}  // namespace exactcsg
