// SPDX-License-Identifier: GPL-3.0-or-later
// What the collector of pieces keeps: the expected values are what was added, counted by hand.

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <vector>

#include "exactcsg/solid/piece_buffer.hpp"
#include "exactcsg/solid/primitive.hpp"

namespace exactcsg {
namespace {

class PieceCollectorTest : public testing::Test {
 protected:
  static PlaneRef wall(Axis axis, double position) { return PlaneRef::of_wall(axis, position); }

  // A rectangle in z = 0 between walls, as four meeting points.
  std::vector<Corner> rectangle(double x0, double x1) const {
    const PlaneRef z = wall(Axis::Z, 0);
    const PlaneRef left = wall(Axis::X, x0);
    const PlaneRef right = wall(Axis::X, x1);
    const PlaneRef front = wall(Axis::Y, 0);
    const PlaneRef back = wall(Axis::Y, 1);
    const Geometry& geometry = scene_.geometry;
    return {{geometry.meet(z, left, front), front},
            {geometry.meet(z, right, front), right},
            {geometry.meet(z, right, back), back},
            {geometry.meet(z, left, back), left}};
  }

  void add(double x0, double x1, std::uint64_t share = 1) {
    const std::vector<Corner> corners = rectangle(x0, x1);
    collector_.add({wall(Axis::Z, 0), 1}, 1, 0, share, corners);
  }

  Scene scene_ = make_scene(Solid::primitive(Primitive{make_box({0, 0, 0}, {1, 1, 1})}));
  PieceCollector collector_;
};

// LAW pieces.1
TEST_F(PieceCollectorTest, KeepsEachMeetingPointOnce) {
  add(0, 1);
  add(1, 2);
  const PieceBuffer buffer = collector_.take();
  ASSERT_EQ(buffer.pieces.size(), 2U);
  EXPECT_EQ(buffer.corners.size(), 8U);
  EXPECT_EQ(buffer.meeting_points.size(), 6U);
  const auto first = buffer.corners_of(buffer.pieces[0]);
  const auto second = buffer.corners_of(buffer.pieces[1]);
  EXPECT_EQ(first[1].vertex, second[0].vertex);
  EXPECT_EQ(first[2].vertex, second[3].vertex);
  EXPECT_EQ(buffer.meeting_points[second[1].vertex].x, 2);
}

TEST_F(PieceCollectorTest, KeepsNoCornersOfWholeFacets) {
  add(0, 1, facet_share::whole);
  const PieceBuffer buffer = collector_.take();
  EXPECT_EQ(buffer.pieces.size(), 1U);
  EXPECT_TRUE(buffer.corners.empty());
  EXPECT_TRUE(buffer.meeting_points.empty());
}

// More meeting points than the table of them begins with, taken back and added again.
TEST_F(PieceCollectorTest, TakesBackWhatWasAddedSinceAMark) {
  add(0, 1);
  const PieceCollector::Mark mark = collector_.mark();
  for (int i = 1; i < 60; ++i) add(i, i + 1);
  EXPECT_EQ(collector_.pieces_since(mark).size(), 59U);
  collector_.take_back_to(mark);
  EXPECT_TRUE(collector_.pieces_since(mark).empty());
  add(1, 2);
  const PieceBuffer buffer = collector_.take();
  EXPECT_EQ(buffer.pieces.size(), 2U);
  EXPECT_EQ(buffer.meeting_points.size(), 6U);
}

// A cell that an error ended leaves nothing to the next one.
TEST_F(PieceCollectorTest, DiscardsWhatACellLeft) {
  add(0, 1);
  collector_.discard();
  add(1, 2);
  const PieceBuffer buffer = collector_.take();
  EXPECT_EQ(buffer.pieces.size(), 1U);
  EXPECT_EQ(buffer.corners.size(), 4U);
  EXPECT_EQ(buffer.meeting_points.size(), 4U);
  EXPECT_TRUE(collector_.take().pieces.empty());
}

TEST_F(PieceCollectorTest, BuffersAreAppended) {
  add(0, 1);
  PieceBuffer all = collector_.take();
  add(1, 2);
  append(collector_.take(), all);
  ASSERT_EQ(all.pieces.size(), 2U);
  const auto second = all.corners_of(all.pieces[1]);
  EXPECT_EQ(all.meeting_points[second[0].vertex].x, 1);
  EXPECT_EQ(all.meeting_points[second[1].vertex].x, 2);
}

// LAW pieces.2
TEST_F(PieceCollectorTest, CompactedBuffersHoldWhatPiecesNeed) {
  for (int i = 0; i < 5; ++i) add(i, i + 1);
  PieceBuffer buffer = collector_.take();
  buffer.pieces[1].share = facet_share::whole;
  buffer.pieces.erase(buffer.pieces.begin() + 3);
  // Of five rectangles in a row, the first, the third and the last are left with their corners.
  const PieceBuffer result = compacted(buffer);
  ASSERT_EQ(result.pieces.size(), 4U);
  EXPECT_EQ(result.pieces[1].share, facet_share::whole);
  EXPECT_EQ(result.pieces[1].corner_count, 0U);
  EXPECT_EQ(result.corners.size(), 3U * 4);
  EXPECT_EQ(result.meeting_points.size(), 3U * 4);
  EXPECT_EQ(result.corners.capacity(), result.corners.size());
  for (const std::size_t p : {0U, 2U, 3U}) {
    const auto before = buffer.corners_of(buffer.pieces[p]);
    const auto after = result.corners_of(result.pieces[p]);
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t i = 0; i < after.size(); ++i) {
      EXPECT_EQ(after[i].side_plane, before[i].side_plane);
      const Vertex& found = result.meeting_points[after[i].vertex];
      const Vertex& expected = buffer.meeting_points[before[i].vertex];
      EXPECT_TRUE(std::equal(std::begin(found.planes), std::end(found.planes), expected.planes));
    }
  }
  EXPECT_TRUE(compacted({}).pieces.empty());
}

}  // namespace
}  // namespace exactcsg
