// SPDX-License-Identifier: GPL-3.0-or-later
// All predicates of Geometry against plain rational arithmetic (reference.hpp) on scenes made to be
// degenerate. Every expected value is computed by the reference, independently of the kernel.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "exactcsg/number/geometry.hpp"
#include "number/reference.hpp"

namespace exactcsg {
namespace {

using Random = std::mt19937_64;

Sign sign(const Rational& value) { return sign_of(sgn(value)); }

// Where a scene's coordinates come from.
using Coordinate = std::function<Rational(Random&)>;

double uniform(Random& random, double lower, double upper) {
  return std::uniform_real_distribution<double>(lower, upper)(random);
}

int integer(Random& random, int lower, int upper) {
  return std::uniform_int_distribution<int>(lower, upper)(random);
}

struct Kind {
  const char* name;
  Coordinate coordinate;
};

// A few doubles next to an integer: everything is nearly coplanar, nearly equal, nearly parallel.
Rational near_integer(Random& random) {
  double value = integer(random, -2, 2);
  for (int steps = integer(random, 0, 2); steps > 0; --steps) {
    value = std::nextafter(value, integer(random, 0, 1) == 0 ? -10.0 : 10.0);
  }
  return rational_of(value);
}

// The exact product of two doubles, as vertices of faceted round primitives have them.
Rational product(Random& random) {
  const double angle = integer(random, 0, 7) * std::acos(-1.0) / 4;
  return rational_of(std::cos(angle)) * rational_of(integer(random, 1, 3) * 0.1) +
         rational_of(integer(random, -1, 1) * 0.7);
}

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all = {
      {"small integers", [](Random& r) { return Rational(integer(r, -2, 2)); }},
      {"tenths",
       [](Random& r) {
         Rational value(integer(r, -9, 9), 10);
         value.canonicalize();
         return value;
       }},
      {"fractions",
       [](Random& r) {
         Rational value(integer(r, -5, 5), integer(r, 1, 7));
         value.canonicalize();
         return value;
       }},
      {"neighbours of integers", near_integer},
      {"products of doubles", product},
      {"doubles", [](Random& r) { return rational_of(uniform(r, -1, 1)); }},
      {"far away", [](Random& r) { return rational_of(1e6 + integer(r, -3, 3) * 0.001); }},
      {"huge", [](Random& r) { return rational_of(integer(r, -2, 2) * 1e100); }},
      {"tiny", [](Random& r) { return rational_of(integer(r, -2, 2) * 0x1p-1074); }},
      {"huge and tiny",
       [](Random& r) {
         return rational_of(integer(r, -1, 1) * (integer(r, 0, 1) == 0 ? 1e100 : 0x1p-1074));
       }},
  };
  return all;
}

struct Scene {
  std::vector<Point3> points;
  std::vector<PointId> ids;
  std::vector<reference::RationalPlane> planes;  // as added
  std::vector<reference::RationalPlane> wall_planes;
  std::vector<PlaneRef> walls;
  std::optional<Geometry> geometry;
};

Scene make_scene(Random& random, const Kind& kind, int point_count, int plane_count) {
  Scene scene;
  Geometry::Builder builder;
  for (int i = 0; i < point_count; ++i) {
    Point3 p{kind.coordinate(random), kind.coordinate(random), kind.coordinate(random)};
    // Half of the later points are made to lie in the plane, on the line or at the place of earlier
    // ones.
    if (i > 3 && integer(random, 0, 1) == 0) {
      const auto pick = [&] {
        return scene.points[static_cast<std::size_t>(integer(random, 0, i - 1))];
      };
      const Point3 a = pick();
      const Point3 b = pick();
      const Point3 c = pick();
      const Rational s(integer(random, -1, 3), 2);
      const Rational t(integer(random, 0, 2), 3);
      p = a + Rational(s) * (b - a) + Rational(t) * (c - a);
      for (Rational* x : {&p.x, &p.y, &p.z}) x->canonicalize();
    }
    scene.points.push_back(p);
    scene.ids.push_back(builder.add_point(p));
  }
  while (static_cast<int>(scene.planes.size()) < plane_count) {
    const auto pick = [&] { return static_cast<std::size_t>(integer(random, 0, point_count - 1)); };
    const std::size_t i = pick();
    const std::size_t j = pick();
    const std::size_t k = pick();
    const auto plane = reference::plane_through(scene.points[i], scene.points[j], scene.points[k]);
    if (reference::is_degenerate(plane)) {
      EXPECT_THROW(builder.add_plane(scene.ids[i], scene.ids[j], scene.ids[k]), std::exception);
      continue;
    }
    scene.planes.push_back(plane);
    if (integer(random, 0, 3) == 0) {
      builder.add_plane(
          make_plane(plane.normal[0], plane.normal[1], plane.normal[2], plane.offset));
    } else {
      builder.add_plane(scene.ids[i], scene.ids[j], scene.ids[k]);
    }
  }
  for (int i = 0; i < 4; ++i) {
    const Axis axis = static_cast<Axis>(integer(random, 0, 2));
    const double position = round_wall_position(nearest_double(kind.coordinate(random)));
    scene.walls.push_back(PlaneRef::of_wall(axis, position));
    reference::RationalPlane wall;
    wall.normal[static_cast<std::size_t>(axis)] = 1;
    wall.offset = -rational_of(position);
    scene.wall_planes.push_back(wall);
  }
  scene.geometry.emplace(std::move(builder).build());
  return scene;
}

struct ReferenceVertex {
  Vertex vertex;
  Point3 exact;
};

// A plane of the scene: the stored one, with the reference's coefficients in the stored sense.
struct ReferencePlane {
  PlaneRef ref;
  reference::RationalPlane exact;
};

reference::RationalPlane reversed(const reference::RationalPlane& p) {
  return {{Rational(-p.normal[0]), Rational(-p.normal[1]), Rational(-p.normal[2])},
          Rational(-p.offset)};
}

// LAW coincidence: one reference for each class of coincident planes, and the stored sense.
std::vector<ReferencePlane> check_planes(const Scene& scene) {
  const Geometry& geometry = *scene.geometry;
  std::vector<ReferencePlane> result;
  std::vector<std::size_t> first_of;
  for (std::size_t i = 0; i < scene.planes.size(); ++i) {
    const OrientedPlaneRef oriented = geometry.plane(static_cast<std::uint32_t>(i));
    const reference::RationalPlane stored =
        oriented.sense > 0 ? scene.planes[i] : reversed(scene.planes[i]);
    const Plane exact = geometry.exact_plane(oriented.plane);
    EXPECT_EQ(exact,
              make_plane(stored.normal[0], stored.normal[1], stored.normal[2], stored.offset));
    // A plane's stored normal is that of the first added of its class.
    std::size_t first = i;
    for (std::size_t j = 0; j < i; ++j) {
      if (reference::coincide(scene.planes[i], scene.planes[j])) {
        first = j;
        break;
      }
    }
    if (first == i) {
      EXPECT_EQ(oriented.sense, 1);
    }
    for (std::size_t j = 0; j <= i; ++j) {
      const bool same = geometry.plane(static_cast<std::uint32_t>(j)).plane == oriented.plane;
      EXPECT_EQ(same, reference::coincide(scene.planes[i], scene.planes[j]));
    }
    first_of.push_back(first);
    result.push_back({oriented.plane, stored});
  }
  for (std::size_t i = 0; i < scene.walls.size(); ++i) {
    result.push_back({scene.walls[i], scene.wall_planes[i]});
  }
  for (const ReferencePlane& plane : result) {
    // Certified doubles: within their errors of the exact coefficients, scaled alike.
    const auto approximate = geometry.approximate(plane.ref);
    if (!std::isfinite(approximate.offset_error)) continue;
    const double doubles[] = {approximate.a, approximate.b, approximate.c};
    const double largest =
        std::max({std::fabs(approximate.a), std::fabs(approximate.b), std::fabs(approximate.c)});
    EXPECT_GE(largest, 0.5);
    EXPECT_LE(largest, 1.0);
    EXPECT_LE(approximate.normal_error, 0x1p-30);
    // Some scale s brings all exact coefficients within the errors: the intervals of s intersect.
    std::optional<Rational> lower;
    std::optional<Rational> upper;
    const auto restrict = [&](const Rational& exact, double value, double error) {
      if (exact == 0) {
        EXPECT_LE(std::fabs(value), error);
        return;
      }
      Rational from = (rational_of(value) - rational_of(error)) / exact;
      Rational to = (rational_of(value) + rational_of(error)) / exact;
      if (from > to) std::swap(from, to);
      if (!lower || from > *lower) lower = from;
      if (!upper || to < *upper) upper = to;
    };
    for (std::size_t k = 0; k < 3; ++k) {
      restrict(plane.exact.normal[k], doubles[k], approximate.normal_error);
    }
    restrict(plane.exact.offset, approximate.d, approximate.offset_error);
    EXPECT_LE(*lower, *upper);
    EXPECT_GT(*upper, 0);
  }
  return result;
}

std::vector<ReferenceVertex> make_vertices(Random& random, const Scene& scene,
                                           const std::vector<ReferencePlane>& planes,
                                           int meeting_count) {
  const Geometry& geometry = *scene.geometry;
  std::vector<ReferenceVertex> result;
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    result.push_back({geometry.vertex(scene.ids[i]), scene.points[i]});
  }
  for (int tries = 0; tries < meeting_count; ++tries) {
    const auto pick = [&]() -> const ReferencePlane& {
      return planes[static_cast<std::size_t>(
          integer(random, 0, static_cast<int>(planes.size()) - 1))];
    };
    const ReferencePlane& p = pick();
    const ReferencePlane& q = pick();
    const ReferencePlane& r = pick();
    if (reference::determinant(p.exact, q.exact, r.exact) == 0) continue;
    result.push_back(
        {geometry.meet(p.ref, q.ref, r.ref), reference::meeting_point(p.exact, q.exact, r.exact)});
  }
  for (const ReferenceVertex& v : result) {
    EXPECT_EQ(geometry.exact_point(v.vertex), v.exact);
    if (!std::isfinite(v.vertex.error)) continue;
    for (const Axis axis : {Axis::X, Axis::Y, Axis::Z}) {
      EXPECT_LE(abs(coordinate(v.exact, axis) - rational_of(v.vertex.coordinate(axis))),
                rational_of(v.vertex.error));
    }
  }
  return result;
}

class PredicateCases : public ::testing::TestWithParam<std::size_t> {};

// LAW predicate.1, predicate.2, predicate.3 against the reference.
TEST_P(PredicateCases, AgreeWithRationalArithmetic) {
  const Kind& kind = kinds()[GetParam()];
  TierStatistics statistics;
  std::uint64_t cases = 0;
  for (std::uint64_t seed = 1; cases < 110'000 && !HasFailure(); ++seed) {
    SCOPED_TRACE(std::string(kind.name) + ", seed " + std::to_string(seed));
    Random random(seed);
    const Scene scene = make_scene(random, kind, 10, 14);
    const Geometry& geometry = *scene.geometry;
    const std::vector<ReferencePlane> planes = check_planes(scene);
    const std::vector<ReferenceVertex> vertices = make_vertices(random, scene, planes, 40);
    for (const ReferenceVertex& v : vertices) {
      for (const ReferencePlane& plane : planes) {
        ++cases;
        ASSERT_EQ(geometry.side(v.vertex, plane.ref, statistics),
                  sign(reference::value_at(plane.exact, v.exact)));
      }
      for (const ReferenceVertex& w : vertices) {
        ++cases;
        const auto expected = compare(v.exact, w.exact);
        ASSERT_EQ(geometry.compare_position(v.vertex, w.vertex, statistics), expected);
        ASSERT_EQ(geometry.same_position(v.vertex, w.vertex, statistics), expected == 0);
        const Axis axis = static_cast<Axis>(cases % 3);
        ASSERT_EQ(geometry.compare_coordinate(v.vertex, w.vertex, axis, statistics),
                  sign(coordinate(v.exact, axis) - coordinate(w.exact, axis)));
        const double value = w.vertex.coordinate(axis);
        ASSERT_EQ(geometry.compare_coordinate(v.vertex, axis, value, statistics),
                  sign(coordinate(v.exact, axis) - rational_of(value)));
      }
    }
    for (std::size_t i = 0; i < planes.size(); ++i) {
      for (std::size_t j = 0; j < planes.size(); ++j) {
        ++cases;
        const auto& p = planes[i];
        const auto& q = planes[j];
        const auto& r = planes[(i * 7 + j * 3 + seed) % planes.size()];
        ASSERT_EQ(geometry.orientation(p.ref, q.ref, r.ref, statistics),
                  sign(reference::determinant(p.exact, q.exact, r.exact)));
      }
    }
  }
  for (std::size_t tier = 0; tier < tier_count; ++tier) {
    RecordProperty("tier" + std::to_string(tier), std::to_string(statistics.answers[tier]));
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, PredicateCases, ::testing::Range<std::size_t>(0, kinds().size()));

// Halves of quads whose corners are rounded to doubles: their planes are nearly one, and points of
// the one, on either side of the common edge and next to it, are asked for the side of the other.
TEST(Side, AcrossTheEdgeOfNearlyCoplanarFacets) {
  TierStatistics statistics;
  std::array<int, 3> counts{};
  for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const double slope_x = uniform(random, -1, 1);
    const double slope_y = uniform(random, -1, 1);
    const auto on_slope = [&](double x, double y) -> Point3 {
      return {rational_of(x), rational_of(y), rational_of(0.7 + slope_x * x + slope_y * y)};
    };
    const auto somewhere = [&]() -> Point3 {
      return {rational_of(uniform(random, -2, 2)), rational_of(uniform(random, -2, 2)),
              rational_of(uniform(random, -2, 2))};
    };
    const std::array<Point3, 4> corners{
        on_slope(-1, uniform(random, -0.1, 0.1)), on_slope(1, uniform(random, -0.1, 0.1)),
        on_slope(uniform(random, -1, 1), uniform(random, 0.5, 2)),
        on_slope(uniform(random, -1, 1), uniform(random, -2, -0.5))};
    // A cutting plane through a point of the edge makes points next to it.
    const bool is_near = integer(random, 0, 3) == 0;
    const Rational share(integer(random, 1, 99), 100);
    const Point3 on_edge = corners[0] + share * (corners[1] - corners[0]);
    const std::array<Point3, 6> others{is_near ? on_edge : somewhere(), somewhere(), somewhere(),
                                       is_near ? on_edge : somewhere(), somewhere(), somewhere()};
    Geometry::Builder builder;
    std::vector<PointId> ids;
    for (const Point3& p : corners) ids.push_back(builder.add_point(p));
    for (const Point3& p : others) ids.push_back(builder.add_point(p));
    const std::array<std::array<std::size_t, 3>, 4> triples{
        {{0, 1, 2}, {1, 0, 3}, {4, 5, 6}, {7, 8, 9}}};
    std::vector<reference::RationalPlane> expected;
    const auto point = [&](std::size_t i) { return i < 4 ? corners[i] : others[i - 4]; };
    for (const auto& [a, b, c] : triples) {
      builder.add_plane(ids[a], ids[b], ids[c]);
      expected.push_back(reference::plane_through(point(a), point(b), point(c)));
    }
    if (reference::determinant(expected[0], expected[2], expected[3]) == 0) continue;
    const Geometry geometry = std::move(builder).build();
    const auto plane = [&](std::uint32_t i) { return geometry.plane(i).plane; };
    const Vertex met = geometry.meet(plane(0), plane(2), plane(3));
    const Point3 exact = reference::meeting_point(expected[0], expected[2], expected[3]);
    const Sign value = sign(reference::value_at(expected[1], exact));
    ASSERT_EQ(geometry.side(met, plane(1), statistics) *
                  sign_of(static_cast<int>(geometry.plane(1).sense)),
              value);
    ++counts[static_cast<std::size_t>(static_cast<int>(value) + 1)];
  }
  EXPECT_GT(counts[0], 500);
  EXPECT_GT(counts[1], 200);
  EXPECT_GT(counts[2], 500);
}

}  // namespace
}  // namespace exactcsg
