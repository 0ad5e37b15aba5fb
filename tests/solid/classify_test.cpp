// SPDX-License-Identifier: GPL-3.0-or-later
// Point membership classification: single points, retained decomposition, equality with witnesses.
#include "exactcsg/solid/classify.hpp"

#include <gtest/gtest.h>

#include <random>

namespace exactcsg {
namespace {

Solid box(const Rational& x0, const Rational& y0, const Rational& z0, const Rational& x1,
          const Rational& y1, const Rational& z1) {
  return Solid::primitive({make_box({x0, y0, z0}, {x1, y1, z1})});
}

TEST(Classify, OfABox) {
  const Solid b = box(0, 0, 0, 1, 1, 1);
  const Rational half(1, 2);
  EXPECT_EQ(classify(b, {half, half, half}), PointClass::In);
  EXPECT_EQ(classify(b, {half, half, 1}), PointClass::On);
  EXPECT_EQ(classify(b, {1, 1, 1}), PointClass::On);
  EXPECT_EQ(classify(b, {half, half, Rational("1000000000000000000001/1000000000000000000000")}),
            PointClass::Out);
}

// The classical failure of pairwise tables: a point On both operands may be In their union, On it,
// or (of their intersection) Out of it.
TEST(Classify, OnOnIsDecidedByNeighbourhoods) {
  const Rational half(1, 2);
  const Solid left = box(0, 0, 0, 1, 1, 1);
  const Solid right = box(1, 0, 0, 2, 1, 1);
  EXPECT_EQ(classify(csg::unite(left, right), {1, half, half}), PointClass::In);
  EXPECT_EQ(classify(csg::unite(left, right), {1, half, 1}), PointClass::On);
  EXPECT_EQ(classify(csg::intersect(left, right), {1, half, half}), PointClass::Out);
  EXPECT_EQ(classify(csg::subtract(left, right), {1, half, half}), PointClass::On);
  // Eight octants meet in a point: only all of them fill its neighbourhood.
  std::vector<Solid> octants;
  for (int i = 0; i < 8; ++i) {
    octants.push_back(box(i & 1 ? 0 : -1, i & 2 ? 0 : -1, i & 4 ? 0 : -1, i & 1 ? 1 : 0,
                          i & 2 ? 1 : 0, i & 4 ? 1 : 0));
  }
  EXPECT_EQ(classify(Solid::compose(csg::BooleanOperator::Union, octants), {0, 0, 0}),
            PointClass::In);
  octants.pop_back();
  EXPECT_EQ(classify(Solid::compose(csg::BooleanOperator::Union, octants), {0, 0, 0}),
            PointClass::On);
}

Polyhedron l_shape() {
  // An L-shaped prism: the square [0,2]^2 less [1,2]^2, z from 0 to 1; caps as two rectangles each.
  Polyhedron p;
  for (int z = 0; z < 2; ++z) {
    for (const auto& [x, y] : std::vector<std::pair<int, int>>{
             {0, 0}, {1, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}, {0, 1}}) {
      p.vertices.push_back({x, y, z});
    }
  }
  for (std::uint32_t i = 0; i < 8; ++i) {
    const std::uint32_t j = (i + 1) % 8;
    p.facets.push_back({i, j, j + 8, i + 8});
  }
  const auto cap = [&](std::vector<std::uint32_t> loop) {
    Facet top;
    for (const std::uint32_t v : loop) top.push_back(v + 8);
    p.facets.push_back(top);
    p.facets.emplace_back(loop.rbegin(), loop.rend());
  };
  cap({0, 1, 2, 3, 4, 7});
  cap({7, 4, 5, 6});
  return p;
}

TEST(Classify, OfAMesh) {
  const Solid mesh = Solid::primitive({make_mesh(l_shape())});
  const Rational half(1, 2);
  EXPECT_EQ(classify(mesh, {half, half, half}), PointClass::In);
  EXPECT_EQ(classify(mesh, {Rational(3, 2), Rational(3, 2), half}), PointClass::Out);
  EXPECT_EQ(classify(mesh, {1, Rational(3, 2), half}), PointClass::On);
  EXPECT_EQ(classify(mesh, {1, 1, half}), PointClass::On);     // the reflex edge
  EXPECT_EQ(classify(mesh, {1, half, half}), PointClass::In);  // between two cap facets' seam
  EXPECT_EQ(classify(mesh, {half, 1, 1}), PointClass::On);     // on the seam itself
  // With the missing square the reflex edge lies inside.
  const Solid whole = csg::unite(mesh, box(1, 1, 0, 2, 2, 1));
  EXPECT_EQ(classify(whole, {1, 1, half}), PointClass::In);
  EXPECT_FALSE(find_difference(whole, box(0, 0, 0, 2, 2, 1)));
}

// LAW classify.1 on a solid with coincident, touching and crossing faces.
TEST(Classify, RetainedEqualsSingle) {
  std::vector<Solid> parts;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 3; ++j) {
      parts.push_back(box(i, j, 0, i + 1, j + 1, (i * j) % 3 + 1));
    }
  }
  parts.push_back(Solid::primitive({make_mesh(l_shape())}));
  AffineMap turn = AffineMap::identity();
  turn.m[0] = {Rational(3, 5), Rational(-4, 5), 0, 1};
  turn.m[1] = {Rational(4, 5), Rational(3, 5), 0, 0};
  const Solid solid =
      csg::subtract(Solid::compose(csg::BooleanOperator::Union, parts),
                    csg::unite(apply(turn, box(0, 0, -1, 1, 1, 2)), box(3, 2, 0, 5, 5, 5)));
  EvaluateOptions options;
  options.facets_per_cell = 6;
  const PointClassifier retained(solid, options);
  std::mt19937 random(20261122);
  std::array<int, 3> seen{};
  for (int i = 0; i < 4000; ++i) {
    const auto coordinate = [&](int span) {
      // Halves and fifths: most points lie in faces, edges or corners of something.
      const int denominator = random() % 2 == 0 ? 2 : 5;
      Rational value(
          static_cast<int>(random() % static_cast<unsigned>(span * denominator)) - denominator,
          denominator);
      value.canonicalize();
      return value;
    };
    const Point3 point{coordinate(6), coordinate(5), coordinate(5)};
    const PointClass single = classify(solid, point);
    ++seen[static_cast<std::size_t>(single)];
    ASSERT_EQ(retained(point), single)
        << to_text(point.x) << ' ' << to_text(point.y) << ' ' << to_text(point.z);
  }
  for (const int count : seen) EXPECT_GT(count, 100);
}

TEST(FindDifference, ThinCutsAreFound) {
  const Solid cube = box(0, 0, 0, 1, 1, 1);
  EXPECT_FALSE(find_difference(
      cube, csg::unite(box(0, 0, 0, Rational(1, 3), 1, 1), box(Rational(1, 3), 0, 0, 1, 1, 1))));
  for (const char* thickness : {"1/1000000000", "1/1000000000000000000000000000000"}) {
    const Solid cut = csg::subtract(cube, box(-1, -1, 1 - Rational(thickness), 2, 2, 2));
    const auto difference = find_difference(cube, cut);
    ASSERT_TRUE(difference);
    EXPECT_TRUE(difference->in_first);
    EXPECT_EQ(classify(cube, difference->witness), PointClass::In);
    EXPECT_EQ(classify(cut, difference->witness), PointClass::Out);
    EXPECT_FALSE(find_difference(cut, cube)->in_first);
  }
}

}  // namespace
}  // namespace exactcsg
