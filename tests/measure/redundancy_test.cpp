// SPDX-License-Identifier: GPL-3.0-or-later
// Half-spaces that others make irrelevant. Expected values: the geometry, said at each case; random
// trees against their own classification.

#include "exactcsg/measure/redundancy.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cstdint>

#include "exactcsg/domain/classify.hpp"
#include "measure/curved_tori.hpp"
#include "measure/random_solids.hpp"

namespace exactcsg::measure::test {
namespace {

using csg::intersect;
using csg::subtract;
using csg::unite;

const Box<3> box = cube(2);

TEST(Redundancy, ABallInABall) {
  const Solid3 large = ball({}, 1);
  const Solid3 small = ball(point(Rational(1, 4), 0, 0), Rational(1, 4));
  EXPECT_TRUE(without_redundant(unite(large, small), box) == large);
  EXPECT_TRUE(without_redundant(unite(small, large), box) == large);
  EXPECT_TRUE(without_redundant(intersect(large, small), box) == small);
  EXPECT_TRUE(without_redundant(subtract(small, large), box).is_empty());
  EXPECT_EQ(without_redundant(subtract(large, small), box).primitive_count(), 2U);
}

// The ball is in neither half-ball alone, and in both together.
TEST(Redundancy, WhatSeveralCoverTogether) {
  const Solid3 halves = unite(intersect(ball({}, 1), below({1, 0, 0}, Rational(1, 8))),
                              intersect(ball({}, 1), below({-1, 0, 0}, 0)));
  const Solid3 left = without_redundant(halves, box);
  EXPECT_TRUE(left == ball({}, 1));
  const Solid3 small = ball({}, Rational(1, 4));
  EXPECT_TRUE(without_redundant(unite(small, halves), box) == ball({}, 1));
}

// Redundant in the one box, needed in the other.
TEST(Redundancy, IsLocal) {
  const Solid3 lens = intersect(ball({}, 1), ball(point(1, 0, 0), 1));
  const Box<3> at_the_left(point(0, Rational(-1, 2), Rational(-1, 2)),
                           point(Rational(3, 8), Rational(1, 2), Rational(1, 2)));
  EXPECT_TRUE(without_redundant(lens, at_the_left) == ball(point(1, 0, 0), 1));
  EXPECT_EQ(without_redundant(lens, box).primitive_count(), 2U);
}

TEST(Redundancy, OfATorus) {
  const TorusSet ring = set(ring_of(5, 2));
  const TorusSet thin = set(ring_of(5, 1));
  const Box<3> around(point(-8, -8, -4), point(8, 8, 4));
  EXPECT_EQ(without_redundant(unite(ring, thin), around).primitive(), ring.primitive());
  // It touches the plane z = 2 from below.
  EXPECT_EQ(without_redundant(intersect(ring, half_space({0, 0, 1}, 2)), around).primitive(),
            ring.primitive());
}

// LAW redundancy.1 at random points, and LAW redundancy.2: not more than before.
RC_GTEST_PROP(Redundancy, KeepsTheSet, ()) {
  std::vector<Solid3> balls;
  for (int i = 0; i < 4; ++i) {
    balls.push_back(ball(random_point(), Rational(*rc::gen::inRange(1, 9), 4)));
  }
  const Solid3 tree = *rc::gen::arbitrary<bool>()
                          ? unite(intersect(balls[0], balls[1]), subtract(balls[2], balls[3]))
                          : subtract(unite(balls[0], balls[1]), unite(balls[2], balls[3]));
  ProofLimits limits;
  limits.cells = 100;
  const Solid3 left = without_redundant(tree, box, limits);
  RC_ASSERT(left.primitive_count() <= tree.primitive_count());
  for (int i = 0; i < 20; ++i) {
    const Point<3> p = random_point();
    const PointClass before = classify(tree, p);
    const PointClass after = classify(left, p);
    const bool is_on = before == PointClass::On || after == PointClass::On;
    RC_ASSERT(is_on || before == after);
  }
}

}  // namespace
}  // namespace exactcsg::measure::test
