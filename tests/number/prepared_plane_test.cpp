// SPDX-License-Identifier: GPL-3.0-or-later
// Planes before they are added, against planes through the same points in rational arithmetic.

#include <gtest/gtest.h>

#include <random>
#include <utility>
#include <vector>

#include "exactcsg/number/prepared_plane.hpp"
#include "exactcsg/support/error.hpp"
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

}  // namespace
}  // namespace exactcsg
