// SPDX-License-Identifier: GPL-3.0-or-later
// Exact meeting points of planes that are known to share two points, as facets of one polytope do,
// against Cramer's rule in rationals.

#include <gtest/gtest.h>

#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "exactcsg/number/geometry.hpp"
#include "exactcsg/number/line_meeting.hpp"
#include "number/reference.hpp"

namespace exactcsg {
namespace {

PointView meeting_point(const Point3& p, const Point3& q, const PlaneForm& plane) {
  return meeting_point_of_line(view_of(p), view_of(q), plane);
}

class RandomPoints {
 public:
  explicit RandomPoints(std::uint64_t seed) : random_(seed) {}

  // Small integers, so that coordinates agree now and then, decimals, or ever longer fractions; the
  // last ones have denominators whose odd parts are longer than a limb.
  Point3 operator()(int kind) { return {number(kind), number(kind), number(kind)}; }

 private:
  long below(long n) { return static_cast<long>(random_() % static_cast<std::uint64_t>(n)); }
  Rational number(int kind) {
    if (kind == 0) return below(7) - 3;
    Rational result(below(2000001) - 1000000, kind == 1 ? 1000 : 1 + below(1000000));
    if (kind == 3) result = result * result + Rational(below(1000), 1L << below(60));
    result.canonicalize();
    for (; kind >= 4; --kind) result *= result;
    return result;
  }

  std::mt19937_64 random_;
};

// Where the line through the first two points meets the plane through the other three, if it does
// in one point: by Cramer's rule, with the planes through the line and each of two more points.
std::optional<Point3> line_and_plane(const std::array<Point3, 5>& points, const Point3& r,
                                     const Point3& s) {
  const auto& [p, q, a, b, c] = points;
  const auto first = reference::plane_through(p, q, r);
  const auto second = reference::plane_through(p, q, s);
  const auto third = reference::plane_through(a, b, c);
  if (reference::determinant(first, second, third) == 0) return std::nullopt;
  return reference::meeting_point(first, second, third);
}

// Equal rationals are compared by numerators and denominators: the result is in lowest terms.
TEST(MeetingPoint, OfALineAndAPlane) {
  RandomPoints random(1);
  int compared = 0;
  for (int round = 0; round < 4000; ++round) {
    std::array<Point3, 5> points;
    for (Point3& point : points) point = random(round % 6);
    auto& [p, q, a, b, c] = points;
    // A plane across an axis now and then.
    if (round % 5 == 0) a.z = b.z = c.z;
    if (round % 7 == 0) a.x = b.x = c.x;
    const auto met = line_and_plane(points, random(0), random(0));
    if (!met) continue;
    ++compared;
    const Point3& expected = *met;
    const PointView by_points =
        meeting_point(p, q, plane_form_through(view_of(a), view_of(b), view_of(c)));
    EXPECT_EQ(point_of(by_points), expected);
    const PlaneForm by_coefficients = plane_form_of(plane_through(a, b, c));
    EXPECT_EQ(point_of(meeting_point(p, q, by_coefficients)), expected);
  }
  EXPECT_GT(compared, 2000);
}

// Copies of shapes whose coordinates are doubles, or products of two, moved by decimals: the lines'
// directions and the planes' normals do not have the decimals' denominators any more. Points that
// are as high as one another give horizontal lines, and planes with a short side.
TEST(MeetingPoint, OfCopiesMovedByDecimals) {
  std::mt19937_64 random(5);
  const auto below = [&](long n) {
    return static_cast<long>(random() % static_cast<std::uint64_t>(n));
  };
  const auto dyadic = [&] {
    Rational result(below(2000001) - 1000000, 1L << below(40));
    result.canonicalize();
    return below(3) == 0 ? Rational(result * result * result) : result;
  };
  const auto decimal = [&](long denominator) {
    Rational result(below(2000001) - 1000000, denominator);
    result.canonicalize();
    return result;
  };
  int compared = 0;
  for (int round = 0; round < 2000; ++round) {
    const std::array<Point3, 2> moves{
        Point3{decimal(1000000), decimal(1000000), decimal(1000)},
        Point3{decimal(1000000), decimal(round % 3 == 0 ? 999999 : 1000000), decimal(100)}};
    std::array<Point3, 5> points;
    for (std::size_t i = 0; i < 5; ++i) {
      const Point3& move = moves[i < 2 ? 0 : 1];
      points[i] = {dyadic() + move.x, dyadic() + move.y, dyadic() + move.z};
    }
    auto& [p, q, a, b, c] = points;
    if (round % 2 == 0) q.z = p.z;
    if (round % 3 == 0) (round % 9 == 0 ? a.y : b.y) = c.y;
    if (round % 7 == 0) p = a;  // the line meets the plane in an input point
    const auto expected =
        line_and_plane(points, {below(7), below(7), below(7)}, {below(7), below(7), below(7)});
    if (!expected) continue;
    ++compared;
    const PointView met =
        meeting_point(p, q, plane_form_through(view_of(a), view_of(b), view_of(c)));
    EXPECT_EQ(point_of(met), *expected);
    // LAW view.1
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_TRUE(equal(met[axis], view_of(coordinate(*expected, axis))));
    }
  }
  EXPECT_GT(compared, 1000);
}

// The views of exact points, with the nearest doubles of all coordinates.
void expect_near_point(const NearPointView& found, const Point3& expected) {
  EXPECT_EQ(point_of(found.exact), expected);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(found.nearest[axis], nearest_double(coordinate(expected, axis)));
  }
}

// Coordinates that the edge or the plane has in common are copied from input points.
TEST(MeetingPoint, OfAnEdgeAlongAnAxis) {
  RandomPoints random(3);
  int compared = 0;
  for (int round = 0; round < 600; ++round) {
    const Point3 p = random(round % 4);
    Point3 q = p;
    (round % 3 == 0 ? q.x : round % 3 == 1 ? q.y : q.z) += 1 + round % 5;
    Point3 a = random(round % 4);
    Point3 b = random(round % 4);
    Point3 c = random(round % 4);
    // Two of three times across the very axis.
    const int across = round % 3 == 0 ? round / 3 % 3 : round % 3;
    if (across == 0) a.x = b.x = c.x;
    if (across == 1) a.y = b.y = c.y;
    if (across == 2) a.z = b.z = c.z;
    const Point3 r = random(0);
    const Point3 s = random(0);
    const auto first = reference::plane_through(p, q, r);
    const auto second = reference::plane_through(p, q, s);
    const auto third = reference::plane_through(a, b, c);
    if (reference::determinant(first, second, third) == 0) continue;
    ++compared;
    Geometry::Builder builder;
    const PointId from = builder.add_point(p);
    const PointId to = builder.add_point(q);
    builder.add_plane(from, to, builder.add_point(r));
    builder.add_plane(from, to, builder.add_point(s));
    // By its coefficients, so that no point of the plane is known, now and then.
    if (round % 2 == 0) {
      builder.add_plane(builder.add_point(a), builder.add_point(b), builder.add_point(c));
    } else {
      builder.add_plane(plane_through(a, b, c));
    }
    const Geometry geometry = std::move(builder).build();
    const auto plane = [&](std::uint32_t i) { return geometry.plane(i).plane; };
    expect_near_point(geometry.exact_view(geometry.meet(plane(0), plane(1), plane(2))),
                      reference::meeting_point(first, second, third));
    expect_near_point(geometry.exact_view(geometry.vertex(from)), p);
  }
  EXPECT_GT(compared, 300);
}

// The corner of three planes across the axes has the coordinate of each.
TEST(MeetingPoint, OfPlanesAcrossTheAxes) {
  RandomPoints random(4);
  for (int round = 0; round < 60; ++round) {
    const Point3 corner = random(round % 6);
    Geometry::Builder builder;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::array<Point3, 3> points{random(0), random(0), random(0)};
      points[0].x += 10;
      points[0].y += 20;
      points[0].z += 30;
      points[1].x -= 10;
      points[1].z += 40;
      for (Point3& p : points) {
        (axis == 0 ? p.x : axis == 1 ? p.y : p.z) = coordinate(corner, axis);
      }
      builder.add_plane(builder.add_point(points[0]), builder.add_point(points[1]),
                        builder.add_point(points[2]));
    }
    const Geometry geometry = std::move(builder).build();
    const auto plane = [&](std::uint32_t i) { return geometry.plane(i).plane; };
    expect_near_point(geometry.exact_view(geometry.meet(plane(2), plane(0), plane(1))), corner);
  }
}

TEST(MeetingPoint, OfFacetsOfTetrahedra) {
  RandomPoints random(2);
  int compared = 0;
  for (int round = 0; round < 40; ++round) {
    Geometry::Builder builder;
    std::vector<reference::RationalPlane> exact;
    for (int tetrahedron = 0; tetrahedron < 2; ++tetrahedron) {
      std::array<Point3, 4> corners;
      for (Point3& corner : corners) corner = random(1 + round % 3);
      for (std::size_t i = 0; i < 4; ++i) {
        const std::array<Point3, 3> facet{corners[(i + 1) % 4], corners[(i + 2) % 4],
                                          corners[(i + 3) % 4]};
        builder.add_plane(builder.add_point(facet[0]), builder.add_point(facet[1]),
                          builder.add_point(facet[2]));
        exact.push_back(reference::plane_through(facet[0], facet[1], facet[2]));
      }
    }
    const Geometry geometry = std::move(builder).build();
    const auto plane = [&](std::size_t i) {
      return geometry.plane(static_cast<std::uint32_t>(i)).plane;
    };
    for (std::size_t i = 0; i < exact.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        for (std::size_t k = 0; k < j; ++k) {
          if (reference::determinant(exact[i], exact[j], exact[k]) == 0) continue;
          ++compared;
          const Vertex v = geometry.meet(plane(i), plane(j), plane(k));
          const Point3 expected = reference::meeting_point(exact[i], exact[j], exact[k]);
          EXPECT_EQ(geometry.exact_point(v), expected);
          expect_near_point(geometry.exact_view(v), expected);
        }
        // An edge and a wall.
        const PlaneRef wall = PlaneRef::of_wall(Axis::Y, 0.75);
        const reference::RationalPlane wall_plane{{0, 1, 0}, Rational(-3, 4)};
        if (reference::determinant(exact[i], exact[j], wall_plane) == 0) continue;
        EXPECT_EQ(geometry.exact_point(geometry.meet(plane(i), plane(j), wall)),
                  reference::meeting_point(exact[i], exact[j], wall_plane));
      }
    }
  }
  EXPECT_GT(compared, 1000);
}

// Two planes through an edge that hardly differ, as those of fine meshes: doubles of the planes do
// not determine where a wall crosses the edge, those of its ends do.
TEST(MeetingPoint, OfAnEdgeBetweenNearlyParallelPlanes) {
  RandomPoints random(3);
  int compared = 0;
  for (int round = 0; round < 400; ++round) {
    const std::array<Point3, 3> points{random(1), random(2), random(1)};
    const Rational nearly = Rational(1, 1L << (30 + round % 25));
    const Point3& c = points[2];
    const std::array<Point3, 2> tips{c, Point3{c.x + nearly, c.y + nearly, c.z - 2 * nearly}};
    Geometry::Builder builder;
    const PointId p = builder.add_point(points[0]);
    const PointId q = builder.add_point(points[1]);
    std::array<reference::RationalPlane, 2> exact;
    for (std::size_t i = 0; i < 2; ++i) {
      builder.add_plane(p, q, builder.add_point(tips[i]));
      exact[i] = reference::plane_through(points[0], points[1], tips[i]);
    }
    const Geometry geometry = std::move(builder).build();
    const double middle = round_wall_position(Rational((points[0].x + points[1].x) / 2).get_d());
    const reference::RationalPlane wall_plane{{1, 0, 0}, -rational_of(middle)};
    if (reference::determinant(exact[0], exact[1], wall_plane) == 0) continue;
    ++compared;
    const Vertex v =
        geometry.meet(geometry.plane(0).plane, geometry.plane(1).plane,
                      PlaneRef::of_wall(Axis::X, middle), geometry.vertex(p), geometry.vertex(q));
    const Point3 expected = reference::meeting_point(exact[0], exact[1], wall_plane);
    EXPECT_EQ(geometry.exact_point(v), expected);
    const Rational error = rational_of(v.error);
    EXPECT_LE(abs(Rational(rational_of(v.x) - expected.x)), error);
    EXPECT_LE(abs(Rational(rational_of(v.y) - expected.y)), error);
    EXPECT_LE(abs(Rational(rational_of(v.z) - expected.z)), error);
    EXPECT_LE(v.error, 1e-5);
  }
  EXPECT_GT(compared, 300);
}

}  // namespace
}  // namespace exactcsg
