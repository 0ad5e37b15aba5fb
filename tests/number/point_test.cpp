// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/number/point.hpp"

#include <gtest/gtest.h>

#include <random>

#include "exactcsg/support/error.hpp"
#include "number/reference.hpp"

namespace exactcsg {
namespace {

using Random = std::mt19937_64;

Rational small(Random& random) {
  Rational value(static_cast<long>(random() % 15) - 7, static_cast<long>(random() % 4) + 1);
  value.canonicalize();
  return value;
}

Point3 point(Random& random) { return {small(random), small(random), small(random)}; }

AffineMap map(Random& random) {
  AffineMap f;
  for (auto& row : f.m) {
    for (Rational& entry : row) entry = small(random);
  }
  return f;
}

AffineMap invertible(Random& random) {
  for (;;) {
    const AffineMap f = map(random);
    if (determinant(f) != 0) return f;
  }
}

TEST(AffineMap, LawMap1) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const AffineMap f = map(random);
    const AffineMap g = map(random);
    const Point3 p = point(random);
    ASSERT_EQ(apply(f * g, p), apply(f, apply(g, p)));
  }
}

TEST(AffineMap, LawMap2) {
  Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const AffineMap f = invertible(random);
    ASSERT_EQ(inverse(f) * f, AffineMap::identity());
    ASSERT_EQ(f * inverse(f), AffineMap::identity());
  }
}

TEST(AffineMap, DeterminantIsMultiplicative) {
  Random random(3);
  for (int i = 0; i < 500; ++i) {
    const AffineMap f = map(random);
    const AffineMap g = map(random);
    ASSERT_EQ(determinant(f * g), determinant(f) * determinant(g));
  }
  EXPECT_EQ(determinant(AffineMap::identity()), 1);
}

TEST(AffineMap, AppliesTheMatrixRowByRow) {
  // (x, y, z) -> (y + 1, 2 x, -z + 3), worked by hand.
  AffineMap f;
  f.m[0] = {0, 1, 0, 1};
  f.m[1] = {2, 0, 0, 0};
  f.m[2] = {0, 0, -1, 3};
  EXPECT_EQ(apply(f, Point3{5, 7, 11}), (Point3{8, 10, -8}));
  EXPECT_EQ(determinant(f), 2);
}

// LAW plane.1
TEST(Plane, HasCoprimeCoefficientsOfTheSameHalfSpace) {
  Random random(4);
  for (int i = 0; i < 1000; ++i) {
    const Rational a = small(random);
    const Rational b = small(random);
    const Rational c = small(random);
    const Rational d = small(random);
    if (a == 0 && b == 0 && c == 0) {
      EXPECT_THROW(make_plane(a, b, c, d), Error);
      continue;
    }
    const Plane plane = make_plane(a, b, c, d);
    ASSERT_EQ(gcd(gcd(plane.a, plane.b), gcd(plane.c, plane.d)), 1);
    const Rational scale = Rational(1 + static_cast<long>(random() % 50), 7);
    ASSERT_EQ(make_plane(a * scale, b * scale, c * scale, d * scale), plane);
    ASSERT_EQ(make_plane(-a, -b, -c, -d), opposite(plane));
    const Point3 p = point(random);
    ASSERT_EQ(side(plane, p), sign_of(Rational(a * p.x + b * p.y + c * p.z + d)));
  }
  // 6 x - 9/2 y + 3 = 0 by hand
  EXPECT_EQ(make_plane(6, Rational(-9, 2), 0, 3), (Plane{4, -3, 0, 2}));
}

TEST(Plane, ThroughThreePointsHasThemOnItAndFacesTheViewer) {
  Random random(5);
  for (int i = 0; i < 1000; ++i) {
    const Point3 p = point(random);
    const Point3 q = point(random);
    const Point3 r = point(random);
    const auto expected = reference::plane_through(p, q, r);
    if (reference::is_degenerate(expected)) {
      EXPECT_THROW(plane_through(p, q, r), Error);
      continue;
    }
    const Plane plane = plane_through(p, q, r);
    for (const Point3& on : {p, q, r}) ASSERT_EQ(side(plane, on), Sign::Zero);
    ASSERT_EQ(plane_through(q, r, p), plane);
    ASSERT_EQ(plane_through(p, r, q), opposite(plane));
    const Vector3 normal = cross(q - p, r - p);
    ASSERT_GT(dot(normal, Vector3{Rational(plane.a), Rational(plane.b), Rational(plane.c)}), 0);
  }
  // Counter-clockwise in the plane z = 1, seen from above: z - 1 <= 0.
  EXPECT_EQ(plane_through({0, 0, 1}, {1, 0, 1}, {0, 1, 1}), (Plane{0, 0, 1, -1}));
}

TEST(Plane, ImageOfAHalfSpaceHoldsTheImagesOfItsPoints) {
  Random random(6);
  for (int i = 0; i < 1000; ++i) {
    const AffineMap f = invertible(random);  // about half of them mirror
    const Plane plane = make_plane(1 + static_cast<long>(random() % 5), small(random),
                                   small(random), small(random));
    const Plane image = apply(f, plane);
    const Point3 p = point(random);
    ASSERT_EQ(side(image, apply(f, p)), side(plane, p));
  }
  EXPECT_THROW(apply(AffineMap{}, Plane{1, 0, 0, 0}), Error);
}

TEST(Point, IsOrderedLexicographically) {
  EXPECT_LT((Point3{0, 5, 5}), (Point3{1, 0, 0}));
  EXPECT_LT((Point3{1, 0, 5}), (Point3{1, 1, 0}));
  EXPECT_LT((Point3{1, 1, 0}), (Point3{1, 1, Rational(1, 9)}));
  EXPECT_EQ(compare(Point3{1, 2, 3}, Point3{1, 2, 3}), std::strong_ordering::equal);
  EXPECT_EQ(compare(Plane{1, 0, 0, 2}, Plane{1, 0, 0, 3}), std::strong_ordering::less);
}

}  // namespace
}  // namespace exactcsg
