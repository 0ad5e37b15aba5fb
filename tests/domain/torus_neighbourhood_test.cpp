// SPDX-License-Identifier: GPL-3.0-or-later
// Points where tori meet other surfaces. Expected values: the geometry of the torus of radii 5 and
// 2 round the z axis, and samples of a small sphere round the point.

#include <gtest/gtest.h>

#include <random>

#include "domain/surface_sets.hpp"
#include "exactcsg/domain/classify.hpp"
#include "exactcsg/domain/half_spaces.hpp"

namespace exactcsg::domain {
namespace {

using namespace test;

const Axis z_axis{{0, 0, 0}, {0, 0, 1}};
Set ring() { return set(make_torus(z_axis, 5, 2, 2)); }

TEST(TorusNeighbourhoods, ASurfaceOnItself) {
  const Point<3> on(3, 4, 2);
  const Set turned = set(make_torus({{0, 0, 0}, {0, 0, -2}}, 5, 2, 2));
  EXPECT_EQ(classify(unite(ring(), csg::complement(turned)), on), PointClass::In);
  EXPECT_EQ(classify(intersect(ring(), csg::complement(turned)), on), PointClass::Out);
  EXPECT_EQ(classify(intersect(ring(), turned), on), PointClass::On);
}

// The plane z = 2 touches the torus along the circle rho = 5.
TEST(TorusNeighbourhoods, APlaneThatTouchesAlongACircle) {
  const Point<3> on(3, 4, 2);
  const Set under = below({0, 0, 1}, 2);
  EXPECT_EQ(classify(unite(ring(), under), on), PointClass::On);
  EXPECT_EQ(classify(unite(csg::complement(ring()), under), on), PointClass::In);
  EXPECT_EQ(classify(subtract(ring(), under), on), PointClass::Out);
  EXPECT_EQ(classify(unite(ring(), csg::complement(under)), on), PointClass::On);
  EXPECT_EQ(classify(intersect(ring(), under), on), PointClass::On);
}

// x = 7 touches from outside, y = 3 cuts in a figure of eight.
TEST(TorusNeighbourhoods, PlanesThatTouchInAPoint) {
  const Set left = below({1, 0, 0}, 7);
  EXPECT_EQ(classify(subtract(ring(), left), Point<3>(7, 0, 0)), PointClass::Out);
  EXPECT_EQ(classify(unite(csg::complement(ring()), left), Point<3>(7, 0, 0)), PointClass::In);
  EXPECT_EQ(classify(unite(ring(), csg::complement(left)), Point<3>(7, 0, 0)), PointClass::On);
  const Set front = below({0, 1, 0}, 3);
  for (const Set& tree : {subtract(ring(), front), intersect(ring(), front), unite(ring(), front),
                          unite(ring(), csg::complement(front))}) {
    EXPECT_EQ(classify(tree, Point<3>(0, 3, 0)), PointClass::On);
  }
}

TEST(TorusNeighbourhoods, TipsAreDecidedAloneAndOnWhatCrossesThem) {
  const Set spindle = set(make_torus({{0, 0, 3}, {0, 0, 1}}, 4, 5, 5));  // tips at 0 and 6
  const Set again = set(make_torus({{0, 0, 3}, {0, 0, 2}}, 4, 5, 5));
  const Point<3> tip(0, 0, 0);
  EXPECT_EQ(classify(intersect(spindle, again), tip), PointClass::On);
  EXPECT_EQ(classify(unite(spindle, csg::complement(again)), tip), PointClass::In);
  // Outside the tip is the cone that points down.
  EXPECT_EQ(classify(intersect(spindle, below({0, 0, 1}, 0)), tip), PointClass::On);
  EXPECT_EQ(classify(unite(spindle, below({0, 0, 1}, 0)), tip), PointClass::In);
  EXPECT_EQ(classify(unite(spindle, below({1, 0, 0}, 0)), tip), PointClass::On);
  EXPECT_EQ(classify(intersect(spindle, set(make_sphere({0, 0, -1}, 1))), tip), PointClass::On);
  // Near the tip it is the outside of 16 rho^2 <= 9 z^2, z < 0, which this cone covers.
  EXPECT_TRUE(is_refused(unite(spindle, set(make_cone({tip, {0, 0, -1}}, 1))), tip));
  const Set horn = set(make_torus(z_axis, 1, 1, 1));
  EXPECT_TRUE(is_refused(unite(horn, below({0, 0, 1}, 0)), tip));
}

// Random sets of surfaces round the z axis through one point of the torus, with its tangent plane,
// held against points on a small sphere and in the gaps between surfaces that touch there.
TEST(TorusNeighbourhoods, RandomSetsAgreeWithSamples) {
  const Rational rho(31, 5);
  const Rational z(8, 5);
  const Point<3> on(rho, 0, z);
  const std::vector<Set> pool{
      ring(),
      set(make_cylinder(z_axis, Rational(rho * rho))),
      below({0, 0, 1}, z),
      below({3, 0, 4}, 25),  // the tangent plane
      set(make_double_cone({{0, 0, Rational(25, 4)}, {0, 0, 1}}, Rational(16, 9))),  // tangent
      set(make_torus({{0, 0, Rational(4, 5)}, {0, 0, 1}}, Rational(28, 5), 1, 1)),   // tangent
      below({0, 1, 0}, 0),
  };
  std::vector<Point<3>> samples;
  std::mt19937_64 engine(5);
  std::uniform_int_distribution<int> number(-100, 100);
  const Rational e(1, 100000);
  for (int i = 0; i < 300; ++i) {
    // Along the tangent plane, the circle's direction and the meridian's, and across.
    const Rational u = e * number(engine) / 100;
    const Rational v = i % 3 == 0 ? Rational(0) : Rational(e * number(engine) / 100);
    const Rational w = (i % 2 == 0 ? e : Rational(e * e)) * number(engine) / 100;
    // Turned by u / rho to second order, so that the circle is followed.
    const Rational angle = u / rho;
    const Rational r = rho - v * Rational(4, 5) + w * Rational(3, 5);
    const Rational scale = 1 / (1 + angle * angle);
    samples.emplace_back(Rational(r * (1 - angle * angle) * scale), Rational(r * 2 * angle * scale),
                         Rational(z + v * Rational(3, 5) + w * Rational(4, 5)));
  }
  int decided = 0;
  for (int i = 0; i < 400; ++i) {
    const auto pick = [&] {
      const Set& one = pool[static_cast<std::size_t>(number(engine) + 100) % pool.size()];
      return number(engine) < 0 ? one : csg::complement(one);
    };
    Set tree = pick();
    const int size = 1 + (number(engine) + 100) % 2;
    for (int k = 0; k < size; ++k) {
      tree = number(engine) < 0 ? unite(tree, pick()) : intersect(tree, pick());
    }
    if (tree.is_empty() || tree.is_full() || is_refused(tree, on)) continue;
    ++decided;
    bool has_in = false;
    bool has_out = false;
    for (const Point<3>& sample : samples) {
      const csg::Membership at = membership_of(
          tree, [&](const SurfaceHalfSpace& p) { return membership(classify(p, sample)); });
      has_in = has_in || at == csg::Membership::In;
      has_out = has_out || at == csg::Membership::Out;
    }
    const PointClass expected = has_in && has_out ? PointClass::On
                                : has_in          ? PointClass::In
                                                  : PointClass::Out;
    EXPECT_EQ(classify(tree, on), expected) << i;
  }
  EXPECT_GT(decided, 200);
}

TEST(TorusNeighbourhoods, SectionsOfTreesAddCrossingsUp) {
  using enum PointClass;
  const Set cut = intersect(ring(), below({0, 1, 0}, 3));
  const Section found = section(cut, whole_line<3>({0, 0, 0}, {0, 1, 0}));
  // y = -7, -3, and 3, where the plane and the torus are crossed at once; 7 of the torus alone.
  ASSERT_EQ(found.crossings.size(), 4U);
  EXPECT_EQ(found.crossings[2].multiplicity, 2);
  EXPECT_EQ(found.between, (std::vector{Out, In, Out, Out, Out}));
  EXPECT_EQ(classify(apply(AffineMap::identity(), cut), Point<3>(0, -5, 0)), In);
}

}  // namespace
}  // namespace exactcsg::domain
