// SPDX-License-Identifier: GPL-3.0-or-later
// Points where boundaries meet. Expected values: the geometry of small examples, and sampling of a
// small circle or sphere round the point in doubles, whose cells are far wider than rounding errors
// for the small integers used.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "exactcsg/domain/bounded_primitives.hpp"
#include "exactcsg/domain/classify.hpp"

namespace exactcsg::domain {
namespace {

using csg::BooleanOperator;
using csg::Membership;
using Figure = csg::BooleanTree<HalfSpace<2>>;

Figure square(int x, int y) {
  const auto side = [](int a, int b, int c) { return Figure::primitive(make_line(a, b, c)); };
  return Figure::compose(BooleanOperator::Intersection,
                         {side(-1, 0, x), side(1, 0, -x - 1), side(0, -1, y), side(0, 1, -y - 1)});
}
Figure disc(const Point<2>& centre, const Rational& squared_radius) {
  return Figure::primitive(make_disc(centre, squared_radius));
}

const Rational half(1, 2);

TEST(CoincidentBoundaries, TheCommonSideOfTwoSquaresIsInTheirUnion) {
  const Figure both = unite(square(0, 0), square(1, 0));
  EXPECT_EQ(classify(both, Point<2>(1, half)), PointClass::In);
  EXPECT_EQ(classify(both, Point<2>(1, 0)), PointClass::On);
  EXPECT_EQ(classify(both, Point<2>(1, 2)), PointClass::Out);
  const Figure common = intersect(square(0, 0), square(1, 0));
  EXPECT_EQ(classify(common, Point<2>(1, half)), PointClass::Out);
  const Figure rest = subtract(square(0, 0), square(1, 0));
  EXPECT_EQ(classify(rest, Point<2>(1, half)), PointClass::On);
  const Figure nothing = subtract(square(0, 0), square(0, 0));
  EXPECT_EQ(classify(nothing, Point<2>(0, half)), PointClass::Out);
  // Four squares round a corner, and only two of them.
  const Figure four = unite(both, unite(square(0, 1), square(1, 1)));
  EXPECT_EQ(classify(four, Point<2>(1, 1)), PointClass::In);
  EXPECT_EQ(classify(unite(square(0, 0), square(1, 1)), Point<2>(1, 1)), PointClass::On);
}

TEST(CoincidentBoundaries, TangentDiscsAreToldBySecondOrder) {
  const Figure left = disc({-1, 0}, 1);
  const Figure right = disc({1, 0}, 1);
  const Figure inner = disc({2, 0}, 4);
  const Point<2> origin(0, 0);
  EXPECT_EQ(classify(unite(left, right), origin), PointClass::On);  // a gap above and below
  EXPECT_EQ(classify(intersect(left, right), origin), PointClass::Out);
  EXPECT_EQ(classify(unite(right, csg::complement(inner)), origin), PointClass::On);
  EXPECT_EQ(classify(unite(inner, csg::complement(right)), origin), PointClass::In);
  EXPECT_EQ(classify(subtract(right, inner), origin), PointClass::Out);
  EXPECT_EQ(classify(subtract(inner, right), origin), PointClass::On);
  EXPECT_EQ(classify(symmetric_difference(right, right), origin), PointClass::Out);
}

// The arcs that curves through the origin cut from the circle of this radius round it.
constexpr double radius = 1e-3;

struct Curve {
  HalfSpace<2> half_plane_or_disc;
  // a (x^2 + y^2) + b x + c y, a = 0 or 1
  double a, b, c;
  bool contains(double angle) const {
    const double x = radius * std::cos(angle);
    const double y = radius * std::sin(angle);
    return a * radius * radius + b * x + c * y <= 0;
  }
  // Where a radius + b cos + c sin = 0
  void add_angles(std::vector<double>& angles) const {
    const double to_normal = std::atan2(c, b);
    const double spread = std::acos(-a * radius / std::hypot(b, c));
    for (const double angle : {to_normal - spread, to_normal + spread}) {
      angles.push_back(std::remainder(angle, 2 * std::numbers::pi));
    }
  }
};

TEST(CoincidentBoundaries, RandomFiguresAgreeWithTheArcsOfASmallCircle) {
  std::mt19937 random(3);
  const auto pick = [&](int low, int high) {
    return std::uniform_int_distribution<int>(low, high)(random);
  };
  int on = 0;
  int in = 0;
  for (int round = 0; round < 4000; ++round) {
    std::vector<Curve> curves;
    const int count = pick(2, 6);
    while (static_cast<int>(curves.size()) < count) {
      const int b = pick(-2, 2);
      const int c = pick(-2, 2);
      if (b == 0 && c == 0) continue;
      if (pick(0, 1) == 0) {
        curves.push_back({make_line(b, c, 0), 0.0, double(b), double(c)});
      } else {  // centre (-b/2, -c/2)
        const Rational x(-b, 2);
        const Rational y(-c, 2);
        curves.push_back({make_disc({x, y}, Rational(x * x + y * y)), 1.0, double(b), double(c)});
      }
    }
    // The same random operators over truth values and over half-spaces.
    std::vector<BooleanOperator> operators;
    for (int i = 0; i < count; ++i) operators.push_back(static_cast<BooleanOperator>(pick(0, 3)));
    Figure figure = Figure::primitive(curves[0].half_plane_or_disc);
    for (int i = 1; i < count; ++i) {
      const auto k = static_cast<std::size_t>(i);
      figure =
          Figure::compose(operators[k], {figure, Figure::primitive(curves[k].half_plane_or_disc)});
    }
    std::vector<double> angles;
    for (const Curve& curve : curves) curve.add_angles(angles);
    std::sort(angles.begin(), angles.end());
    angles.push_back(angles.front() + 2 * std::numbers::pi);
    bool has_in = false;
    bool has_out = false;
    for (std::size_t i = 0; i + 1 < angles.size(); ++i) {
      if (angles[i + 1] - angles[i] < 1e-9) continue;  // the same point
      const double middle = (angles[i] + angles[i + 1]) / 2;
      Membership value = curves[0].contains(middle) ? Membership::In : Membership::Out;
      for (std::size_t k = 1; k < curves.size(); ++k) {
        value = csg::combine(value, operators[k],
                             curves[k].contains(middle) ? Membership::In : Membership::Out);
      }
      (value == Membership::In ? has_in : has_out) = true;
    }
    const PointClass expected = has_in && has_out ? PointClass::On
                                : has_in          ? PointClass::In
                                                  : PointClass::Out;
    ASSERT_EQ(classify(figure, Point<2>(0, 0)), expected) << "round " << round;
    if (expected == PointClass::On) ++on;
    if (expected == PointClass::In) ++in;
  }
  EXPECT_GT(on, 300);
  EXPECT_GT(in, 30);
}

TEST(CoincidentBoundaries, FacesEdgesAndCornersOfBlocks) {
  const Solid3 first = make_block({{0, 0, 0}, {1, 1, 1}});
  const Solid3 second = make_block({{1, 0, 0}, {2, 1, 1}});
  const Solid3 both = unite(first, second);
  EXPECT_EQ(classify(both, Point<3>(1, half, half)), PointClass::In);
  EXPECT_EQ(classify(both, Point<3>(1, 0, half)), PointClass::On);
  EXPECT_EQ(classify(both, Point<3>(1, 0, 0)), PointClass::On);
  EXPECT_EQ(classify(intersect(first, second), Point<3>(1, half, half)), PointClass::Out);
  EXPECT_EQ(classify(subtract(first, second), Point<3>(1, half, half)), PointClass::On);
}

TEST(CoincidentBoundaries, RoundSurfacesThatTouch) {
  const Point<3> origin(0, 0, 0);
  const Solid3 below = Solid3::primitive(make_plane({0, 0, 1}, 0));
  const Solid3 ball = make_bounded_ball({0, 0, 1}, 1);
  EXPECT_EQ(classify(unite(below, ball), origin), PointClass::On);
  EXPECT_EQ(classify(intersect(below, ball), origin), PointClass::Out);
  EXPECT_EQ(classify(unite(below, csg::complement(ball)), origin), PointClass::On);
  EXPECT_EQ(classify(csg::complement(intersect(below, ball)), origin), PointClass::In);
  // A cylinder lying on the plane touches it all along a line.
  const Solid3 roller = Solid3::primitive(make_cylinder({{0, 0, 1}, {1, 0, 0}}, 1));
  EXPECT_EQ(classify(unite(below, roller), origin), PointClass::On);
  EXPECT_EQ(classify(intersect(below, roller), origin), PointClass::Out);
  // Two crossed cylinders that touch from one side: they pass through each other.
  const Solid3 crossed = Solid3::primitive(make_cylinder({{0, 0, 1}, {0, 1, 0}}, 1));
  EXPECT_EQ(classify(subtract(roller, crossed), origin), PointClass::On);
  EXPECT_EQ(classify(unite(roller, csg::complement(crossed)), origin), PointClass::On);
  // A smaller ball inside a larger one.
  const Solid3 larger = make_bounded_ball({0, 0, 2}, 4);
  EXPECT_EQ(classify(unite(larger, csg::complement(ball)), origin), PointClass::In);
  EXPECT_EQ(classify(subtract(ball, larger), origin), PointClass::Out);
}

TEST(CoincidentBoundaries, WhatIsNotDecidedIsRefused) {
  const Point<3> origin(0, 0, 0);
  const Solid3 cone = Solid3::primitive(make_cone({{0, 0, 0}, {0, 0, 1}}, 1));
  const Solid3 plane = Solid3::primitive(make_plane({0, 0, 1}, 0));
  EXPECT_EQ(classify(cone, origin), PointClass::On);
  EXPECT_EQ(classify(subtract(cone, cone), origin), PointClass::Out);
  // Both nappes and their outside, at the common apex.
  const Solid3 down = Solid3::primitive(make_cone({{0, 0, 0}, {0, 0, -1}}, 1));
  const Solid3 two = Solid3::primitive(make_double_cone({{0, 0, 0}, {0, 0, 1}}, 1));
  EXPECT_EQ(classify(unite(cone, down), origin), PointClass::On);
  EXPECT_EQ(classify(subtract(two, unite(cone, down)), origin), PointClass::Out);
  EXPECT_EQ(classify(subtract(two, cone), origin), PointClass::On);
  EXPECT_EQ(classify(unite(cone, plane), origin), PointClass::On);  // some directions show it
  EXPECT_EQ(classify(intersect(cone, plane), origin), PointClass::Out);
  // A ball and a paraboloid round it that has the ball's curvature in the origin.
  const Solid3 ball = make_bounded_ball({0, 0, 1}, 1);
  const Solid3 bowl = Solid3::primitive(
      HalfSpace<3>(Quadric<3>({{{1, 0, 0}, {0, 1, 0}, {0, 0, 0}}}, {{0, 0, -2}, 0})));
  try {
    classify(subtract(ball, bowl), origin);
    FAIL() << "surfaces that osculate are not decided";
  } catch (const Error& error) {
    EXPECT_EQ(error.id(), ErrorId::UndecidedNeighbourhood);
  }
}

// Cells of a small sphere by random sampling; those of surfaces that touch are about `radius` wide.
TEST(CoincidentBoundaries, RandomSolidsAgreeWithSamplesOfASmallSphere) {
  std::mt19937 random(5);
  const auto pick = [&](int low, int high) {
    return std::uniform_int_distribution<int>(low, high)(random);
  };
  std::normal_distribution<double> normal;
  constexpr double reach = 0.02;
  struct Surface {
    HalfSpace<3> set;
    std::array<double, 3> b;
    std::array<double, 3> squares;
    double value(const std::array<double, 3>& x) const {
      double sum = 0;
      for (std::size_t i = 0; i < 3; ++i) sum += squares[i] * x[i] * x[i] + b[i] * x[i];
      return sum;
    }
  };
  int refused = 0;
  int on = 0;
  constexpr int rounds = 400;
  for (int round = 0; round < rounds; ++round) {
    std::vector<Surface> surfaces;
    const int count = pick(2, 4);
    while (static_cast<int>(surfaces.size()) < count) {
      const Coordinates<3> b{pick(-1, 1), pick(-1, 1), pick(-1, 1)};
      const std::array<double, 3> numbers{b[0].get_d(), b[1].get_d(), b[2].get_d()};
      if (b == Coordinates<3>{}) continue;
      const Point<3> centre(Rational(-b[0] / 2), Rational(-b[1] / 2), Rational(-b[2] / 2));
      const int kind = pick(0, 2);
      if (kind == 0) {
        surfaces.push_back({make_plane(b, 0), numbers, {0, 0, 0}});
      } else if (kind == 1) {
        const Rational squared = (b[0] * b[0] + b[1] * b[1] + b[2] * b[2]) / 4;
        surfaces.push_back({make_sphere(centre, squared), numbers, {1, 1, 1}});
      } else if (b[2] == 0) {
        const Rational squared = (b[0] * b[0] + b[1] * b[1]) / 4;
        surfaces.push_back({make_cylinder({centre, {0, 0, 1}}, squared), numbers, {1, 1, 0}});
      }
    }
    std::vector<BooleanOperator> operators;
    Solid3 solid = Solid3::primitive(surfaces[0].set);
    for (std::size_t k = 0; k < surfaces.size(); ++k) {
      operators.push_back(static_cast<BooleanOperator>(pick(0, 3)));
      if (k > 0) solid = Solid3::compose(operators[k], {solid, Solid3::primitive(surfaces[k].set)});
    }
    bool has_in = false;
    bool has_out = false;
    for (int i = 0; i < 20000; ++i) {
      std::array<double, 3> x{normal(random), normal(random), normal(random)};
      // Half of the samples near the surface of one of them.
      const Surface& near = surfaces[static_cast<std::size_t>(pick(0, count - 1))];
      if (i % 2 == 0) {
        const double along = x[0] * near.b[0] + x[1] * near.b[1] + x[2] * near.b[2];
        const double squared =
            near.b[0] * near.b[0] + near.b[1] * near.b[1] + near.b[2] * near.b[2];
        for (std::size_t k = 0; k < 3; ++k) {
          x[k] += near.b[k] * (-along / squared + 2 * reach * normal(random));
        }
      }
      const double length = std::hypot(x[0], x[1], x[2]);
      for (double& component : x) component *= reach / length;
      Membership value = Membership::Unknown;
      for (std::size_t k = 0; k < surfaces.size(); ++k) {
        const Membership side = surfaces[k].value(x) <= 0 ? Membership::In : Membership::Out;
        value = k == 0 ? side : csg::combine(value, operators[k], side);
      }
      (value == Membership::In ? has_in : has_out) = true;
    }
    const PointClass expected = has_in && has_out ? PointClass::On
                                : has_in          ? PointClass::In
                                                  : PointClass::Out;
    try {
      ASSERT_EQ(classify(solid, Point<3>(0, 0, 0)), expected) << "round " << round;
      if (expected == PointClass::On) ++on;
    } catch (const Error& error) {
      ASSERT_EQ(error.id(), ErrorId::UndecidedNeighbourhood);
      ++refused;
    }
  }
  EXPECT_LT(refused, rounds / 10);
  EXPECT_GT(on, rounds / 4);
}

Solid3 plane_below(const Coordinates<3>& normal) {
  return Solid3::primitive(make_plane(normal, 0));
}

// Balls of radii 1, 2 and 3 that touch in the origin, each within the next; and planes there.
TEST(CoincidentBoundaries, SeveralSurfacesThatTouch) {
  const Point<3> origin(0, 0, 0);
  const auto ball = [](int radius) { return make_bounded_ball({0, 0, radius}, radius * radius); };
  EXPECT_EQ(classify(subtract(intersect(ball(1), ball(2)), ball(3)), origin), PointClass::Out);
  EXPECT_EQ(classify(subtract(subtract(ball(3), ball(2)), ball(1)), origin), PointClass::On);
  const Solid3 plate = plane_below({0, 0, 1});
  const Solid3 wall = plane_below({1, 0, 0});
  EXPECT_EQ(classify(intersect(intersect(ball(1), plate), wall), origin), PointClass::Out);
  EXPECT_EQ(classify(intersect(subtract(ball(2), ball(1)), wall), origin), PointClass::On);
  EXPECT_EQ(classify(intersect(subtract(ball(1), ball(2)), wall), origin), PointClass::Out);
  // Two pairs that touch, in planes that cross: a cell between both, e^2 wide, where both gaps
  // meet.
  const auto beside = [](int radius) { return make_bounded_ball({radius, 0, 0}, radius * radius); };
  const Solid3 gap = subtract(ball(2), ball(1));
  EXPECT_EQ(classify(intersect(gap, subtract(beside(2), beside(1))), origin), PointClass::On);
  EXPECT_EQ(classify(intersect(gap, subtract(beside(1), beside(2))), origin), PointClass::Out);
}

// A pair of planes as one quadric, and one of the two: away from the other they are one surface.
TEST(CoincidentBoundaries, AQuadricThatIsAPairOfPlanes) {
  const Point<3> on(0, 1, 2);
  const Solid3 pair =
      Solid3::primitive(HalfSpace<3>(product(LinearForm<3>{{1, 0, 0}, 0}, {{0, 1, 0}, 0})));
  const Solid3 left = plane_below({1, 0, 0});
  EXPECT_EQ(classify(subtract(pair, left), on), PointClass::Out);  // x y <= 0, y > 0
  EXPECT_EQ(classify(unite(pair, csg::complement(left)), on), PointClass::In);
  EXPECT_EQ(classify(intersect(pair, left), on), PointClass::On);
  EXPECT_EQ(classify(subtract(intersect(pair, left), make_bounded_ball({3, 1, 2}, 9)), on),
            PointClass::On);
}

// What is turned about one axis shares circles: the point (3, 4, 0) of the radius 5.
TEST(CoincidentBoundaries, SurfacesOfRevolutionThatShareACircle) {
  const Point<3> on(3, 4, 0);
  const Axis axis{{0, 0, 0}, {0, 0, 1}};
  const Solid3 pipe = Solid3::primitive(make_cylinder(axis, 25));
  const Solid3 ball = make_bounded_ball({0, 0, 0}, 25);
  const Solid3 under = plane_below({0, 0, 1});
  const Solid3 over = csg::complement(under);
  // They touch along it.
  EXPECT_EQ(classify(subtract(ball, pipe), on), PointClass::Out);
  EXPECT_EQ(classify(subtract(pipe, ball), on), PointClass::On);
  // A vessel: a cylinder with a hemisphere below, and all that is round it.
  const Solid3 vessel = unite(intersect(pipe, over), intersect(ball, under));
  const Solid3 round = unite(subtract(over, pipe), subtract(under, ball));
  EXPECT_EQ(classify(vessel, on), PointClass::On);
  EXPECT_EQ(classify(unite(vessel, round), on), PointClass::In);
  EXPECT_EQ(classify(intersect(vessel, round), on), PointClass::Out);
  // A cone and a ball through it, which cross.
  const Solid3 roof = Solid3::primitive(make_cone({{0, 0, 5}, {0, 0, -1}}, 1));
  EXPECT_EQ(classify(subtract(intersect(roof, over), pipe), on), PointClass::Out);
  EXPECT_EQ(classify(subtract(intersect(roof, under), pipe), on), PointClass::On);
  const Solid3 low = make_bounded_ball({0, 0, -12}, 169);
  EXPECT_EQ(classify(subtract(intersect(low, over), roof), on), PointClass::Out);
  EXPECT_EQ(classify(intersect(intersect(low, over), intersect(roof, pipe)), on), PointClass::On);
  const Solid3 high = make_bounded_ball({0, 0, 12}, 169);
  EXPECT_EQ(classify(subtract(intersect(low, high), under), on), PointClass::On);
  EXPECT_EQ(classify(subtract(intersect(intersect(low, high), pipe), ball), on), PointClass::Out);
}

// An edge along the common side of two squares, then along one of them alone.
TEST(Sections, AnEdgeIsInOnAndOut) {
  const Figure both = unite(square(0, 0), square(1, 0));
  const Section along = simplified(section(both, segment<2>({1, -1}, {1, 2})));
  ASSERT_EQ(along.crossings.size(), 2U);
  EXPECT_EQ(along.between, (std::vector{PointClass::Out, PointClass::In, PointClass::Out}));
  EXPECT_EQ(along.crossings[0].parameter, QuadraticNumber(Rational(1, 3)));
  const Section side = simplified(section(both, segment<2>({-1, 0}, {5, 0})));
  EXPECT_EQ(side.between, (std::vector{PointClass::Out, PointClass::On, PointClass::Out}));
  EXPECT_EQ(side.crossings[1].parameter, QuadraticNumber(half));
}

TEST(Sections, ARayThroughADrilledBall) {
  const Solid3 drilled = subtract(make_bounded_ball({0, 0, 0}, 9),
                                  Solid3::primitive(make_cylinder({{0, 0, 0}, {0, 0, 1}}, 2)));
  const Section found = simplified(section(drilled, ray<3>({-5, 0, 1}, {1, 0, 0})));
  ASSERT_EQ(found.crossings.size(), 4U);
  EXPECT_EQ(found.crossings[0].parameter, QuadraticNumber(5, -1, 8));
  EXPECT_EQ(found.crossings[1].parameter, QuadraticNumber(5, -1, 2));
  EXPECT_EQ(found.crossings[2].parameter, QuadraticNumber(5, 1, 2));
  EXPECT_EQ(found.crossings[3].parameter, QuadraticNumber(5, 1, 8));
  // On the wall of the hole: On between the ends.
  const Section wall = simplified(section(drilled, whole_line<3>({1, 1, 0}, {0, 0, 2})));
  EXPECT_EQ(wall.between, (std::vector{PointClass::Out, PointClass::On, PointClass::Out}));
  EXPECT_EQ(wall.crossings[1].parameter, QuadraticNumber(0, half, 7));
}

TEST(Boxes, TreesCombineWhatThePrimitivesSay) {
  const Solid3 block = make_block({{0, 0, 0}, {4, 4, 4}});
  EXPECT_EQ(classify(block, Box<3>({0, 0, 0}, {4, 4, 4})), Membership::In);
  EXPECT_EQ(classify(block, Box<3>({4, 0, 0}, {5, 4, 4})), Membership::Out);
  EXPECT_EQ(classify(block, Box<3>({3, 0, 0}, {5, 4, 4})), Membership::Unknown);
  // Conservative: covered by two that each cover a half.
  const Solid3 two = unite(make_block({{0, 0, 0}, {1, 1, 1}}), make_block({{1, 0, 0}, {2, 1, 1}}));
  EXPECT_EQ(classify(two, Box<3>({0, 0, 0}, {2, 1, 1})), Membership::Unknown);
}

}  // namespace
}  // namespace exactcsg::domain
