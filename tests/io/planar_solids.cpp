// SPDX-License-Identifier: GPL-3.0-or-later
// Every mesh goes through make_mesh, every polytope through make_convex_polytope again
// (checked_volume), so a volume is only compared if the surface is closed, planar and does not
// cross.
#include <gtest/gtest.h>

#include <chrono>

#include "planar_support.hpp"

namespace exactcsg::io::test {
namespace {

using Directions = std::vector<std::array<Rational, 2>>;

const Directions quarters{{1, 0}, {0, 1}, {-1, 0}, {0, -1}};

// The 3-4-5 turn and its powers are exact unit directions.
Directions turns_of_345(int count) {
  Directions result{{1, 0}};
  const Rational c(3, 5);
  const Rational s(4, 5);
  for (int i = 1; i < count; ++i) {
    const auto& d = result.back();
    result.push_back({c * d[0] - s * d[1], s * d[0] + c * d[1]});
  }
  return result;
}

std::size_t primitives_of(const Solid& solid) {
  std::size_t count = 0;
  checked_volume(solid, &count);
  return count;
}

bool all_convex(const Solid& solid) {
  bool convex = true;
  csg::for_each_primitive(solid, [&](const Primitive& primitive) {
    convex = convex && std::holds_alternative<ConvexPolytope>(primitive.shape);
  });
  return convex;
}

PlanarTree l_shape() { return figure({{{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}}); }

TEST(PlanarLinearExtrude, AConvexFigureIsOnePolytope) {
  const Solid prism = linear_extrude(figure({circle(1, 2, 3, 30)}), {-1, 4, {1, 1}, {}});
  ASSERT_TRUE(prism.is_primitive());
  EXPECT_TRUE(all_convex(prism));
  EXPECT_EQ(checked_volume(prism), 5 * area(circle(1, 2, 3, 30)));
}

TEST(PlanarLinearExtrude, FiguresThatAreNotConvexAreMeshes) {
  const LinearExtrusion two{0, 2, {1, 1}, {}};
  EXPECT_EQ(checked_volume(linear_extrude(l_shape(), two)), 2 * 5);
  const PlanarTree rings =
      figure({rectangle(0, 0, 10, 10), rectangle(1, 1, 9, 9), rectangle(2, 2, 8, 8)});
  EXPECT_EQ(checked_volume(linear_extrude(rings, two)), 2 * (100 - 64 + 36));
  // A bow tie touches itself in a vertex: two prisms.
  const Solid bow = linear_extrude(figure({{{0, 0}, {2, 2}, {2, 0}, {0, 2}}}), two);
  EXPECT_EQ(checked_volume(bow), 4);
  EXPECT_EQ(primitives_of(bow), 2U);
  // A ring pinched in one vertex: four facets meet in one vertical edge.
  const PlanarTree pinched = figure({rectangle(0, 0, 4, 4), {{0, 0}, {3, 1}, {3, 3}, {1, 3}}});
  EXPECT_EQ(checked_volume(linear_extrude(pinched, two)),
            2 * (16 - area(Path{{0, 0}, {3, 1}, {3, 3}, {1, 3}})));
  EXPECT_TRUE(linear_extrude(figure({rectangle(0, 0, 0, 4)}), two).is_empty());
  EXPECT_TRUE(linear_extrude(l_shape(), {2, 2, {1, 1}, {}}).is_empty());
}

TEST(PlanarLinearExtrude, TheTreeIsKept) {
  const PlanarTree hole = figure({circle(0, 0, 1, 12)});
  const Solid solid =
      linear_extrude(csg::subtract(csg::unite(box(-9, -9, 9, 9), hole), hole), {0, 1, {1, 1}, {}});
  ASSERT_TRUE(solid.is_compose());
  EXPECT_EQ(solid.operation(), csg::BooleanOperator::Difference);
  EXPECT_TRUE(same_handle(solid.children()[1], solid.children()[0].children()[1]));
  // Full becomes the slab.
  EXPECT_EQ(linear_extrude(PlanarTree::full(), {0, 1, {1, 1}, {}}).primitive_count(), 2U);
}

TEST(PlanarLinearExtrude, UniformScaleIsAFrustum) {
  // h (A + sqrt(A B) + B) / 3 with A = 16, B = 4.
  const Solid frustum =
      linear_extrude(box(-2, -2, 2, 2), {0, 3, {Rational(1, 2), Rational(1, 2)}, {}});
  EXPECT_TRUE(all_convex(frustum));
  EXPECT_EQ(checked_volume(frustum), 28);
  // A pyramid, its apex above the origin wherever the figure is: h A / 3.
  EXPECT_EQ(checked_volume(linear_extrude(box(5, 5, 6, 6), {0, 3, {0, 0}, {}})), 1);
  EXPECT_EQ(checked_volume(linear_extrude(l_shape(), {0, 3, {0, 0}, {}})), 5);
  // A hole stays a hole up to the apex.
  const PlanarTree ring = csg::subtract(box(-2, -2, 2, 2), box(-1, -1, 1, 1));
  EXPECT_EQ(checked_volume(linear_extrude(ring, {0, 3, {0, 0}, {}})), 12);
}

TEST(PlanarLinearExtrude, ScaleToARidge) {
  // The section at height t is a rectangle 4 by 4(1-t): the mean is 8.
  EXPECT_EQ(checked_volume(linear_extrude(box(-2, -2, 2, 2), {0, 3, {1, 0}, {}})), 24);
  EXPECT_EQ(checked_volume(linear_extrude(box(-2, -2, 2, 2), {0, 3, {0, 1}, {}})), 24);
  // Different corners on both sides of the ridge: a trapezium over base [-3, 3] with top [-1, 1].
  // The side edges converge in the triangles' planes: volume by the divergence theorem only, so
  // test that the mesh closes and stays between the inscribed and the circumscribed rectangle's.
  const Solid ridge =
      linear_extrude(figure({{{-3, -1}, {3, -1}, {1, 1}, {-1, 1}}}), {0, 3, {1, 0}, {}});
  const Rational volume = checked_volume(ridge);
  EXPECT_GT(volume, 6);   // [-1, 1] x [-1, 1]: 3 * 4 / 2
  EXPECT_LT(volume, 18);  // [-3, 3] x [-1, 1]: 3 * 12 / 2
}

TEST(PlanarLinearExtrude, TwistOfOneSlice) {
  // A square turned by the 3-4-5 angle over height 1. The section at height t of the four split
  // sides: corners (1-t) p + t R p, plus a corner on each diagonal, (1-t) p_i + t R p_(i+1) (or the
  // other one). Volume of such a slice (an antiprism-like prismatoid): h (A0 + 4 Am + A1) / 6,
  // because the section's area is quadratic in t.
  const Rational c(4, 5);
  const Rational s(3, 5);
  const LinearExtrusion twisted{0, 1, {1, 1}, {{c, s, {1, 1}}}};
  const Path base = rectangle(-1, -1, 1, 1);
  Path top;
  for (const Point2& p : base) top.push_back({c * p.x - s * p.y, s * p.x + c * p.y});
  Path middle;
  for (std::size_t i = 0; i < 4; ++i) {
    const Point2& p = base[i];
    const Point2& q = base[(i + 1) % 4];
    const Point2& p1 = top[i];
    const Point2& q1 = top[(i + 1) % 4];
    const auto squared = [](const Point2& a, const Point2& b) {
      return Rational((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y));
    };
    middle.push_back({(p.x + p1.x) / 2, (p.y + p1.y) / 2});
    const bool first = squared(p, q1) < squared(q, p1);
    middle.push_back(first ? Point2{(p.x + q1.x) / 2, (p.y + q1.y) / 2}
                           : Point2{(q.x + p1.x) / 2, (q.y + p1.y) / 2});
  }
  EXPECT_EQ(checked_volume(linear_extrude(box(-1, -1, 1, 1), twisted)),
            (area(base) + 4 * area(middle) + area(top)) / 6);
}

TEST(PlanarLinearExtrude, ManySlicesHolesAndScale) {
  LinearExtrusion extrusion{0, 10, {1, 1}, {}};
  const Directions turns = turns_of_345(2);
  Rational c = 1;
  Rational s = 0;
  const int slices = 12;
  for (int j = 1; j <= slices; ++j) {
    // A small exact turn: t = 1/12, (1 - t^2, 2 t) / (1 + t^2).
    const Rational t(1, 12);
    const Rational cos = (1 - t * t) / (1 + t * t);
    const Rational sin = 2 * t / (1 + t * t);
    const Rational c1 = c * cos - s * sin;
    s = s * cos + c * sin;
    c = c1;
    const Rational k = 1 - Rational(j) / (2 * slices);
    extrusion.levels.push_back({c, s, {k, k}});
  }
  const PlanarTree ring = csg::subtract(figure({circle(0, 0, 5, 20)}), box(-1, -1, 1, 2));
  const Solid solid = linear_extrude(ring, extrusion);
  const double volume = checked_volume(solid).get_d();
  // The smooth body's sections are scaled copies: A * integral of (1 - z/20)^2 = A * 10 * 7/12; the
  // chords of 12 slices and the split sides take away or add little.
  const double smooth = area(ring).get_d() * 10 * 7 / 12;
  EXPECT_NEAR(volume, smooth, smooth * 0.02);
  // To an apex, and to a ridge.
  extrusion.levels.back().scale = {0, 0};
  EXPECT_GT(checked_volume(linear_extrude(ring, extrusion)), 0);
  extrusion.levels.back().scale = {0, Rational(1, 2)};
  EXPECT_GT(checked_volume(linear_extrude(figure({circle(0, 0, 5, 20)}), extrusion)), 0);
}

// The volumes of OpenSCAD 2021.01's own OFF files for
//   linear_extrude(height = 10, twist = T, slices = n, scale = [sx, sy]) polygon(...)
// (six digits a coordinate). The other choice of diagonal, where two are equally long or below a
// ridge, or scaling before turning, would be off by 1% and more.
TEST(PlanarLinearExtrude, SplitsSidesAsOpenScadDoes) {
  const auto volume_of = [](const PlanarTree& tree, double twist, int slices,
                            std::array<double, 2> scale) {
    LinearExtrusion extrusion{0, 10, {1, 1}, {}};
    for (int j = 1; j <= slices; ++j) {
      const double t = static_cast<double>(j) / slices;
      const double angle = -twist * t * M_PI / 180;
      extrusion.levels.push_back(
          {Rational(std::cos(angle)),
           Rational(std::sin(angle)),
           {Rational(1 - (1 - scale[0]) * t), Rational(1 - (1 - scale[1]) * t)}});
    }
    return checked_volume(linear_extrude(tree, extrusion)).get_d();
  };
  constexpr double tolerance = 1e-3;
  const PlanarTree kite = figure({{{3, 1}, {6, 0}, {7, 3}, {4, 4}}});
  EXPECT_NEAR(volume_of(kite, 40, 2, {1, 1}), 97.989740, tolerance);
  EXPECT_NEAR(volume_of(kite, -70, 3, {0.5, 0.5}), 57.501847, tolerance);
  EXPECT_NEAR(volume_of(kite, -70, 3, {0.5, 2}), 108.594514, tolerance);
  EXPECT_NEAR(volume_of(kite, 0, 1, {1, 0}), 50.000000, tolerance);
  // A side on a ray from the origin: its diagonals are equally long.
  const Path on_ray{{1, 0}, {3, 0}, {2, Rational(3, 2)}};
  EXPECT_NEAR(volume_of(figure({on_ray}), 40, 1, {1, 1}), 15.972825, tolerance);
  EXPECT_NEAR(volume_of(figure({on_ray}), -40, 1, {1, 1}), 15.972820, tolerance);
  const PlanarTree holed = csg::subtract(box(-5, -5, 5, 5), figure({on_ray}));
  EXPECT_NEAR(volume_of(holed, 40, 1, {1, 1}), 1120.304482, tolerance);
  EXPECT_NEAR(volume_of(holed, -40, 1, {1, 1}), 1120.304488, tolerance);
  // OpenSCAD's sides cross here (48.353629 by the divergence theorem); ours take other diagonals.
  EXPECT_GT(volume_of(kite, 30, 2, {1, 0}), 48.4);
}

TEST(PlanarLinearExtrude, RefusesByName) {
  const auto id_of = [](const LinearExtrusion& extrusion) {
    try {
      linear_extrude(box(1, 1, 2, 2), extrusion);
    } catch (const Error& error) {
      return error.id();
    }
    return ErrorId::Usage;
  };
  EXPECT_EQ(id_of({0, 1, {-1, 1}, {}}), ErrorId::BadArgument);
  EXPECT_EQ(id_of({0, 1, {1, 1}, {{1, 0, {0, 0}}, {1, 0, {1, 1}}}}), ErrorId::BadArgument);
}

TEST(PlanarRotateExtrude, ARectangleBesideTheAxis) {
  // Through four directions the ring's section is a square of half diagonal r: area 2 r^2.
  const Solid ring = rotate_extrude(box(2, 0, 3, 5), quarters, true);
  EXPECT_EQ(checked_volume(ring), 5 * (2 * 9 - 2 * 4));
  // On the axis it is one convex prism.
  const Solid prism = rotate_extrude(box(0, 0, 3, 5), quarters, true);
  EXPECT_TRUE(all_convex(prism));
  EXPECT_EQ(checked_volume(prism), 5 * 2 * 9);
  // In the other sense the same solid.
  const Directions backwards(quarters.rbegin(), quarters.rend());
  EXPECT_EQ(checked_volume(rotate_extrude(box(2, 0, 3, 5), backwards, true)), 50);
  // Left of the axis: the same, half a turn on.
  EXPECT_EQ(checked_volume(rotate_extrude(box(-3, 0, -2, 5), quarters, true)), 50);
}

TEST(PlanarRotateExtrude, BipyramidsAndConvexity) {
  // A triangle with its side on the axis: a square bipyramid, 2 r^2 h / 3.
  const PlanarTree triangle = figure({{{0, 0}, {3, 1}, {0, 6}}});
  EXPECT_TRUE(all_convex(rotate_extrude(triangle, quarters, true)));
  EXPECT_EQ(checked_volume(rotate_extrude(triangle, quarters, true)), 2 * 9 * 6 / 3);
  // Convex, a side on the axis, but lower off the axis than on it: not convex. The frustum of
  // radii 3 and 1 has 2 h (9 + 3 + 1) / 3; the missing pyramid below 2 * 1 * 1 / 3.
  const PlanarTree crater = figure({{{0, 1}, {1, 0}, {3, 0}, {0, 6}}});
  const Solid solid = rotate_extrude(crater, quarters, true);
  EXPECT_FALSE(all_convex(solid));
  EXPECT_EQ(checked_volume(solid), 2 * 9 * 6 / 3 - Rational(2, 3));
  // A point on the axis only: two cones that share their apex with the outside.
  const Solid pinched = rotate_extrude(figure({{{0, 3}, {2, 0}, {2, 6}}}), quarters, true);
  EXPECT_EQ(checked_volume(pinched), 2 * 4 * 6 - 2 * (Rational(2 * 4 * 3) / 3));
}

TEST(PlanarRotateExtrude, PartsOfATurn) {
  // Guldin for chords: between two unit directions with sine S the sector of radius r has r^2 S
  // / 2.
  const Directions turns = turns_of_345(4);
  const Rational sector = 3 * Rational(4, 5) / 2;  // three steps, over r^2
  EXPECT_EQ(checked_volume(rotate_extrude(box(2, 0, 3, 5), turns, false)), 5 * (9 - 4) * sector);
  EXPECT_EQ(checked_volume(rotate_extrude(box(0, 0, 3, 5), turns, false)), 5 * 9 * sector);
  const PlanarTree ring = csg::subtract(box(1, 0, 5, 5), box(2, 1, 4, 4));
  EXPECT_EQ(checked_volume(rotate_extrude(ring, turns, false)),
            (5 * (25 - 1) - 3 * (16 - 4)) * sector);
  EXPECT_EQ(checked_volume(rotate_extrude(l_shape(), turns, false)), (9 + 2) * sector);
  // More than half a turn: three of four quarters.
  EXPECT_EQ(checked_volume(rotate_extrude(box(0, 0, 2, 1), quarters, false)), 3 * 4 / 2);
  const Directions three(quarters.begin(), quarters.begin() + 3);
  EXPECT_EQ(checked_volume(rotate_extrude(box(0, 0, 2, 1), three, false)), 2 * 4 / 2);
}

TEST(PlanarRotateExtrude, ATorusOfManyFacets) {
  const PlanarTree profile = figure({circle(5, 0, 2, 30)});
  Directions directions;
  for (int i = 0; i < 30; ++i) {
    directions.push_back(
        {Rational(std::cos(2 * M_PI * i / 30)), Rational(std::sin(2 * M_PI * i / 30))});
  }
  const Solid torus = rotate_extrude(profile, directions, true);
  // Pappus for polygons: area of the profile * 5 * (sum of sines of the steps).
  const double expected = area(profile).get_d() * 5 * 30 * std::sin(2 * M_PI / 30);
  EXPECT_NEAR(checked_volume(torus).get_d(), expected, 1e-9 * expected);
}

TEST(PlanarRotateExtrude, Components) {
  const PlanarTree two = csg::unite(box(1, 0, 2, 1), box(3, 0, 4, 1));
  const Solid rings = rotate_extrude(two, quarters, true);
  EXPECT_EQ(primitives_of(rings), 2U);
  EXPECT_EQ(checked_volume(rings), 2 * (4 - 1) + 2 * (16 - 9));
}

TEST(PlanarRotateExtrude, RefusesByName) {
  const auto id_of = [](const PlanarTree& tree, const Directions& directions, bool closed) {
    try {
      rotate_extrude(tree, directions, closed);
    } catch (const Error& error) {
      return error.id();
    }
    return ErrorId::Usage;
  };
  EXPECT_EQ(id_of(box(-1, 0, 1, 1), quarters, true), ErrorId::BadArgument);
  Directions five = quarters;
  five.push_back({1, 0});
  EXPECT_EQ(id_of(box(1, 0, 2, 1), five, false), ErrorId::BadArgument);
  EXPECT_EQ(id_of(box(1, 0, 2, 1), {{1, 0}, {0, 1}, {1, 0}}, false), ErrorId::BadArgument);
  EXPECT_TRUE(rotate_extrude(box(1, 0, 2, 1), Directions{{1, 0}, {-1, 0}}, false).is_empty());
  EXPECT_TRUE(rotate_extrude(PlanarTree::empty(), quarters, true).is_empty());
}

std::vector<Point3> cube_grid(int n) {
  std::vector<Point3> points;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      for (int k = 0; k <= n; ++k) points.push_back({i, j, k});
    }
  }
  return points;
}

TEST(PlanarHull3, MergesCoplanarFacets) {
  // All points of a grid, most of them on faces and edges: still six quadrilaterals of eight
  // corners.
  const Solid cube = hull(cube_grid(5));
  EXPECT_EQ(checked_volume(cube), 125);
  const auto& polyhedron = *std::get<ConvexPolytope>(cube.primitive().shape).polyhedron;
  EXPECT_EQ(polyhedron.facets.size(), 6U);
  EXPECT_EQ(polyhedron.vertices.size(), 8U);
}

TEST(PlanarHull3, TetrahedraAreTurnedOutwards) {
  // Every order of the corners gives the tetrahedron of volume 1/3 inscribed in the unit cube; CGAL
  // returns one turned inside out for half of them.
  std::vector<Point3> corners{{0, 0, 0}, {0, 1, 1}, {1, 0, 1}, {1, 1, 0}};
  EXPECT_EQ(checked_volume(hull(corners)), Rational(1, 3));
  for (Point3& p : corners) p.x = -p.x;
  EXPECT_EQ(checked_volume(hull(corners)), Rational(1, 3));
}

TEST(PlanarHull3, FlatSetsAreEmpty) {
  EXPECT_TRUE(hull(std::vector<Point3>{}).is_empty());
  EXPECT_TRUE(hull(std::vector<Point3>(7, {1, 2, 3})).is_empty());
  EXPECT_TRUE(hull(std::vector<Point3>{{0, 0, 0}, {1, 1, 1}, {3, 3, 3}, {2, 2, 2}}).is_empty());
  std::vector<Point3> plane;
  for (int i = 0; i < 9; ++i) plane.push_back({i % 3, i / 3, Rational(i % 3 + i / 3) / 3});
  EXPECT_TRUE(hull(plane).is_empty());
  // A third of a unit, no double: exactly not flat by 10^-40.
  plane.push_back({0, 0, Rational("1/10000000000000000000000000000000000000000")});
  EXPECT_FALSE(hull(plane).is_empty());
}

TEST(PlanarHull3, OfSolids) {
  const Solid boxes = csg::unite(Solid::primitive({make_box({0, 0, 0}, {1, 1, 1})}),
                                 Solid::primitive({make_box({2, 0, 0}, {3, 1, 1})}));
  EXPECT_EQ(checked_volume(hull(boxes)), 3);
  EXPECT_TRUE(hull(Solid::empty()).is_empty());
}

TEST(PlanarHull3, TenThousandPoints) {
  // On a sphere by rational points (t, u) -> (2t, 2u, 1 - t^2 - u^2) / (1 + t^2 + u^2): all of them
  // are corners, and no coordinate is a double.
  std::vector<Point3> points;
  for (int i = -50; i < 50; ++i) {
    for (int j = -50; j < 50; ++j) {
      const Rational t(i, 37);
      const Rational u(j, 41);
      const Rational n = 1 + t * t + u * u;
      points.push_back({2 * t / n, 2 * u / n, (2 - n) / n});
    }
  }
  const auto start = std::chrono::steady_clock::now();
  const Solid ball = hull(points);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  RecordProperty("seconds", std::to_string(seconds.count()));
  const auto& polyhedron = *std::get<ConvexPolytope>(ball.primitive().shape).polyhedron;
  EXPECT_EQ(polyhedron.vertices.size(), 10000U);
  EXPECT_LT(seconds.count(), 30);
}

}  // namespace
}  // namespace exactcsg::io::test
