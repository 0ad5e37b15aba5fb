// SPDX-License-Identifier: GPL-3.0-or-later
// The evaluator against closed forms.
#include "exactcsg/solid/evaluate.hpp"

#include <gtest/gtest.h>

#include <map>
#include <tuple>

#include "exactcsg/solid/classify.hpp"
#include "exactcsg/solid/face_planes.hpp"
#include "exactcsg/solid/measures.hpp"

namespace exactcsg {
namespace {

Rational negative_power_of_two(unsigned long exponent) {
  Rational power = 1;
  mpq_div_2exp(power.get_mpq_t(), power.get_mpq_t(), exponent);
  return power;
}

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

void expect_counts(const Solid& solid, std::size_t vertices, std::size_t edges, std::size_t faces) {
  const Boundary b = evaluate(solid);
  EXPECT_EQ(b.vertices.size(), vertices);
  EXPECT_EQ(b.edges.size(), edges);
  EXPECT_EQ(b.faces.size(), faces);
}

// A triangular prism along x whose lowest edge, y = 1 and z = 2, runs from x0 to x1.
Solid prism_on_edge(const Rational& x0, const Rational& x1) {
  const Rational low(1, 2);
  const Rational high(3, 2);
  return Solid::primitive({make_convex_polytope(
      Polyhedron{{{x0, 1, 2}, {x1, 1, 2}, {x0, low, 3}, {x1, low, 3}, {x0, high, 3}, {x1, high, 3}},
                 {{0, 2, 4}, {1, 5, 3}, {1, 3, 2, 0}, {4, 5, 1, 0}, {3, 5, 4, 2}}})});
}

// Counts by hand: what only touches still makes vertices where edges of two directions meet.
TEST(CanonicalBoundary, TouchingEdgesAndVertices) {
  const Solid cube = box(0, 0, 0, 2, 2, 2);
  // The prism's edge lies in the middle of the cube's top.
  expect_counts(csg::unite(cube, prism_on_edge(Rational(1, 2), Rational(3, 2))), 8 + 6, 12 + 9,
                6 + 5);
  // It juts out on both sides: it and two edges of the top are cut at two new vertices.
  expect_counts(csg::unite(cube, prism_on_edge(-1, 3)), 8 + 6 + 2, 12 + 2 + 9 + 2, 6 + 5);
  // A pyramid stands on its tip in the middle of an edge of the cube.
  const Solid pyramid = Solid::primitive({make_convex_polytope(
      Polyhedron{{{1, 0, 2}, {0, -1, 4}, {2, -1, 4}, {2, 1, 4}, {0, 1, 4}},
                 {{1, 2, 3, 4}, {0, 2, 1}, {0, 3, 2}, {0, 4, 3}, {0, 1, 4}}})});
  expect_counts(csg::unite(cube, pyramid), 8 + 5, 12 + 1 + 8, 6 + 5);
  // Two cubes that share an edge only, and two that share a corner only.
  expect_counts(csg::unite(box(0, 0, 0, 1, 1, 1), box(1, 1, 0, 2, 2, 1)), 14, 23, 12);
  expect_counts(csg::unite(box(0, 0, 0, 1, 1, 1), box(1, 1, 1, 2, 2, 2)), 15, 24, 12);
}

// A prism with an edge on the z axis from z0 to z1; u and v are the other corners of its section,
// counter-clockwise.
Solid prism_on_axis(const Rational& z0, const Rational& z1, const Vector3& u, const Vector3& v) {
  return Solid::primitive({make_convex_polytope(Polyhedron{
      {{0, 0, z0}, {u.x, u.y, z0}, {v.x, v.y, z0}, {0, 0, z1}, {u.x, u.y, z1}, {v.x, v.y, z1}},
      {{0, 2, 1}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}})});
}

// No two facets lie in one plane, and yet edges meet: counts by hand.
TEST(CanonicalBoundary, EdgesOfFacetsAloneInTheirPlanes) {
  const Vector3 u{1, 0, 0};
  const Vector3 v{1, 1, 0};
  const Vector3 opposite_u{-3, -1, 0};
  const Vector3 opposite_v{-3, -2, 0};
  const Solid prism = prism_on_axis(0, 2, u, v);
  // The edges on the axis, [0, 2] and [1, 3], have [1, 2] in common: three edges for two.
  const Solid shifted = prism_on_axis(1, 3, opposite_u, opposite_v);
  expect_counts(csg::unite(prism, shifted), 6 + 6, 9 + 9 + 1, 5 + 5);
  // One inside the other: three edges for two as well.
  const Solid shorter = prism_on_axis(Rational(1, 2), 1, opposite_u, opposite_v);
  expect_counts(csg::unite(prism, shorter), 6 + 6, 9 + 9 + 1, 5 + 5);
  expect_counts(csg::unite(shorter, prism), 6 + 6, 9 + 9 + 1, 5 + 5);
  // [0, 2] and [2, 3] share a vertex only.
  const Solid above = prism_on_axis(2, 3, opposite_u, opposite_v);
  expect_counts(csg::unite(prism, above), 6 + 6 - 1, 9 + 9, 5 + 5);
  // Three in a row on the axis beside one long edge, which they cut into [0, 1], [1, 2], [2, 3].
  const Solid row = csg::unite(prism_on_axis(0, 1, opposite_u, opposite_v),
                               csg::unite(prism_on_axis(1, 2, {0, -1, 0}, {1, -5, 0}),
                                          prism_on_axis(2, 3, {-7, 1, 0}, {-7, -1, 0})));
  expect_counts(csg::unite(prism_on_axis(0, 3, u, v), row), 4 * 6 - 4, 4 * 9 - 1, 4 * 5);
  // An edge along y crosses the one along z at a point inside both.
  const AffineMap to_y{{{{0, 1, 0, 0}, {0, 0, 1, -1}, {1, 0, 0, 1}}}};
  const Solid across = apply(to_y, prism_on_axis(0, 2, {0, -1, 0}, {1, -3, 0}));
  expect_counts(csg::unite(prism, across), 6 + 6 + 1, 9 + 9 + 2, 5 + 5);
  // LAW boundary.1: the same solid from halves, whose common facets have two in one plane.
  const auto in_halves = [&](const Solid& other) {
    return csg::unite(
        csg::unite(prism_on_axis(0, Rational(1, 3), u, v), prism_on_axis(Rational(1, 3), 2, u, v)),
        other);
  };
  for (const Solid& other : {shifted, shorter, above, across}) {
    EXPECT_EQ(digest(evaluate(csg::unite(prism, other))), digest(evaluate(in_halves(other))));
  }
}

// LAW boundary.1
TEST(CanonicalBoundary, DoesNotDependOnTreeCellsOrThreads) {
  AffineMap turn = AffineMap::identity();
  turn.m[0] = {Rational(3, 5), Rational(-4, 5), 0, Rational(1, 7)};
  turn.m[1] = {Rational(4, 5), Rational(3, 5), 0, 0};
  std::vector<Solid> parts;
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j) {
      parts.push_back(box(i, j, 0, i + 1, j + 1, 1 + (i * j) % 3));
      parts.push_back(apply(turn, box(i, j, 0, i + 1, j + 1, 1 + (i + j) % 2)));
    }
  }
  const Solid flat = Solid::compose(csg::BooleanOperator::Union, parts);
  Solid chain;
  for (auto part = parts.rbegin(); part != parts.rend(); ++part) chain = csg::unite(chain, *part);
  const auto key = [](const Boundary& b) {
    std::vector<std::vector<std::vector<std::uint32_t>>> loops;
    for (const BoundaryFace& face : b.faces) loops.push_back(face.loops);
    return std::make_tuple(to_vector(b.vertices), b.edges, exact_planes(b), loops);
  };
  const Boundary reference = evaluate(flat);
  EXPECT_FALSE(reference.empty());
  EXPECT_EQ(key(evaluate(chain)), key(reference));
  for (const std::size_t facets : {4U, 60U, 100000U}) {
    for (const unsigned threads : {1U, 2U, 0U}) {
      EvaluateOptions options;
      options.facets_per_cell = facets;
      options.threads = threads;
      EXPECT_EQ(key(evaluate(flat, options)), key(reference)) << facets << ' ' << threads;
    }
  }
}

// LAW boundary.1 where there is enough to be done in parts, of every kind: facets that are cut and
// those that are not, faces joined over many cells, coplanar neighbours, edges that touch others,
// vertices where faces touch themselves.
TEST(CanonicalBoundary, DoesNotDependOnThreadsInLargeScenes) {
  AffineMap turn = AffineMap::identity();
  turn.m[0] = {Rational(3, 5), Rational(-4, 5), 0, Rational(1, 7)};
  turn.m[1] = {Rational(4, 5), Rational(3, 5), 0, 0};
  std::vector<Solid> parts;
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 20; ++j) {
      if ((i + j) % 3 != 0) parts.push_back(box(i, j, 0, i + 1, j + 1, 1 + (i * j) % 3));
      if ((i * j) % 2 == 0) {
        parts.push_back(apply(turn, box(i, j, 0, i + 1, j + 1, 1 + (i + j) % 2)));
      }
      // Alone; every second one touches its neighbour along a side or in a corner.
      parts.push_back(box(3 * i, 3 * j, 9, 3 * i + 2 + i % 2, 3 * j + 2 + j % 2, 10));
      AffineMap shift = AffineMap::identity();
      for (std::size_t axis = 0; axis < 3; ++axis)
        shift.m[axis][3] = axis == 2 ? 10 : 3 * (axis == 0 ? i : j);
      parts.push_back(apply(shift, apply(turn, box(0, 0, 0, 1, 1, 1 + i % 3))));
    }
  }
  const Solid solid = Solid::compose(csg::BooleanOperator::Union, parts);
  const Boundary reference = evaluate(solid);
  EXPECT_GT(reference.faces.size(), 2U * 2048U);
  const auto loops_of = [](const Boundary& boundary) {
    std::vector<std::vector<std::vector<std::uint32_t>>> loops;
    for (const BoundaryFace& face : boundary.faces) loops.push_back(face.loops);
    return loops;
  };
  for (const unsigned threads : {2U, 0U}) {
    EvaluateOptions options;
    options.threads = threads;
    const Boundary boundary = evaluate(solid, options);
    EXPECT_EQ(boundary.vertices, reference.vertices);
    EXPECT_EQ(boundary.approximate, reference.approximate);
    EXPECT_EQ(boundary.edges, reference.edges);
    EXPECT_EQ(loops_of(boundary), loops_of(reference));
    EXPECT_EQ(exact_planes(boundary), exact_planes(reference));
    EXPECT_EQ(boundary.statistics.tiers, reference.statistics.tiers);
  }
}

// LAW boundary.2 where doubles do not tell coordinates apart: some equal, some not.
TEST(CanonicalBoundary, VerticesAscendExactlyWhereDoublesAreEqual) {
  const Rational third(1, 3);
  std::vector<Solid> parts;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      // The farther in x by far less than a unit in the last place, the lower in y, and so on.
      const Rational little = Rational(i % 3, 1) * negative_power_of_two(120);
      parts.push_back(box(third + little, 3 * j - i * 20, third - little, 1, 3 * j + 2 - i * 20,
                          third + 5 + Rational(j % 2, 1) * negative_power_of_two(130)));
    }
  }
  const Boundary boundary = evaluate(Solid::compose(csg::BooleanOperator::Union, parts));
  ASSERT_EQ(boundary.vertices.size(), 8U * parts.size());
  std::size_t alike = 0;
  for (std::size_t i = 0; i + 1 < boundary.vertices.size(); ++i) {
    EXPECT_TRUE(boundary.vertices[i] < boundary.vertices[i + 1]) << i;
    if (boundary.approximate[i][0] == boundary.approximate[i + 1][0] &&
        boundary.vertices[i].x != boundary.vertices[i + 1].x) {
      ++alike;
    }
  }
  EXPECT_GT(alike, 1U);
}

// LAW boundary.3
TEST(CanonicalBoundary, DirectedEdgesBalance) {
  const Boundary b = evaluate(sponge(2));
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
  for (const BoundaryFace& face : b.faces) {
    for (const auto& loop : face.loops) {
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const std::uint32_t from = loop[i];
        const std::uint32_t to = loop[(i + 1) % loop.size()];
        balance[std::minmax(from, to)] += from < to ? 1 : -1;
      }
    }
  }
  EXPECT_EQ(balance.size(), b.edges.size());
  for (const auto& [edge, sum] : balance) EXPECT_EQ(sum, 0) << edge.first << ' ' << edge.second;
}

// A chain a million nodes deep: built, evaluated and destroyed without recursion.
TEST(Evaluate, MillionDeepChain) {
  const Solid a = box(0, 0, 0, 3, 1, 1);
  const Solid b = box(1, 0, 0, 2, 1, 1);
  Solid chain = a;
  for (int i = 0; i < 500'000; ++i) chain = csg::unite(csg::subtract(chain, b), a);
  chain = csg::subtract(chain, b);
  EXPECT_EQ(volume(evaluate(chain)), 2);  // 3 - 1
  EXPECT_EQ(classify(chain, {Rational(3, 2), Rational(1, 2), Rational(1, 2)}), PointClass::Out);
}

// Many equal and nearly equal operands: no cell ever gets few facets.
TEST(Evaluate, ManyCoincidentOperands) {
  std::vector<Solid> parts;
  for (int i = 0; i < 60; ++i) parts.push_back(box(0, 0, 0, 1, 1, 1));
  EXPECT_EQ(volume(evaluate(Solid::compose(csg::BooleanOperator::Union, parts))), 1);
  for (int i = 0; i < 30; ++i) {
    parts.push_back(box(0, 0, 0, 1, 1, 1 + Rational(i) / Rational("1000000000000000000")));
  }
  EXPECT_EQ(volume(evaluate(Solid::compose(csg::BooleanOperator::Union, parts))),
            1 + 29 / Rational("1000000000000000000"));
}

// Cell walls divide the facets of both bars, and other primitives' planes do; one box of each is
// cut by nothing else. LAW whole.1 is that of the digests, the count says that parts were joined.
TEST(Evaluate, FacetsThatOnlyWallsCutStayWhole) {
  std::vector<Solid> parts;
  for (int i = 0; i < 12; ++i) parts.push_back(box(2 * i, 0, 0, 2 * i + 1, 9, 9));
  const Solid row = Solid::compose(csg::BooleanOperator::Union, parts);
  EvaluateOptions fine;
  fine.facets_per_cell = 3;
  const Boundary apart = evaluate(row, fine);
  EXPECT_GT(apart.statistics.cells, 12U);
  EXPECT_EQ(apart.statistics.pieces, 12U * 6U);
  // Inside out as well: the facets of what is taken away are turned.
  const Boundary holes = evaluate(csg::subtract(box(-1, -1, -1, 24, 10, 10), row), fine);
  EXPECT_EQ(holes.statistics.pieces, 13U * 6U);
  EXPECT_EQ(volume(holes), 25 * 11 * 11 - 12 * 81);
}

// Upright prisms with their corners on a parabola; n + 2 facets. No two have a plane in common.
Polyhedron parabolic_prism(std::uint32_t n, int shift) {
  Polyhedron prism;
  Facet base;
  Facet top;
  for (std::uint32_t i = 0; i < n; ++i) {
    const Rational x = Rational(i) + Rational(shift, 7);
    const Rational y = Rational(i * i) + Rational(shift, 11);
    prism.vertices.push_back({x, y, shift});
    prism.vertices.push_back({x, y, shift + 9});
    const std::uint32_t next = (i + 1) % n;
    prism.facets.push_back({2 * i, 2 * next, 2 * next + 1, 2 * i + 1});
    base.insert(base.begin(), 2 * i);
    top.push_back(2 * i + 1);
  }
  prism.facets.push_back(base);
  prism.facets.push_back(top);
  return prism;
}

// All facets reach the root cell, and only they say whether it is divided.
std::uint64_t cells_of_union(const std::vector<std::uint32_t>& facet_counts,
                             const EvaluateOptions& options = {}) {
  std::vector<Solid> prisms;
  for (const std::uint32_t count : facet_counts) {
    const Polyhedron prism = parabolic_prism(count - 2, static_cast<int>(prisms.size()));
    prisms.push_back(Solid::primitive({make_convex_polytope(prism)}));
  }
  return evaluate(Solid::compose(csg::BooleanOperator::Union, prisms), options).statistics.cells;
}

// One cell as long as the facets are no more than 10/6 of `facets_per_cell` where two convex
// primitives have them, 7/6 where three have, and `facets_per_cell` itself otherwise: of 24, these
// are 40 and 28; of 12, 20 and 14. With one more there are at least two cells.
TEST(Evaluate, CellsOfTwoOrThreeConvexPrimitivesMayBeLarger) {
  EXPECT_EQ(cells_of_union({20, 20}), 1U);
  EXPECT_GE(cells_of_union({20, 21}), 2U);
  EXPECT_EQ(cells_of_union({9, 9, 10}), 1U);
  EXPECT_GE(cells_of_union({9, 10, 10}), 2U);
  EXPECT_EQ(cells_of_union({6, 6, 6, 6}), 1U);
  EXPECT_GE(cells_of_union({6, 6, 6, 7}), 2U);
  EvaluateOptions half;
  half.facets_per_cell = 12;
  EXPECT_EQ(cells_of_union({10, 10}, half), 1U);
  EXPECT_GE(cells_of_union({10, 11}, half), 2U);
  // A mesh's cells stay small, however few its facets are.
  const Solid polytope = Solid::primitive({make_convex_polytope(parabolic_prism(18, 0))});
  const Solid mesh = Solid::primitive({make_mesh(parabolic_prism(18, 1))});
  EXPECT_GE(evaluate(csg::unite(polytope, mesh)).statistics.cells, 2U);
}

// An L-shaped mesh against boxes: volumes by hand (the L has volume 3).
TEST(Evaluate, MeshesAreLeavesToo) {
  Polyhedron l;
  for (int z = 0; z < 2; ++z) {
    for (const auto& [x, y] : std::vector<std::pair<int, int>>{
             {0, 0}, {1, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}, {0, 1}}) {
      l.vertices.push_back({x, y, z});
    }
  }
  for (std::uint32_t i = 0; i < 8; ++i) {
    l.facets.push_back({i, (i + 1) % 8, (i + 1) % 8 + 8, i + 8});
  }
  for (const Facet& cap : {Facet{0, 1, 2, 3, 4, 7}, Facet{7, 4, 5, 6}}) {
    l.facets.emplace_back(cap.rbegin(), cap.rend());
    l.facets.push_back(cap);
    for (std::uint32_t& v : l.facets.back()) v += 8;
  }
  const Solid mesh = Solid::primitive({make_mesh(l)});
  expect_counts(mesh, 12, 18, 8);
  EXPECT_EQ(volume(evaluate(mesh)), 3);
  const Rational half(1, 2);
  const Solid cutter = box(half, half, -1, 3, 3, half);
  // The L's part over [1/2, 2]^2 is 9/4 - 1; up to z = 1/2 half of that.
  EXPECT_EQ(volume(evaluate(csg::intersect(mesh, cutter))), Rational(5, 8));
  EXPECT_EQ(volume(evaluate(csg::subtract(mesh, cutter))), 3 - Rational(5, 8));
  EXPECT_EQ(volume(evaluate(csg::subtract(box(0, 0, 0, 2, 2, 1), mesh))), 1);
  expect_counts(csg::subtract(box(0, 0, 0, 2, 2, 1), mesh), 8, 12, 6);
  AffineMap shift = AffineMap::identity();
  EvaluateOptions fine;
  fine.facets_per_cell = 3;
  shift.m[2][3] = 1;
  const Boundary stacked = evaluate(csg::unite(mesh, apply(shift, mesh)), fine);
  EXPECT_EQ(volume(stacked), 6);
  EXPECT_EQ(stacked.vertices.size(), 12U);
}

TEST(Evaluate, StopsWhenCancelled) {
  Progress progress;
  progress.cancel(ErrorId::TimeLimit);
  EvaluateOptions options;
  options.progress = &progress;
  try {
    evaluate(sponge(1), options);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.id(), ErrorId::TimeLimit);
  }
}

}  // namespace
}  // namespace exactcsg
