// SPDX-License-Identifier: GPL-3.0-or-later
// Planes before they are added, against planes through the same points in rational arithmetic.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <utility>
#include <vector>

#include "exactcsg/number/prepared_plane.hpp"
#include "exactcsg/support/error.hpp"
#include "exactcsg/support/in_parallel.hpp"
#include "number/reference.hpp"

namespace exactcsg {
namespace {

// How far from the origin, and on which grid.
struct Places {
  Rational origin;
  Rational step;
};

std::vector<Places> all_places() {
  const Integer far = Integer(1) << 70;
  return {{0, 1},
          {0, Rational(1, 3)},
          {Rational(1, 7), Rational(1, 1024)},
          {far, 1},
          {Rational(far), Rational(1, 3)},
          {0, Rational(far * far * far * far * far * far)}};
}

class RandomPoints {
 public:
  explicit RandomPoints(Places places) : places_(std::move(places)) {}
  Point3 operator()() { return {coordinate(), coordinate(), coordinate()}; }

 private:
  Rational coordinate() { return places_.origin + places_.step * distribution_(random_); }

  Places places_;
  std::mt19937_64 random_{7};
  std::uniform_int_distribution<int> distribution_{-4, 4};
};

Point3 moved(Point3 p, Axis axis) {
  (axis == Axis::X ? p.x : axis == Axis::Y ? p.y : p.z) += 1;
  return p;
}

// Where the filter answers, it does so as the plane does.
void expect_certified(const Geometry::ApproximatePlane& near, const reference::RationalPlane& plane,
                      RandomPoints& points) {
  for (int i = 0; i < 20; ++i) {
    const Point3 point = points();
    const double side = Geometry::filtered_side(near, approximate(point));
    if (side == 0) continue;
    EXPECT_EQ(side > 0 ? 1 : -1, sgn(reference::value_at(plane, point)));
  }
}

TEST(PreparedPlane, ThroughThreePointsIsCertified) {
  for (const Places& places : all_places()) {
    RandomPoints points(places);
    for (int round = 0; round < 200; ++round) {
      const Point3 p = points();
      const Point3 q = points();
      const Point3 r = points();
      const reference::RationalPlane plane = reference::plane_through(p, q, r);
      const ApproximatePoint near_p = approximate(p);
      const ApproximatePoint near_q = approximate(q);
      const ApproximatePoint near_r = approximate(r);
      if (reference::is_degenerate(plane)) {
        EXPECT_THROW(prepared_plane({p, near_p}, {q, near_q}, {r, near_r}), Error);
        continue;
      }
      expect_certified(prepared_plane({p, near_p}, {q, near_q}, {r, near_r}).near, plane, points);
      if (const auto quick = quickly_prepared_plane({p, near_p}, {q, near_q}, {r, near_r})) {
        expect_certified(quick->near, plane, points);
      }
    }
  }
}

// The normal is (q - p) x (the axis): the plane through p, q and p moved up.
TEST(PreparedPlane, AlongAnAxisIsThroughTheMovedPoint) {
  for (const Places& places : all_places()) {
    RandomPoints points(places);
    for (int round = 0; round < 200; ++round) {
      const Point3 p = points();
      const Point3 q = points();
      const ApproximatePoint near_p = approximate(p);
      const ApproximatePoint near_q = approximate(q);
      for (const Axis axis : {Axis::X, Axis::Y, Axis::Z}) {
        const reference::RationalPlane plane = reference::plane_through(p, q, moved(p, axis));
        if (reference::is_degenerate(plane)) {
          EXPECT_THROW(prepared_plane({p, near_p}, {q, near_q}, axis), Error);
          continue;
        }
        expect_certified(prepared_plane({p, near_p}, {q, near_q}, axis).near, plane, points);
        Geometry::Builder builder;
        const PointId first = builder.add_point(p);
        const PointId second = builder.add_point(q);
        builder.add_plane(prepared_plane({p, near_p}, {q, near_q}, axis), first, second, axis);
        const std::uint32_t again =
            builder.add_plane(first, second, builder.add_point(moved(p, axis)));
        const Geometry geometry = std::move(builder).build();
        EXPECT_EQ(geometry.plane(again), geometry.plane(0));
        EXPECT_EQ(geometry.exact_plane(geometry.plane(0).plane),
                  make_plane(plane.normal[0], plane.normal[1], plane.normal[2], plane.offset));
      }
    }
  }
}

// Many points that doubles cannot tell apart, nor tell at all.
TEST(Builder, TellsPointsOfEqualDoublesApart) {
  for (const int exponent : {100, 1200}) {
    const Rational origin(Integer(1) << static_cast<unsigned long>(exponent));
    Geometry::Builder builder;
    for (int round = 0; round < 2; ++round) {
      for (long i = 0; i < 2000; ++i) {
        const PointId id = builder.add_point({origin + i, origin, Rational(1, 3)});
        ASSERT_EQ(static_cast<long>(id), i);
      }
    }
  }
}

// Planes through three points each of a grid, of which many coincide in either sense.
struct PlanesOfGrid {
  using Triple = std::array<std::uint32_t, 3>;
  std::vector<Point3> points;
  std::vector<Triple> triples;

  explicit PlanesOfGrid(const Rational& step) {
    constexpr long side = 16;
    for (long i = 0; i < side * side * side; ++i) {
      points.push_back(
          {step * (i % side), step * Rational(i / side % side, 3), step * (i / (side * side))});
    }
    std::mt19937 random(7);
    while (triples.size() < 9000) {
      Triple triple{};
      for (std::uint32_t& point : triple) {
        point = static_cast<std::uint32_t>(random() % points.size());
      }
      const auto [a, b, c] = triple;
      if (cross(points[b] - points[a], points[c] - points[a]) != Vector3{}) {
        triples.push_back(triple);
      }
    }
  }

  Geometry one_by_one() const {
    Geometry::Builder builder;
    for (const Point3& point : points) builder.add_point(point);
    for (const auto& [a, b, c] : triples) builder.add_plane(PointId{a}, PointId{b}, PointId{c});
    return std::move(builder).build();
  }

  Geometry at_once(unsigned threads) const {
    Geometry::Builder builder;
    std::vector<ApproximatePoint> near;
    for (const Point3& point : points) {
      builder.add_point(point);
      near.push_back(approximate(point));
    }
    const std::uint32_t first = builder.add_planes(triples.size(), threads);
    in_parallel(threads, triples.size(), [&](std::size_t i) {
      const std::uint32_t a = triples[i][0];
      const std::uint32_t b = triples[i][1];
      const std::uint32_t c = triples[i][2];
      builder.set_plane(
          static_cast<std::uint32_t>(first + i),
          prepared_plane({points[a], near[a]}, {points[b], near[b]}, {points[c], near[c]}),
          PointId{a}, PointId{b}, PointId{c});
    });
    // Each of them twice.
    for (std::uint32_t i = 0; i < 2 * triples.size(); ++i) {
      const std::uint32_t plane = i % static_cast<std::uint32_t>(triples.size());
      for (const std::uint32_t point : triples[plane]) {
        builder.add_incidence(PointId{point}, first + plane);
      }
    }
    return std::move(builder).build(threads);
  }
};

// Expected: the planes that are added one by one, and incidences that are known without computing.
TEST(Builder, PlanesThatThreadsSetAreThoseAddedOneByOne) {
  // The doubles of planes far away are left out of what they are compared by.
  for (const Rational& step : {Rational(1), Rational(Integer(1) << 500)}) {
    const PlanesOfGrid grid(step);
    const Geometry expected = grid.one_by_one();
    for (const unsigned threads : {1U, 3U}) {
      const Geometry geometry = grid.at_once(threads);
      EXPECT_TRUE(std::ranges::equal(geometry.planes(), expected.planes()));
      ASSERT_LT(geometry.plane_count(), grid.triples.size());
      TierStatistics statistics;
      for (std::uint32_t i = 0; i < grid.triples.size(); ++i) {
        const PlaneRef plane = geometry.plane(i).plane;
        EXPECT_EQ(geometry.exact_plane(plane), expected.exact_plane(plane));
        for (const std::uint32_t point : grid.triples[i]) {
          EXPECT_EQ(geometry.side(geometry.vertex(PointId{point}), plane, statistics), Sign::Zero);
        }
      }
      EXPECT_EQ(statistics.answers[static_cast<std::size_t>(Tier::Symbolic)],
                3 * grid.triples.size());
    }
  }
}

}  // namespace
}  // namespace exactcsg
