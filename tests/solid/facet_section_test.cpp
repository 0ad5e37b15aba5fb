// SPDX-License-Identifier: GPL-3.0-or-later
// Sections of rectangles and what is left of them: the expected areas and numbers of regions are
// those of the figures drawn, worked out by hand. All coordinates are small dyadic numbers, so that
// areas by doubles are exact.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <numeric>
#include <span>
#include <vector>

#include "exactcsg/solid/facet_section.hpp"
#include "exactcsg/solid/primitive.hpp"

namespace exactcsg {
namespace {

struct Left {
  std::size_t loops = 0;
  bool is_ring = false;
  std::vector<double> areas;  // of the loops
  std::vector<std::size_t> corner_counts;
};

class FacetSectionTest : public testing::Test {
 protected:
  static PlaneRef x(double position) { return PlaneRef::of_wall(Axis::X, position); }
  static PlaneRef y(double position) { return PlaneRef::of_wall(Axis::Y, position); }

  // In the plane z = 0.
  CornerRun rectangle(double x0, double y0, double x1, double y1) {
    const Geometry& geometry = scene_.geometry;
    const std::vector<Corner> corners{{geometry.meet(z_, x(x0), y(y0)), y(y0)},
                                      {geometry.meet(z_, x(x1), y(y0)), x(x1)},
                                      {geometry.meet(z_, x(x1), y(y1)), y(y1)},
                                      {geometry.meet(z_, x(x0), y(y1)), x(x0)}};
    return append_polygon(corners, store_);
  }

  std::vector<Sign> signs_of(const CornerRun& polygon, PlaneRef plane) {
    std::vector<Sign> signs;
    for (const SectionCorner& corner : store_.of(polygon)) {
      signs.push_back(scene_.geometry.side(store_.vertex(corner), plane, statistics_));
    }
    return signs;
  }

  bool is_cut_by(const CornerRun& polygon, PlaneRef plane) {
    const std::vector<Sign> signs = signs_of(polygon, plane);
    const auto occurs = [&](Sign sign) { return std::ranges::find(signs, sign) != signs.end(); };
    return occurs(Sign::Negative) && occurs(Sign::Positive);
  }

  // REQUIRES the plane cuts it
  CornerRun cut(const CornerRun& polygon, PlaneRef plane, Sign kept) {
    const std::vector<Sign> signs = signs_of(polygon, plane);
    const CuttingPlane by{plane, signs};
    const auto crossings = append_crossings(scene_.geometry, z_, polygon, by, store_);
    return append_part(polygon, by, kept, crossings, store_);
  }

  // With |x| + |y| <= 1, the four planes of which are the scene's.
  CornerRun cut_by_diamond(CornerRun polygon) {
    for (const SceneFacet& facet : scene_.facets) {
      const Plane& plane = scene_.geometry.exact_plane(facet.plane.plane);
      if (plane.c != 0 || !is_cut_by(polygon, facet.plane.plane)) continue;
      polygon =
          cut(polygon, facet.plane.plane, facet.plane.sense > 0 ? Sign::Negative : Sign::Positive);
    }
    return polygon;
  }

  // What is left of the half of a polygon beside the polygon's section with the diamond.
  Left left_of_half(const CornerRun& polygon, PlaneRef plane, Sign kept) {
    const CornerRun section = cut_by_diamond(polygon);
    const CornerRun half = cut(polygon, plane, kept);
    const std::vector<Sign> signs = signs_of(section, plane);
    const CuttingPlane by{plane, signs};
    const auto crossings = append_crossings(scene_.geometry, z_, section, by, store_);
    const CornerRun part = append_part_of_half(section, by, kept, crossings, half, store_);
    forget_whole(half, store_);
    Left left = left_of(half, part);
    EXPECT_EQ(area_of(half) - area_of(part),
              std::accumulate(left.areas.begin(), left.areas.end(), 0.0));
    // Both are the same point set; the other way is that of all other tests.
    const Left by_cutting = left_of(half, cut_by_diamond(half));
    EXPECT_EQ(left.is_ring, by_cutting.is_ring);
    EXPECT_EQ(left.loops, by_cutting.loops);
    return left;
  }

  template <class Corners>
  double area(const Corners& corners) const {
    double twice = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vertex& v = store_.vertex(corners[i].vertex);
      const Vertex& w = store_.vertex(corners[i + 1 == corners.size() ? 0 : i + 1].vertex);
      twice += v.x * w.y - w.x * v.y;
    }
    return twice / 2;
  }
  double area_of(const CornerRun& run) const { return area(store_.of(run)); }

  // Every corner lies on the plane of the side from there and on that of the side to there.
  void expect_on_sides(const std::vector<LoopCorner>& loop) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const LoopCorner& next = loop[i + 1 == loop.size() ? 0 : i + 1];
      for (const std::uint32_t vertex : {loop[i].vertex, next.vertex}) {
        EXPECT_EQ(scene_.geometry.side(store_.vertex(vertex), loop[i].side_plane, statistics_),
                  Sign::Zero);
      }
      EXPECT_FALSE(scene_.geometry.same_position(store_.vertex(loop[i].vertex),
                                                 store_.vertex(next.vertex), statistics_));
    }
  }

  Left left_of(const CornerRun& polygon, const CornerRun& section) {
    const Remainder remainder(polygon, section, store_);
    Left left{remainder.loop_count(), remainder.is_ring(), {}, {}};
    for (std::size_t i = 0; i < remainder.loop_count(); ++i) {
      std::vector<LoopCorner> loop;
      remainder.append_loop(i, loop);
      expect_on_sides(loop);
      left.areas.push_back(area(loop));
      left.corner_counts.push_back(loop.size());
    }
    return left;
  }

  Scene scene_ = make_scene(Solid::primitive(Primitive{make_convex_polytope(
      std::array{make_half_space(1, 1, 0, -1), make_half_space(-1, 1, 0, -1),
                 make_half_space(-1, -1, 0, -1), make_half_space(1, -1, 0, -1),
                 make_half_space(0, 0, 1, -1), make_half_space(0, 0, -1, -1)})}));
  PlaneRef z_ = PlaneRef::of_wall(Axis::Z, 0);
  SectionStore store_;
  TierStatistics statistics_;
};

TEST_F(FacetSectionTest, CutsOffOneSide) {
  const CornerRun polygon = rectangle(0, 0, 4, 4);
  const CornerRun section = cut(polygon, x(1), Sign::Negative);
  EXPECT_EQ(area_of(section), 4);
  const Left left = left_of(polygon, section);
  EXPECT_FALSE(left.is_ring);
  EXPECT_EQ(left.areas, std::vector<double>{12});
  EXPECT_EQ(left.corner_counts, std::vector<std::size_t>{4});
}

// The chain runs from one side to the next one: an L.
TEST_F(FacetSectionTest, CutsOutACorner) {
  const CornerRun polygon = rectangle(0, 0, 4, 4);
  const CornerRun section = cut(cut(polygon, x(1), Sign::Negative), y(2), Sign::Negative);
  EXPECT_EQ(area_of(section), 2);
  const Left left = left_of(polygon, section);
  EXPECT_EQ(left.areas, std::vector<double>{14});
  EXPECT_EQ(left.corner_counts, std::vector<std::size_t>{6});
}

// Both ends of the chain lie on the same side of the rectangle: a U.
TEST_F(FacetSectionTest, CutsOutOfASide) {
  const CornerRun polygon = rectangle(0, 0, 4, 4);
  CornerRun section = cut(polygon, y(1), Sign::Negative);
  section = cut(section, x(1), Sign::Positive);
  section = cut(section, x(3), Sign::Negative);
  const Left left = left_of(polygon, section);
  EXPECT_EQ(left.areas, std::vector<double>{14});
  EXPECT_EQ(left.corner_counts, std::vector<std::size_t>{8});
}

TEST_F(FacetSectionTest, LeavesTwoRegionsBesideABar) {
  const CornerRun polygon = rectangle(0, 0, 4, 4);
  const CornerRun section = cut(cut(polygon, x(1), Sign::Positive), x(2), Sign::Negative);
  Left left = left_of(polygon, section);
  EXPECT_FALSE(left.is_ring);
  std::sort(left.areas.begin(), left.areas.end());
  EXPECT_EQ(left.areas, (std::vector<double>{4, 8}));
}

TEST_F(FacetSectionTest, LeavesARingRoundAHole) {
  const CornerRun polygon = rectangle(0, 0, 4, 4);
  CornerRun section = cut(polygon, x(1), Sign::Positive);
  section = cut(section, y(1), Sign::Positive);
  section = cut(section, x(2), Sign::Negative);
  section = cut(section, y(3), Sign::Negative);
  const Left left = left_of(polygon, section);
  EXPECT_TRUE(left.is_ring);
  EXPECT_EQ(left.areas, (std::vector<double>{16, -2}));
}

// The diamond's corners are the middles of the square's sides.
TEST_F(FacetSectionTest, LeavesFourTrianglesRoundADiamondThatTouchesEverySide) {
  const CornerRun polygon = rectangle(-1, -1, 1, 1);
  const CornerRun section = cut_by_diamond(polygon);
  EXPECT_EQ(area_of(section), 2);
  const Left left = left_of(polygon, section);
  EXPECT_FALSE(left.is_ring);
  EXPECT_EQ(left.areas, (std::vector<double>{0.5, 0.5, 0.5, 0.5}));
  EXPECT_EQ(left.corner_counts, (std::vector<std::size_t>{3, 3, 3, 3}));
}

// One corner of the diamond lies on a side: one region that touches itself there.
TEST_F(FacetSectionTest, LeavesOneRegionRoundADiamondThatTouchesOneSide) {
  const CornerRun polygon = rectangle(-1, -2, 2, 2);
  const Left left = left_of(polygon, cut_by_diamond(polygon));
  EXPECT_FALSE(left.is_ring);
  EXPECT_EQ(left.areas, std::vector<double>{10});
  EXPECT_EQ(left.corner_counts, std::vector<std::size_t>{4 + 5});
}

// A corner of the diamond is a corner of the rectangle, where the rectangle's sides run inside.
TEST_F(FacetSectionTest, TakesCornersOfThePolygonForPlacesOnItsRim) {
  const CornerRun polygon = rectangle(0, -1, 2, 1);
  const CornerRun section = cut_by_diamond(polygon);
  EXPECT_EQ(area_of(section), 1);
  Left left = left_of(polygon, section);
  // The triangle (0, -1), (0, 1), (1, 0) has the side x = 0 of the rectangle in common.
  EXPECT_EQ(left.areas, std::vector<double>{3});
  EXPECT_EQ(left.corner_counts, std::vector<std::size_t>{5});
}

// The diamond's corner at (1, 0) is cut off along x = 1/2.
TEST_F(FacetSectionTest, CutsASectionWithItsPolygon) {
  const CornerRun polygon = rectangle(-2, -2, 2, 2);
  const Left below = left_of_half(polygon, x(0.5), Sign::Negative);
  EXPECT_FALSE(below.is_ring);
  EXPECT_EQ(below.areas, std::vector<double>{10 - 1.75});
  EXPECT_EQ(below.corner_counts, std::vector<std::size_t>{4 + 2 + 3});
  const Left above = left_of_half(polygon, x(0.5), Sign::Positive);
  EXPECT_FALSE(above.is_ring);
  EXPECT_EQ(above.areas, std::vector<double>{6 - 0.25});
  EXPECT_EQ(above.corner_counts, std::vector<std::size_t>{4 + 2 + 1});
}

// The diamond touches three sides of the square's half, and has a fourth side in common with it.
TEST_F(FacetSectionTest, CutsASectionOnTheRimWithItsPolygon) {
  Left left = left_of_half(rectangle(-1, -1, 1, 1), x(0.5), Sign::Negative);
  EXPECT_FALSE(left.is_ring);
  std::sort(left.areas.begin(), left.areas.end());
  EXPECT_EQ(left.areas, (std::vector<double>{0.125, 0.125, 0.5, 0.5}));
  EXPECT_EQ(left.corner_counts, (std::vector<std::size_t>{3, 3, 3, 3}));
}

// Two corners of the diamond lie in the plane.
TEST_F(FacetSectionTest, CutsASectionThroughItsCorners) {
  const Left left = left_of_half(rectangle(-2, -2, 2, 2), x(0), Sign::Negative);
  EXPECT_FALSE(left.is_ring);
  EXPECT_EQ(left.areas, std::vector<double>{8 - 1});
  EXPECT_EQ(left.corner_counts, std::vector<std::size_t>{4 + 2 + 1});
}

// The half has a side of its own along the diamond's.
TEST_F(FacetSectionTest, FindsASectionOnTheRimOfAHalf) {
  for (const SceneFacet& facet : scene_.facets) {
    if (scene_.geometry.exact_plane(facet.plane.plane).c != 0) continue;
    const Sign inner = facet.plane.sense > 0 ? Sign::Negative : Sign::Positive;
    const Left left = left_of_half(rectangle(-2, -2, 2, 2), facet.plane.plane, inner);
    EXPECT_FALSE(left.is_ring);
    EXPECT_EQ(left.areas, std::vector<double>{16 - 4.5 - 2});
    EXPECT_EQ(left.corner_counts, std::vector<std::size_t>{5 + 2 + 2});
  }
}

// A corner of the diamond alone lies on the half's new side, or the diamond is off it.
TEST_F(FacetSectionTest, FindsASectionThatTouchesAHalfOrNot) {
  const Left touching = left_of_half(rectangle(-2, -2, 2, 2), x(1), Sign::Negative);
  EXPECT_FALSE(touching.is_ring);
  EXPECT_EQ(touching.areas, std::vector<double>{12 - 2});
  EXPECT_EQ(touching.corner_counts, std::vector<std::size_t>{4 + 5});
  const Left apart = left_of_half(rectangle(-2, -2, 2, 2), x(1.5), Sign::Negative);
  EXPECT_TRUE(apart.is_ring);
  EXPECT_EQ(apart.areas, (std::vector<double>{14, -2}));
}

// LAW section.2
TEST_F(FacetSectionTest, KeepsEachMeetingPointOnce) {
  const CornerRun polygon = rectangle(0, 0, 4, 4);
  const CornerRun first = cut(polygon, x(1), Sign::Negative);
  const std::size_t count = store_.vertex_count();
  const CornerRun second = cut(polygon, x(1), Sign::Positive);
  EXPECT_EQ(store_.vertex_count(), count);
  EXPECT_EQ(store_.of(first)[1].vertex, store_.of(second)[0].vertex);
  store_.clear();
  EXPECT_EQ(store_.vertex_count(), 0U);
}

}  // namespace
}  // namespace exactcsg
