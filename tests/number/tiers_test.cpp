// SPDX-License-Identifier: GPL-3.0-or-later
// Which tier answers, for inputs chosen so that the answer is known by construction.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "exactcsg/number/geometry.hpp"
#include "number/reference.hpp"

namespace exactcsg {
namespace {

TierStatistics expected(Tier tier, bool zero) {
  TierStatistics statistics;
  statistics.record(tier, zero);
  return statistics;
}

Rational power_of_two(int exponent) {
  Rational value(1);
  if (exponent >= 0) return value << static_cast<unsigned long>(exponent);
  return value >> static_cast<unsigned long>(-exponent);
}

// Points whose coordinates and planes are integers below 2^bits, placed askew.
Point3 askew(long i, int bits) {
  const Rational scale = power_of_two(bits) / 7;
  const auto coordinate = [&](long factor) {
    const Rational exact = scale * Rational(factor % 5 + 1) + factor;
    return Rational(Integer(exact.get_num() / exact.get_den()));
  };
  return {coordinate(i * 3 + 1), coordinate(i * i + 2), coordinate(i * i * i + i * 5)};
}

struct AskewScene {
  std::optional<Geometry> geometry;
  std::array<PlaneRef, 3> planes;
  PlaneRef through;  // a plane through the three planes' meeting point, by no known incidence
  PlaneRef shifted;  // the same, moved by a very little
  Point3 meeting;
};

// The fourth plane passes through the computed meeting point, as coefficients: nobody told.
AskewScene askew_scene(int bits) {
  Geometry::Builder builder;
  std::vector<reference::RationalPlane> exact;
  for (long i = 0; i < 3; ++i) {
    const Point3 p = askew(3 * i, bits);
    const Point3 q = askew(3 * i + 1, bits);
    const Point3 r = askew(3 * i + 2, bits);
    builder.add_plane(builder.add_point(p), builder.add_point(q), builder.add_point(r));
    exact.push_back(reference::plane_through(p, q, r));
  }
  AskewScene scene;
  scene.meeting = reference::meeting_point(exact[0], exact[1], exact[2]);
  const Rational d = -(scene.meeting.x * 3 + scene.meeting.y * 5 - scene.meeting.z * 7);
  builder.add_plane(make_plane(3, 5, -7, d));
  builder.add_plane(make_plane(3, 5, -7, d + power_of_two(-200)));
  scene.geometry.emplace(std::move(builder).build());
  for (std::uint32_t i = 0; i < 3; ++i) scene.planes[i] = scene.geometry->plane(i).plane;
  scene.through = scene.geometry->plane(3).plane;
  scene.shifted = scene.geometry->plane(4).plane;
  return scene;
}

Vertex meeting(const AskewScene& scene) {
  return scene.geometry->meet(scene.planes[0], scene.planes[1], scene.planes[2]);
}

TEST(Tiers, OwnPlanesAreSymbolic) {
  const AskewScene scene = askew_scene(10);
  const Vertex v = meeting(scene);
  for (const PlaneRef plane : scene.planes) {
    TierStatistics statistics;
    EXPECT_EQ(scene.geometry->side(v, plane, statistics), Sign::Zero);
    EXPECT_EQ(statistics, expected(Tier::Symbolic, true));
  }
  TierStatistics statistics;
  EXPECT_TRUE(scene.geometry->same_position(v, v, statistics));
  EXPECT_EQ(statistics, expected(Tier::Symbolic, true));
}

// Four points of a plane that incidences in rows tell of, once for each of two added planes.
TEST(Tiers, IncidenceGivenByRowsIsSymbolic) {
  Geometry::Builder builder;
  std::vector<PointId> ids;
  for (const Point3& point :
       {Point3{Rational(1, 3), 0, 0}, Point3{0, Rational(1, 7), 0}, Point3{0, 0, Rational(1, 11)},
        Point3{Rational(1, 9), Rational(1, 21), Rational(1, 33)}}) {
    ids.push_back(builder.add_point(point));
  }
  // x 3 + y 7 + z 11 = 1, and x 3 + y 7 + z 33 = 1 through the first two
  builder.add_plane(Plane{1, 0, 0, 9});
  const std::uint32_t plane = builder.add_plane(Plane{3, 7, 11, -1});
  const std::uint32_t other = builder.add_plane(Plane{3, 7, 33, -1});
  const std::vector<std::uint32_t> begins{0, 2, 6};
  const std::vector<std::uint32_t> corners{0, 1, 3, 2, 1, 0};
  const std::vector<std::uint32_t> of_rows{1, 0};
  builder.add_incidences({ids, begins, corners, of_rows, plane});
  const Geometry geometry = std::move(builder).build();
  const auto tier_of = [&](std::size_t point, std::uint32_t added) {
    TierStatistics statistics;
    const Sign sign =
        geometry.side(geometry.vertex(ids[point]), geometry.plane(added).plane, statistics);
    EXPECT_EQ(sign == Sign::Zero, statistics == expected(Tier::Symbolic, true)) << point;
    return sign;
  };
  for (const std::size_t point : {0U, 1U, 2U, 3U}) EXPECT_EQ(tier_of(point, plane), Sign::Zero);
  for (const std::size_t point : {0U, 1U}) EXPECT_EQ(tier_of(point, other), Sign::Zero);
  for (const std::size_t point : {2U, 3U}) EXPECT_EQ(tier_of(point, other), Sign::Positive);
}

TEST(Tiers, KnownIncidenceIsSymbolic) {
  Geometry::Builder builder;
  const PointId p = builder.add_point({Rational(1, 3), 0, 0});
  const PointId q = builder.add_point({0, Rational(1, 7), 0});
  const PointId r = builder.add_point({0, 0, Rational(1, 11)});
  // x 3 + y 7 + z 11 = 1 with a fourth point on it that only add_incidence tells of
  const PointId s = builder.add_point({Rational(1, 9), Rational(1, 21), Rational(1, 33)});
  const std::uint32_t plane = builder.add_plane(p, q, r);
  builder.add_incidence(s, plane);
  const std::uint32_t other = builder.add_plane(Plane{1, 2, 3, 4});
  const std::uint32_t again = builder.add_plane(r, q, p);
  const Geometry geometry = std::move(builder).build();
  for (const PointId id : {p, q, r, s}) {
    for (const std::uint32_t added : {plane, again}) {
      TierStatistics statistics;
      EXPECT_EQ(geometry.side(geometry.vertex(id), geometry.plane(added).plane, statistics),
                Sign::Zero);
      EXPECT_EQ(statistics, expected(Tier::Symbolic, true));
    }
  }
  TierStatistics statistics;
  EXPECT_EQ(geometry.side(geometry.vertex(p), geometry.plane(other).plane, statistics),
            Sign::Positive);
  EXPECT_EQ(statistics, expected(Tier::Double, false));
}

// Four planes of a pyramid meet at its apex, an input point: the meeting of three of them is known
// to lie on the fourth, and to be the apex.
TEST(Tiers, MeetingPointsThatAreInputPointsAreSymbolic) {
  Geometry::Builder builder;
  const PointId apex = builder.add_point({Rational(1, 3), Rational(1, 3), 1});
  std::vector<PointId> base;
  for (const auto& [x, y] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
    base.push_back(builder.add_point({x, y, 0}));
  }
  for (std::size_t i = 0; i < 4; ++i) builder.add_plane(base[i], base[(i + 1) % 4], apex);
  const Geometry geometry = std::move(builder).build();
  const auto plane = [&](std::uint32_t i) { return geometry.plane(i).plane; };
  const Vertex v = geometry.meet(plane(0), plane(1), plane(2));
  TierStatistics statistics;
  EXPECT_EQ(geometry.side(v, plane(3), statistics), Sign::Zero);
  EXPECT_EQ(statistics, expected(Tier::Symbolic, true));
  statistics = {};
  EXPECT_TRUE(geometry.same_position(v, geometry.vertex(apex), statistics));
  EXPECT_EQ(statistics, expected(Tier::Symbolic, true));
  statistics = {};
  const Vertex w = geometry.meet(plane(1), plane(2), plane(3));
  EXPECT_EQ(geometry.compare_position(v, w, statistics), std::strong_ordering::equal);
  EXPECT_EQ(statistics, expected(Tier::Symbolic, true));
}

TEST(Tiers, GenericPositionsNeedOnlyDoubles) {
  const AskewScene scene = askew_scene(10);
  const Vertex v = meeting(scene);
  TierStatistics statistics;
  const PlaneRef wall = PlaneRef::of_wall(Axis::Y, std::floor(v.y) - 1);
  EXPECT_EQ(scene.geometry->side(v, wall, statistics), Sign::Positive);
  EXPECT_EQ(statistics, expected(Tier::Double, false));
  statistics = {};
  EXPECT_EQ(scene.geometry->compare_coordinate(v, Axis::Z, v.z + 1, statistics), Sign::Negative);
  EXPECT_EQ(statistics, expected(Tier::Double, false));
  statistics = {};
  EXPECT_NE(
      scene.geometry->orientation(scene.planes[0], scene.planes[1], scene.planes[2], statistics),
      Sign::Zero);
  EXPECT_EQ(statistics, expected(Tier::Double, false));
}

TEST(Tiers, UnknownZerosOfSmallIntegersAreFixed) {
  for (const int bits : {6, 12, 40, 100}) {
    const AskewScene scene = askew_scene(bits);
    const Vertex v = meeting(scene);
    TierStatistics statistics;
    EXPECT_EQ(scene.geometry->side(v, scene.through, statistics), Sign::Zero) << bits;
    EXPECT_EQ(statistics, expected(Tier::Fixed, true)) << bits;
    statistics = {};
    EXPECT_EQ(scene.geometry->side(v, scene.shifted, statistics), Sign::Positive) << bits;
    EXPECT_EQ(statistics, expected(Tier::Fixed, false)) << bits;
  }
}

TEST(Tiers, HugeCoefficientsAreUnbounded) {
  const AskewScene scene = askew_scene(900);
  const Vertex v = meeting(scene);
  TierStatistics statistics;
  EXPECT_EQ(scene.geometry->side(v, scene.through, statistics), Sign::Zero);
  EXPECT_EQ(statistics, expected(Tier::Unbounded, true));
  EXPECT_EQ(scene.geometry->exact_point(v), scene.meeting);
}

TEST(Tiers, OrientationOfPlanesThroughOneDirection) {
  // Normals u, v, u + v are dependent; no two of the planes are parallel.
  Geometry::Builder builder;
  builder.add_plane(Plane{3, 5, 7, 1});
  builder.add_plane(Plane{2, -9, 4, 5});
  builder.add_plane(Plane{5, -4, 11, 9});
  builder.add_plane(Plane{5, -4, 12, 9});
  const Geometry geometry = std::move(builder).build();
  const auto plane = [&](std::uint32_t i) { return geometry.plane(i).plane; };
  TierStatistics statistics;
  EXPECT_EQ(geometry.orientation(plane(0), plane(1), plane(2), statistics), Sign::Zero);
  EXPECT_EQ(statistics, expected(Tier::Fixed, true));
  // The same plane twice, or two walls of one axis: known.
  statistics = {};
  EXPECT_EQ(geometry.orientation(plane(0), plane(3), plane(0), statistics), Sign::Zero);
  EXPECT_EQ(statistics, expected(Tier::Symbolic, true));
  statistics = {};
  EXPECT_EQ(geometry.orientation(PlaneRef::of_wall(Axis::X, 1), plane(3),
                                 PlaneRef::of_wall(Axis::X, 2), statistics),
            Sign::Zero);
  EXPECT_EQ(statistics, expected(Tier::Symbolic, true));
}

TEST(Tiers, CoordinatesOnWallsAreSymbolic) {
  const AskewScene scene = askew_scene(10);
  const PlaneRef wall = PlaneRef::of_wall(Axis::X, 0.625);
  const Vertex v = scene.geometry->meet(wall, scene.planes[0], scene.planes[1]);
  const Vertex w = scene.geometry->meet(wall, scene.planes[0], scene.planes[2]);
  EXPECT_EQ(v.x, 0.625);
  TierStatistics statistics;
  EXPECT_EQ(scene.geometry->compare_coordinate(v, Axis::X, 0.625, statistics), Sign::Zero);
  EXPECT_EQ(statistics, expected(Tier::Symbolic, true));
  statistics = {};
  EXPECT_EQ(scene.geometry->compare_coordinate(v, w, Axis::X, statistics), Sign::Zero);
  EXPECT_EQ(statistics, expected(Tier::Symbolic, true));
}

// Exact doubles are compared as doubles, equal ones too.
TEST(Tiers, ExactDoublesAreComparedAsSuch) {
  Geometry::Builder builder;
  const PointId p = builder.add_point({1, 2, 3});
  const PointId q = builder.add_point({1, 5, 3});
  builder.add_plane(p, q, builder.add_point({1, 0, 7}));
  const PointId other = builder.add_point({1, 11, 12});
  const Geometry geometry = std::move(builder).build();
  TierStatistics statistics;
  EXPECT_EQ(
      geometry.compare_coordinate(geometry.vertex(p), geometry.vertex(q), Axis::X, statistics),
      Sign::Zero);
  EXPECT_EQ(statistics, expected(Tier::Double, true));
  statistics = {};  // the plane x = 1, on which nobody knows `other` to lie
  EXPECT_EQ(geometry.side(geometry.vertex(other), geometry.plane(0).plane, statistics), Sign::Zero);
  EXPECT_EQ(statistics, expected(Tier::Double, true));
}

// One Geometry, asked by several threads at once for coefficients nobody has computed yet: all see
// the same objects and the reference's values.
TEST(Geometry, ComputesExactPlanesOnceForAllThreads) {
  constexpr long count = 200;
  Geometry::Builder builder;
  std::vector<Plane> reference;
  for (long i = 0; i < count; ++i) {
    const Point3 p{Rational(i, 7), Rational(i * i, 3), 1};
    const Point3 q{Rational(i + 2, 5), 1, Rational(i, 13)};
    const Point3 r{0, Rational(i - 9, 4), Rational(2, i + 1)};
    builder.add_plane(builder.add_point(p), builder.add_point(q), builder.add_point(r));
    const auto plane = reference::plane_through(p, q, r);
    reference.push_back(
        make_plane(plane.normal[0], plane.normal[1], plane.normal[2], plane.offset));
  }
  const Geometry geometry = std::move(builder).build();
  std::vector<std::vector<const Plane*>> seen(4);
  {
    std::vector<std::jthread> threads;
    for (auto& mine : seen) {
      threads.emplace_back([&geometry, &mine] {
        for (std::uint32_t i = 0; i < count; ++i) {
          mine.push_back(&geometry.exact_plane(geometry.plane(i).plane));
        }
      });
    }
  }
  for (std::size_t i = 0; i < reference.size(); ++i) {
    EXPECT_EQ(*seen[0][i], reference[i]);
    for (const auto& mine : seen) EXPECT_EQ(mine[i], seen[0][i]);
  }
}

TEST(PlaneRef, HoldsAWall) {
  for (const Axis axis : {Axis::X, Axis::Y, Axis::Z}) {
    for (const double wished : {0.0, -0.0, 1.0, -1.5, 0.1, -1e100, 0x1p-1074, 1e-310}) {
      const double position = round_wall_position(wished);
      EXPECT_LE(std::fabs(position), std::fabs(wished));
      EXPECT_LE(std::fabs(wished - position), std::fabs(wished) * 0x1p-50 + 0x1p-1072);
      const PlaneRef wall = PlaneRef::of_wall(axis, position);
      EXPECT_TRUE(wall.is_wall());
      EXPECT_EQ(wall.wall_axis(), axis);
      EXPECT_EQ(wall.wall_position(), position);
    }
    EXPECT_EQ(PlaneRef::of_wall(axis, -0.0), PlaneRef::of_wall(axis, 0.0));
  }
  EXPECT_FALSE(PlaneRef::of_table(7).is_wall());
  EXPECT_EQ(PlaneRef::of_table(7).table_index(), 7U);
}

TEST(Builder, InternsEqualPoints) {
  Geometry::Builder builder;
  std::vector<PointId> first;
  for (int round = 0; round < 2; ++round) {
    for (long i = 0; i < 5000; ++i) {
      const PointId id = builder.add_point({Rational(i % 100, 3), Rational(i / 100), -1});
      if (round == 0) first.push_back(id);
      ASSERT_EQ(id, first[static_cast<std::size_t>(i)]);
    }
  }
  std::vector<PointId> distinct = first;
  std::ranges::sort(distinct);
  EXPECT_EQ(std::ranges::unique(distinct).size(), 0U);
}

// LAW coincidence.1 with more planes of overlapping certified doubles than are compared pairwise:
// shifted by 2^-200, in both senses, each of them twice.
TEST(Builder, TellsHundredsOfNearlyEqualPlanesApart) {
  Geometry::Builder builder;
  constexpr long count = 300;
  for (int round = 0; round < 2; ++round) {
    for (long i = 0; i < count; ++i) {
      const Plane plane = make_plane(3, 5, 7, 1 + i * power_of_two(-200));
      builder.add_plane(round == 0 ? plane : opposite(plane));
    }
  }
  const Geometry geometry = std::move(builder).build();
  EXPECT_EQ(geometry.plane_count(), static_cast<std::uint32_t>(count));
  for (std::uint32_t i = 0; i < count; ++i) {
    EXPECT_EQ(geometry.plane(i).sense, 1);
    EXPECT_EQ(geometry.plane(i + count).plane, geometry.plane(i).plane);
    EXPECT_EQ(geometry.plane(i + count).sense, -1);
  }
}

// Offsets that no double holds.
TEST(Builder, KeepsRemotePlanesApart) {
  Geometry::Builder builder;
  for (int round = 0; round < 2; ++round) {
    for (long i = 0; i < 3; ++i) {
      builder.add_plane(make_plane(1, 2, 3, power_of_two(2000) + i));
      builder.add_plane(make_plane(1, 0, 0, power_of_two(2000) + i));
    }
  }
  const Geometry geometry = std::move(builder).build();
  EXPECT_EQ(geometry.plane_count(), 6U);
  for (std::uint32_t i = 0; i < 6; ++i) {
    EXPECT_EQ(geometry.plane(i + 6), geometry.plane(i));
  }
  TierStatistics statistics;
  const Vertex v = geometry.meet(geometry.plane(0).plane, PlaneRef::of_wall(Axis::X, 1),
                                 PlaneRef::of_wall(Axis::Y, 1));
  EXPECT_EQ(geometry.side(v, geometry.plane(2).plane, statistics), Sign::Positive);
  EXPECT_EQ(geometry.side(v, geometry.plane(1).plane, statistics), Sign::Positive);
}

}  // namespace
}  // namespace exactcsg
