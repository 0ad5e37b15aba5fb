// SPDX-License-Identifier: GPL-3.0-or-later
// The evaluator against closed forms.
#include "exactcsg/solid/evaluate.hpp"

#include <gtest/gtest.h>

#include "exactcsg/solid/classify.hpp"
#include "exactcsg/solid/measures.hpp"

namespace exactcsg {
namespace {

Solid box(const Rational& x0, const Rational& y0, const Rational& z0, const Rational& x1,
          const Rational& y1, const Rational& z1) {
  return Solid::primitive({make_box({x0, y0, z0}, {x1, y1, z1})});
}

Rational volume(const Boundary& boundary) {
  // The divergence theorem by fans of every loop: what the evaluator gives, summed independently of
  // measures.cpp.
  Rational six(0);
  for (const BoundaryFace& face : boundary.faces) {
    for (const auto& loop : face.loops) {
      for (std::size_t i = 2; i < loop.size(); ++i) {
        const Point3& a = boundary.vertices[loop[0]];
        const Point3& b = boundary.vertices[loop[i - 1]];
        const Point3& c = boundary.vertices[loop[i]];
        const Point3 origin{0, 0, 0};
        six += dot(cross(a - origin, b - origin), c - origin);
      }
    }
  }
  return six / 6;
}

TEST(Evaluate, BoxIsItself) {
  const Boundary b = evaluate(box(0, 0, 0, 1, 2, 3));
  EXPECT_EQ(b.vertices.size(), 8U);
  EXPECT_EQ(b.edges.size(), 12U);
  EXPECT_EQ(b.faces.size(), 6U);
  EXPECT_EQ(volume(b), 6);
}

TEST(Evaluate, CornerOverlap) {
  const Solid a = box(0, 0, 0, 2, 2, 2);
  const Solid b = box(1, 1, 1, 3, 3, 3);
  EXPECT_EQ(volume(evaluate(csg::unite(a, b))), 15);     // 8 + 8 - 1
  EXPECT_EQ(volume(evaluate(csg::intersect(a, b))), 1);  // unit cube
  EXPECT_EQ(volume(evaluate(csg::subtract(a, b))), 7);   // 8 - 1
}

TEST(Evaluate, FlushFacesVanish) {
  const Solid a = box(0, 0, 0, 1, 1, 1);
  const Solid b = box(1, 0, 0, 2, 1, 1);
  const Boundary u = evaluate(csg::unite(a, b));
  EXPECT_EQ(u.vertices.size(), 8U);
  EXPECT_EQ(u.edges.size(), 12U);
  EXPECT_EQ(u.faces.size(), 6U);
  EXPECT_TRUE(evaluate(csg::intersect(a, b)).empty());
  EXPECT_TRUE(evaluate(csg::subtract(a, a)).empty());
}

TEST(Evaluate, ThroughHoleHasRings) {
  const Boundary b = evaluate(csg::subtract(box(0, 0, 0, 3, 3, 1), box(1, 1, -1, 2, 2, 2)));
  EXPECT_EQ(volume(b), 8);
  EXPECT_EQ(b.vertices.size(), 16U);
  EXPECT_EQ(b.edges.size(), 24U);
  EXPECT_EQ(b.faces.size(), 10U);
}

// Holes along z of every square of a level's carpet; the sponge is the cube less all holes along
// all three axes.
void carpet(int level, const Rational& u, const Rational& v, const Rational& size,
            std::vector<std::array<Rational, 3>>& squares) {
  if (level == 0) return;
  const Rational third = size / 3;
  squares.push_back({u + third, v + third, third});
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (i == 1 && j == 1) continue;
      carpet(level - 1, u + i * third, v + j * third, third, squares);
    }
  }
}

Solid sponge(int level) {
  std::vector<std::array<Rational, 3>> squares;
  carpet(level, 0, 0, 1, squares);
  std::vector<Solid> parts{box(0, 0, 0, 1, 1, 1)};
  for (const auto& [u, v, s] : squares) {
    parts.push_back(box(u, v, -1, u + s, v + s, 2));
    parts.push_back(box(u, -1, v, u + s, 2, v + s));
    parts.push_back(box(-1, u, v, 2, u + s, v + s));
  }
  return Solid::compose(csg::BooleanOperator::Difference, std::move(parts));
}

TEST(Evaluate, MengerSpongeHasKnownVolume) {
  Rational expected(1);
  for (int level = 1; level <= 3; ++level) {
    expected *= Rational(20, 27);
    const Boundary b = evaluate(sponge(level));
    EXPECT_EQ(volume(b), expected) << level;
  }
}

TEST(Evaluate, TurnedCubes) {
  // GOLDEN: the unit cube and its 3-4-5 turn about z meet in 5/6 (2 / (1 + cos + sin)).
  const Rational h(1, 2);
  const Solid a = box(-h, -h, -h, h, h, h);
  AffineMap turn = AffineMap::identity();
  turn.m[0] = {Rational(3, 5), Rational(-4, 5), 0, 0};
  turn.m[1] = {Rational(4, 5), Rational(3, 5), 0, 0};
  const Solid b = apply(turn, a);
  EXPECT_EQ(volume(evaluate(csg::intersect(a, b))), Rational(5, 6));
  EXPECT_EQ(volume(evaluate(csg::unite(a, b))), Rational(7, 6));
  EXPECT_EQ(volume(evaluate(csg::subtract(a, b))), Rational(1, 6));
}

TEST(Evaluate, HalfSpacesMakeABoundedSolid) {
  std::vector<Solid> parts;
  for (const auto& [a, b, c, d] : std::vector<std::array<int, 4>>{{1, 0, 0, -1},
                                                                  {-1, 0, 0, 0},
                                                                  {0, 1, 0, -1},
                                                                  {0, -1, 0, 0},
                                                                  {0, 0, 1, -1},
                                                                  {0, 0, -1, 0}}) {
    parts.push_back(Solid::primitive({make_half_space(a, b, c, d)}));
  }
  const Solid cube = Solid::compose(csg::BooleanOperator::Intersection, parts);
  const Boundary b = evaluate(cube);
  EXPECT_EQ(volume(b), 1);
  EXPECT_EQ(b.vertices.size(), 8U);
  EXPECT_EQ(b.edges.size(), 12U);
  EXPECT_EQ(b.faces.size(), 6U);
  parts.pop_back();
  EXPECT_THROW(evaluate(Solid::compose(csg::BooleanOperator::Intersection, parts)), Error);
  EXPECT_THROW(evaluate(Solid::full()), Error);
  EXPECT_TRUE(evaluate(Solid::empty()).empty());
}

}  // namespace
}  // namespace exactcsg
