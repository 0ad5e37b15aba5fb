// SPDX-License-Identifier: GPL-3.0-or-later
// Points at the apex of a cone where other surfaces pass. Expected values: the geometry of small
// examples, and the cells that random directions show. And points that are not special at all:
// nothing is refused there.

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <string>

#include "domain/random_rationals.hpp"
#include "domain/surface_sets.hpp"
#include "exactcsg/domain/bounded_primitives.hpp"
#include "exactcsg/domain/classify.hpp"
#include "exactcsg/domain/direction_cells.hpp"

namespace exactcsg::domain {
namespace {

using namespace test;

const Point<3> origin(0, 0, 0);

Set cone(const Coordinates<3>& direction, const Rational& squared_slope) {
  return set(make_cone({origin, direction}, squared_slope));
}
Set double_cone(const Coordinates<3>& direction, const Rational& squared_slope) {
  return set(make_double_cone({origin, direction}, squared_slope));
}

TEST(Apices, OnAPlane) {
  const Set up = cone({0, 0, 1}, 1);
  const Set floor = below({0, 0, 1});
  EXPECT_EQ(classify(intersect(up, floor), origin), PointClass::Out);
  EXPECT_EQ(classify(unite(up, floor), origin), PointClass::On);
  EXPECT_EQ(classify(unite(csg::complement(up), csg::complement(floor)), origin), PointClass::In);
  // One nappe of two, cut off by the plane across the axis, as transport codes write a cone.
  const Set two = double_cone({0, 0, 1}, 1);
  EXPECT_EQ(classify(intersect(two, csg::complement(floor)), origin), PointClass::On);
  EXPECT_EQ(classify(subtract(intersect(two, csg::complement(floor)), up), origin),
            PointClass::Out);
  EXPECT_EQ(classify(unite(unite(intersect(two, floor), intersect(two, csg::complement(floor))),
                           csg::complement(two)),
                     origin),
            PointClass::In);
}

TEST(Apices, OnASlantedPlaneAndOneThatTouches) {
  const Set up = cone({0, 0, 1}, Rational(1, 4));
  EXPECT_EQ(classify(intersect(up, below({1, 0, 2})), origin), PointClass::Out);
  // 2 x - z = 0 touches along (1, 0, 2).
  const Set tangent = below({2, 0, -1});
  EXPECT_EQ(classify(subtract(up, tangent), origin), PointClass::Out);
  EXPECT_EQ(classify(unite(tangent, csg::complement(up)), origin), PointClass::In);
  EXPECT_EQ(classify(intersect(up, tangent), origin), PointClass::On);
  // 3 x - z = 0 cuts.
  EXPECT_EQ(classify(subtract(up, below({3, 0, -1})), origin), PointClass::On);
}

// A wedge of two planes that meet in a line through the apex: outside of the cone, in it, on it.
TEST(Apices, OnTwoPlanes) {
  const Set up = cone({0, 0, 1}, 1);
  const auto wedge = [](const Coordinates<3>& a, const Coordinates<3>& b) {
    return intersect(below(a), below(b));
  };
  EXPECT_EQ(classify(intersect(up, wedge({0, 1, 2}, {0, -1, 2})), origin), PointClass::Out);
  EXPECT_EQ(classify(intersect(up, wedge({0, 3, 1}, {0, -2, 1})), origin), PointClass::Out);
  EXPECT_EQ(classify(intersect(up, wedge({0, 2, -1}, {0, 3, -1})), origin), PointClass::On);
  // Both through (1, 0, 1), which is on the cone: one touches it there.
  EXPECT_EQ(classify(subtract(up, unite(below({1, 0, -1}), below({-1, 1, 1}))), origin),
            PointClass::Out);
}

TEST(Apices, OfSeveralCones) {
  const Set narrow = cone({0, 0, 1}, Rational(1, 4));
  const Set broad = cone({0, 0, 1}, 1);
  EXPECT_EQ(classify(subtract(narrow, broad), origin), PointClass::Out);
  EXPECT_EQ(classify(subtract(broad, narrow), origin), PointClass::On);
  EXPECT_EQ(classify(intersect(broad, cone({0, 0, -1}, 1)), origin), PointClass::Out);
  // Half angles of 45 degrees and 90 degrees between the axes: they touch along (1, 0, 1).
  EXPECT_EQ(classify(intersect(broad, cone({1, 0, 0}, 1)), origin), PointClass::Out);
  EXPECT_EQ(classify(intersect(broad, cone({1, 0, 0}, Rational(101, 100))), origin),
            PointClass::On);
  // Within 45 degrees of z, so that y + 3 z is above 0.
  EXPECT_EQ(classify(intersect(intersect(broad, cone({1, 0, 0}, 2)), below({0, 1, 3})), origin),
            PointClass::Out);
}

// The tangent plane z = 0 of a ball meets the cone about z in the apex alone; that of one beside it
// in two lines.
TEST(Apices, OnCurvedSurfaces) {
  const Set up = cone({0, 0, 1}, 1);
  const Set under = set(make_sphere({0, 0, -1}, 1));
  EXPECT_EQ(classify(intersect(up, under), origin), PointClass::Out);
  EXPECT_EQ(classify(unite(up, under), origin), PointClass::On);
  const Set beside = set(make_sphere({3, 0, 0}, 9));
  EXPECT_EQ(classify(subtract(up, beside), origin), PointClass::On);
  EXPECT_EQ(classify(unite(unite(beside, csg::complement(beside)), up), origin), PointClass::In);
  EXPECT_EQ(classify(intersect(intersect(up, under), beside), origin), PointClass::Out);
}

TEST(Apices, WhatTheFormsDoNotShowIsRefused) {
  const Set up = cone({0, 0, 1}, 1);
  // A cylinder whose tangent plane touches the cone along (1, 0, 1).
  const Set tangent = set(make_cylinder({{1, 0, -1}, {0, 1, 0}}, 2));
  EXPECT_TRUE(is_refused(intersect(up, tangent), origin));
  // Two balls that touch each other in the apex.
  const Set small = set(make_sphere({0, 0, -1}, 1));
  const Set large = set(make_sphere({0, 0, -2}, 4));
  EXPECT_TRUE(is_refused(intersect(subtract(small, large), up), origin));
  // A ball whose tangent plane has a line of two cones, and of a cone and a plane.
  const Set beside = set(make_sphere({0, 3, 0}, 9));
  EXPECT_TRUE(is_refused(intersect(intersect(up, cone({1, 0, 0}, 1)), beside), origin));
  EXPECT_TRUE(is_refused(subtract(intersect(up, below({-1, 0, 1})), beside), origin));
  // Pairs of planes which have one in common.
  const Set one = set(HalfSpace<3>(product(LinearForm<3>{{1, 1, 0}, 0}, {{1, 0, 0}, 0})));
  const Set other = set(HalfSpace<3>(product(LinearForm<3>{{1, 1, 0}, 0}, {{0, 0, 1}, 0})));
  EXPECT_TRUE(is_refused(subtract(intersect(one, other), unite(one, other)), origin));
}

std::string signs_along(const std::vector<Quadric<3>>& forms, const Coordinates<3>& direction) {
  std::string signs;
  for (const Quadric<3>& form : forms) {
    const int sign = sgn(form(direction));
    signs += sign < 0 ? '-' : sign > 0 ? '+' : '0';
  }
  return signs;
}

// Small whole coefficients, so that lines are shared and surfaces touch.
std::vector<Quadric<3>> random_forms(Random& random, int count) {
  std::vector<Quadric<3>> forms;
  while (static_cast<int>(forms.size()) < count) {
    Quadric<3> form;
    if (random.one_in(2)) {
      form = Quadric<3>(
          LinearForm<3>{{random.integer(-2, 2), random.integer(-2, 2), random.integer(-2, 2)}, 0});
    } else {
      Quadric<3>::Matrix square;
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j <= i; ++j) square[i][j] = square[j][i] = random.integer(-2, 2);
      }
      form = Quadric<3>(square, {});
    }
    bool is_new = !(form == Quadric<3>());
    for (const Quadric<3>& other : forms) {
      // Proportional if they agree up to the factor that one value tells.
      const Coordinates<3> at{Rational(3, 7), Rational(-5, 11), Rational(13, 17)};
      is_new = is_new && !(other(at) * form == form(at) * other);
    }
    if (is_new) forms.push_back(form);
  }
  return forms;
}

// LAW direction_cells.1 and .2
TEST(DirectionCells, HaveAllThatRandomDirectionsShow) {
  Random random(7);
  int complete = 0;
  constexpr int rounds = 60;
  for (int round = 0; round < rounds; ++round) {
    const std::vector<Quadric<3>> forms =
        random_forms(random, static_cast<int>(random.integer(1, 4)));
    const DirectionCells cells = direction_cells(forms);
    std::set<std::string> found;
    for (const Coordinates<3>& direction : cells.directions) {
      const std::string signs = signs_along(forms, direction);
      ASSERT_EQ(signs.find('0'), std::string::npos) << "round " << round;
      found.insert(signs);
    }
    if (!cells.complete) continue;
    ++complete;
    for (int i = 0; i < 1000; ++i) {
      const Coordinates<3> direction{random.integer(-1000, 1000), random.integer(-1000, 1000),
                                     random.integer(-1000, 1000)};
      const std::string signs = signs_along(forms, direction);
      if (signs.find('0') != std::string::npos) continue;
      ASSERT_TRUE(found.count(signs) == 1) << "round " << round << ": " << signs;
    }
  }
  EXPECT_GT(complete, rounds * 3 / 4);
}

// A random surface of any kind through the point: its last coefficient is chosen so.
Set random_surface_through(const Point<3>& point, Random& random) {
  Coordinates<3> centre = random.coordinates<3>();
  while (centre == point.coordinates()) centre = random.coordinates<3>();
  const auto through = [&](const Quadric<3>& f) {
    return set(HalfSpace<3>(f + Quadric<3>(LinearForm<3>{{}, Rational(-f(point.coordinates()))})));
  };
  const Quadric<3> plane(LinearForm<3>{random.direction<3>(), 0});
  switch (random.integer(1, 4)) {
    case 1:
      return through(plane);
    case 2:  // a sphere
      return through(make_sphere(Point<3>(centre), 1).polynomial());
    case 3: {  // a cylinder
      const Axis axis{Point<3>(centre), random.direction<3>()};
      return through(make_cylinder(axis, 1).polynomial());
    }
    default: {  // any quadric
      Quadric<3>::Matrix square;
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j <= i; ++j) square[i][j] = square[j][i] = random.rational();
      }
      return through(Quadric<3>(square, {random.direction<3>(), 0}));
    }
  }
}

Set random_tree(const std::vector<Set>& surfaces, Random& random) {
  Set tree = surfaces.front();
  for (std::size_t i = 1; i < surfaces.size(); ++i) {
    const Set next = random.one_in(2) ? surfaces[i] : csg::complement(surfaces[i]);
    tree = random.one_in(2) ? unite(tree, next) : intersect(tree, next);
  }
  return tree;
}

// Points on one, two and three random surfaces, long fractions as coefficients: those that are
// refused have measure zero (docs/limits.md), and none is met.
TEST(UndecidedNeighbourhoods, AreNotMetByPointsOnRandomSurfaces) {
  Random random(11);
  for (int round = 0; round < 1500; ++round) {
    const Point<3> point(random.coordinates<3>());
    std::vector<Set> surfaces;
    const auto count = random.integer(1, 3);
    for (int i = 0; i < count; ++i) surfaces.push_back(random_surface_through(point, random));
    const Set tree = random_tree(surfaces, random);
    ASSERT_FALSE(is_refused(tree, point)) << "round " << round;
  }
}

// Many points of one curve: a sphere and a plane have a rational point in common, and each line
// through it in the plane meets the sphere in another one.
TEST(UndecidedNeighbourhoods, AreNotMetAlongRandomCurves) {
  Random random(13, 3);
  for (int round = 0; round < 60; ++round) {
    const Point<3> start(random.coordinates<3>());
    const Coordinates<3> u = random.direction<3>();
    const Coordinates<3> v = random.direction<3>();
    const Coordinates<3> normal = detail::vector_product(u, v);
    Coordinates<3> centre = random.coordinates<3>();
    if (detail::is_zero(normal) || centre == start.coordinates()) continue;
    const Coordinates<3> from_centre =
        detail::sum(start.coordinates(), detail::scaled(Rational(-1), centre));
    const Set ball =
        set(make_sphere(Point<3>(centre), detail::scalar_product(from_centre, from_centre)));
    const Set side = below(normal, detail::scalar_product(normal, start.coordinates()));
    for (int i = 0; i < 30; ++i) {
      const Coordinates<3> d =
          detail::sum(detail::scaled(random.rational(), u), detail::scaled(random.rational(), v));
      if (detail::is_zero(d)) continue;
      const Rational t = -2 * detail::scalar_product(from_centre, d) / detail::scalar_product(d, d);
      const Point<3> point(detail::sum(start.coordinates(), detail::scaled(t, d)));
      ASSERT_EQ(classify(ball, point), PointClass::On);
      ASSERT_EQ(classify(side, point), PointClass::On);
      // A third surface through the point as well, every other time.
      std::vector<Set> surfaces{ball, side};
      if (i % 2 == 0) surfaces.push_back(random_surface_through(point, random));
      ASSERT_FALSE(is_refused(random_tree(surfaces, random), point)) << round << ' ' << i;
    }
  }
}

}  // namespace
}  // namespace exactcsg::domain
