// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces that meet themselves, by closed forms, by the evaluator on the solids that they are the
// surfaces of (LAW fill.1 to fill.3), and by winding numbers summed from solid angles.
#include "exactcsg/solid/fill_rule.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "exactcsg/solid/classify.hpp"
#include "exactcsg/solid/evaluate.hpp"
#include "exactcsg/solid/measures.hpp"
#include "exactcsg/support/error.hpp"
#include "solid/polyhedra.hpp"

namespace exactcsg {
namespace {

using namespace test;

constexpr std::array all_rules{FillRule::NonZero, FillRule::Positive, FillRule::EvenOdd};

Polyhedron box(const Point3& lower, const Point3& upper) {
  return to_polyhedron(*make_box(lower, upper).polyhedron);
}

Rational filled_volume(const Polyhedron& polyhedron, FillRule rule) {
  const Boundary boundary = filled_boundary(polyhedron, rule);
  return boundary.empty() ? Rational(0) : exact_volume(boundary).value();
}

// Two unit cubes that share an eighth of each.
struct TwoCubes {
  Polyhedron first = box({0, 0, 0}, {1, 1, 1});
  Polyhedron second = box({{1, 2}, {1, 2}, {1, 2}}, {{3, 2}, {3, 2}, {3, 2}});
};

TEST(FillRule, OverlappingCubesByInclusionAndExclusion) {
  const TwoCubes cubes;
  const Polyhedron both = together(cubes.first, cubes.second);
  EXPECT_EQ(filled_volume(both, FillRule::NonZero), Rational(15, 8));
  EXPECT_EQ(filled_volume(both, FillRule::Positive), Rational(15, 8));
  EXPECT_EQ(filled_volume(both, FillRule::EvenOdd), Rational(7, 4));
}

TEST(FillRule, ReversedCubeIsTakenAway) {
  const TwoCubes cubes;
  const Polyhedron both = together(cubes.first, reversed(cubes.second));
  EXPECT_EQ(filled_volume(both, FillRule::Positive), Rational(7, 8));
  // -1 in the second one alone, 0 in both.
  EXPECT_EQ(filled_volume(both, FillRule::NonZero), Rational(7, 4));
  EXPECT_EQ(filled_volume(both, FillRule::EvenOdd), Rational(7, 4));
}

TEST(FillRule, CubeTurnedInsideOut) {
  const Polyhedron cube = reversed(box({0, 0, 0}, {1, 1, 1}));
  EXPECT_TRUE(filled_boundary(cube, FillRule::Positive).empty());
  EXPECT_EQ(filled_volume(cube, FillRule::NonZero), 1);
  EXPECT_EQ(filled_volume(cube, FillRule::EvenOdd), 1);
}

TEST(FillRule, DoubledCube) {
  const Polyhedron cube = box({0, 0, 0}, {1, 1, 1});
  for (const Polyhedron& second : {cube, triangulated(cube)}) {
    const Polyhedron doubled = together(cube, second);
    EXPECT_TRUE(filled_boundary(doubled, FillRule::EvenOdd).empty());
    EXPECT_EQ(digest(filled_boundary(doubled, FillRule::NonZero)),
              digest(evaluate(Solid::primitive({make_box({0, 0, 0}, {1, 1, 1})}))));
    const Polyhedron cancelled = together(cube, reversed(second));
    for (const FillRule rule : all_rules) {
      EXPECT_TRUE(filled_boundary(cancelled, rule).empty()) << name_of(rule);
    }
  }
}

TEST(FillRule, NestedCubes) {
  const Polyhedron outer = box({0, 0, 0}, {3, 3, 3});
  const Polyhedron inner = box({1, 1, 1}, {2, 2, 2});
  const Polyhedron same = together(outer, inner);
  EXPECT_EQ(filled_volume(same, FillRule::NonZero), 27);
  EXPECT_EQ(filled_volume(same, FillRule::EvenOdd), 26);
  const Polyhedron opposite = together(outer, reversed(inner));
  for (const FillRule rule : all_rules) EXPECT_EQ(filled_volume(opposite, rule), 26);
}

// The outline crosses itself in the middle of the unit square: one triangle of area 1/4 is gone
// round counter-clockwise, the other clockwise.
TEST(FillRule, BowTiePrism) {
  Polyhedron prism{
      {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}, {1, 0, 1}, {0, 1, 1}},
      {{4, 5, 6}, {4, 6, 7}, {0, 2, 1}, {0, 3, 2}}};
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t j = (i + 1) % 4;
    prism.facets.push_back({i, j, j + 4, i + 4});
  }
  EXPECT_EQ(filled_volume(prism, FillRule::NonZero), Rational(1, 2));
  EXPECT_EQ(filled_volume(prism, FillRule::EvenOdd), Rational(1, 2));
  EXPECT_EQ(filled_volume(prism, FillRule::Positive), Rational(1, 4));
  EXPECT_EQ(topology(filled_boundary(prism, FillRule::NonZero)).components, 2U);
}

// Blocks with faces in one plane, in the same sense and in opposite ones.
TEST(FillRule, FacesInOnePlane) {
  const Polyhedron flush = together(box({0, 0, 0}, {2, 2, 1}), box({1, 1, 0}, {3, 3, 1}));
  EXPECT_EQ(filled_volume(flush, FillRule::NonZero), 7);
  EXPECT_EQ(filled_volume(flush, FillRule::EvenOdd), 6);
  const Polyhedron side_by_side = together(box({0, 0, 0}, {1, 2, 2}), box({1, 1, 1}, {2, 3, 3}));
  const Boundary boundary = filled_boundary(side_by_side, FillRule::NonZero);
  EXPECT_EQ(exact_volume(boundary), Rational(8));
  EXPECT_EQ(topology(boundary).components, 1U);
}

// An edge of a wedge that lies across a face, and a tip that touches one.
TEST(FillRule, TouchingBodies) {
  const Polyhedron block = box({0, 0, 0}, {4, 4, 1});
  const Polyhedron wedge{{{1, 1, 1}, {3, 1, 1}, {1, 2, 2}, {3, 2, 2}, {1, 0, 2}, {3, 0, 2}},
                         {{2, 3, 1, 0}, {5, 4, 0, 1}, {4, 5, 3, 2}, {4, 2, 0}, {3, 5, 1}}};
  EXPECT_EQ(filled_volume(together(block, wedge), FillRule::Positive), 16 + 2);
  const Polyhedron tip{{{2, 3, 1}, {3, 3, 2}, {2, 4, 2}, {1, 3, 2}},
                       {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}}};
  EXPECT_EQ(filled_volume(together(block, tip), FillRule::Positive), 16 + Rational(1, 3));
}

TEST(FillRule, RefusesWhatIsNoClosedSurface) {
  Polyhedron open = box({0, 0, 0}, {1, 1, 1});
  open.facets.pop_back();
  try {
    filled_boundary(open, FillRule::NonZero);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.id(), ErrorId::OpenMesh);
  }
}

// LAW fill.1
TEST(FillRule, SimpleMeshIsItself) {
  const Polyhedron shape = triangulated(
      together(box({0, 0, 0}, {9, 9, 9}),
               together(reversed(box({1, 1, 1}, {3, 3, 3})), reversed(box({3, 3, 1}, {5, 5, 3})))));
  const std::string expected = digest(evaluate(Solid::primitive({make_mesh(shape)})));
  for (const FillRule rule : all_rules) EXPECT_EQ(digest(filled_boundary(shape, rule)), expected);
}

using Body = std::array<Point3, 4>;

Body random_tetrahedron(std::mt19937& random, int size) {
  std::uniform_int_distribution<int> coordinate(0, size);
  Body body;
  const auto volume = [&] {
    return dot(cross(body[1] - body[0], body[2] - body[0]), body[3] - body[0]);
  };
  do {
    for (Point3& p : body) p = {coordinate(random), coordinate(random), coordinate(random)};
  } while (volume() == 0);
  if (volume() < 0) std::swap(body[2], body[3]);
  return body;
}

Polyhedron random_body(std::mt19937& random, int size, bool is_box) {
  if (!is_box) {
    const Body body = random_tetrahedron(random, size);
    return {{body.begin(), body.end()}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  }
  std::uniform_int_distribution<int> coordinate(0, size - 1);
  std::uniform_int_distribution<int> length(1, size);
  const Point3 low{coordinate(random), coordinate(random), coordinate(random)};
  return box(low, low + Vector3{length(random), length(random), length(random)});
}

// LAW fill.2 and fill.3, on grids so small that every way of touching occurs.
class FillRuleOnAGrid : public ::testing::TestWithParam<std::tuple<int, bool>> {};

TEST_P(FillRuleOnAGrid, IsTheUnionAndTheSymmetricDifference) {
  const auto [size, is_box] = GetParam();
  std::mt19937 random(2026);
  for (int round = 0; round < 40; ++round) {
    const int count = 2 + round % 5;
    Polyhedron soup;
    Solid united;
    Solid parity;
    for (int i = 0; i < count; ++i) {
      const Polyhedron body = random_body(random, size, is_box);
      soup = together(soup, triangulated(body));
      const Solid solid = Solid::primitive({make_convex_polytope(body)});
      united = i == 0 ? solid : csg::unite(united, solid);
      parity = i == 0 ? solid : csg::symmetric_difference(parity, solid);
    }
    const std::string expected_union = digest(evaluate(united));
    const std::string expected_parity = digest(evaluate(parity));
    ASSERT_EQ(digest(filled_boundary(soup, FillRule::NonZero)), expected_union) << round;
    ASSERT_EQ(digest(filled_boundary(soup, FillRule::Positive)), expected_union) << round;
    ASSERT_EQ(digest(filled_boundary(soup, FillRule::EvenOdd)), expected_parity) << round;
    EvaluateOptions parallel;
    parallel.threads = 2;
    const Polyhedron turned = reversed(soup);
    ASSERT_EQ(digest(filled_boundary(turned, FillRule::NonZero, parallel)), expected_union);
    ASSERT_EQ(digest(filled_boundary(turned, FillRule::EvenOdd, parallel)), expected_parity);
    ASSERT_TRUE(filled_boundary(turned, FillRule::Positive).empty());
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, FillRuleOnAGrid,
                         ::testing::Combine(::testing::Values(2, 3, 5, 40), ::testing::Bool()));

using Double3 = std::array<double, 3>;

// The solid angle of a triangle seen from a point (A. van Oosterom and J. Strackee, "The solid
// angle of a plane triangle", IEEE Transactions on Biomedical Engineering 30, 1983).
double solid_angle(const Double3& from, const std::array<Double3, 3>& corners) {
  std::array<Double3, 3> r{};
  std::array<double, 3> length{};
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < 3; ++i) r[k][i] = corners[k][i] - from[i];
    length[k] = std::hypot(r[k][0], r[k][1], r[k][2]);
  }
  const auto inner = [&](std::size_t a, std::size_t b) {
    return r[a][0] * r[b][0] + r[a][1] * r[b][1] + r[a][2] * r[b][2];
  };
  const double triple = r[0][0] * (r[1][1] * r[2][2] - r[1][2] * r[2][1]) +
                        r[0][1] * (r[1][2] * r[2][0] - r[1][0] * r[2][2]) +
                        r[0][2] * (r[1][0] * r[2][1] - r[1][1] * r[2][0]);
  const double denominator = length[0] * length[1] * length[2] + inner(0, 1) * length[2] +
                             inner(0, 2) * length[1] + inner(1, 2) * length[0];
  return 2 * std::atan2(triple, denominator);
}

int winding_number(const Polyhedron& mesh, const Point3& point) {
  const auto near = [](const Point3& p) {
    return Double3{nearest_double(p.x), nearest_double(p.y), nearest_double(p.z)};
  };
  double total = 0;
  for (const Facet& f : mesh.facets) {
    total += solid_angle(near(point), {near(mesh.vertices[f[0]]), near(mesh.vertices[f[1]]),
                                       near(mesh.vertices[f[2]])});
  }
  return static_cast<int>(std::lround(total / (4 * std::numbers::pi)));
}

// A tube round a closed curve that winds twice round an axis, thick enough to meet itself.
Polyhedron twisted_torus(std::uint32_t along, std::uint32_t around, double thickness) {
  Polyhedron mesh;
  for (std::uint32_t i = 0; i < along; ++i) {
    const double t = 4 * std::numbers::pi * i / along;
    const double radius = 2 + 0.5 * std::cos(1.5 * t);
    for (std::uint32_t j = 0; j < around; ++j) {
      const double s = 2 * std::numbers::pi * j / around;
      const double r = radius + thickness * std::cos(s);
      const double z = 0.5 * std::sin(1.5 * t) + thickness * std::sin(s);
      mesh.vertices.push_back(
          {rational_of(r * std::cos(t)), rational_of(r * std::sin(t)), rational_of(z)});
    }
  }
  const auto at = [&](std::uint32_t i, std::uint32_t j) {
    return (i % along) * around + j % around;
  };
  for (std::uint32_t i = 0; i < along; ++i) {
    for (std::uint32_t j = 0; j < around; ++j) {
      mesh.facets.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.facets.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

// Shells of a boundary as a mesh of fans, to ask points of it: its loops need not be convex, but
// winding numbers of fans add up all the same.
Polyhedron fans_of(const Boundary& boundary) {
  Polyhedron mesh{to_vector(boundary.vertices), {}};
  for (const BoundaryFace& face : boundary.faces) {
    for (const auto& loop : face.loops) {
      for (std::size_t k = 2; k < loop.size(); ++k) {
        mesh.facets.push_back({loop[0], loop[k - 1], loop[k]});
      }
    }
  }
  return mesh;
}

TEST(FillRule, TwistedTorusByItsSolidAngles) {
  for (const Polyhedron& mesh : {twisted_torus(48, 12, 0.7), twisted_torus(24, 8, 2.6)}) {
    std::mt19937 random(7);
    std::uniform_int_distribution<int> coordinate(-4096, 4096);
    for (const FillRule rule : all_rules) {
      const Boundary boundary = filled_boundary(mesh, rule);
      const Polyhedron filled = fans_of(boundary);
      int inside = 0;
      for (int k = 0; k < 60; ++k) {
        const Point3 point{Rational(coordinate(random)) / 1000, Rational(coordinate(random)) / 1000,
                           Rational(coordinate(random)) / 2000};
        const int expected = is_inside(rule, winding_number(mesh, point)) ? 1 : 0;
        ASSERT_EQ(winding_number(filled, point), expected)
            << name_of(rule) << " at " << to_text(point.x) << ", " << to_text(point.y) << ", "
            << to_text(point.z);
        inside += expected;
      }
      EXPECT_GT(inside, 5);
    }
  }
}

}  // namespace
}  // namespace exactcsg
