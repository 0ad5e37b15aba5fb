// SPDX-License-Identifier: GPL-3.0-or-later
// Expected: the definition of a whole facet (LAW whole.1), of parts made by hand.
#include "exactcsg/solid/whole_facets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "exactcsg/solid/primitive.hpp"

namespace exactcsg {
namespace {

constexpr std::uint64_t half = facet_share::whole / 2;

class WholeFacets : public ::testing::Test {
 protected:
  // A part of a facet, without corners.
  static BoundaryPiece part(FacetIndex facet, std::uint64_t share, int sense, bool general = true) {
    BoundaryPiece piece;
    piece.plane.sense = static_cast<signed char>(sense);
    piece.facet = facet;
    piece.share = share;
    piece.in_general_position = general;
    return piece;
  }

  static PieceBuffer buffer(std::vector<BoundaryPiece> pieces) {
    PieceBuffer result;
    result.pieces = std::move(pieces);
    return result;
  }

  // Facet, share and general position of the pieces of each buffer.
  using Row = std::vector<std::array<std::uint64_t, 3>>;
  static std::vector<Row> rows(const std::vector<PieceBuffer>& buffers) {
    std::vector<Row> result;
    for (const PieceBuffer& buffer : buffers) {
      Row& row = result.emplace_back();
      for (const BoundaryPiece& piece : buffer.pieces) {
        row.push_back({piece.facet, piece.share, piece.in_general_position ? 1U : 0U});
      }
    }
    return result;
  }

  const Scene scene_ = make_scene(Solid::primitive({make_box({0, 0, 0}, {1, 1, 1})}), 1);
};

TEST_F(WholeFacets, ArePutTogetherWhereTheirFirstPartIs) {
  for (const unsigned threads : {1U, 3U}) {
    std::vector<PieceBuffer> buffers{
        buffer({part(0, half / 2, 1), part(1, half, -1)}),
        buffer({part(0, half, 1), part(2, facet_share::whole, 1)}),
        buffer({part(0, half / 2, 1, false), part(1, half, -1), part(1, 0, -1)})};
    restore_whole_facets(scene_, buffers, threads);
    // Facet 0 is not in general position, since a part of it is not.
    EXPECT_EQ(rows(buffers),
              (std::vector<Row>{{{0, facet_share::whole, 0}, {1, facet_share::whole, 1}},
                                {{2, facet_share::whole, 1}},
                                {}}));
  }
}

TEST_F(WholeFacets, AreNotMadeOfPartsOfBothSenses) {
  for (const unsigned threads : {1U, 3U}) {
    std::vector<PieceBuffer> buffers{buffer({part(3, half, 1)}), buffer({part(3, half, -1)}),
                                     buffer({part(4, half, 1), part(4, half / 2, 1)})};
    const std::vector<Row> before = rows(buffers);
    restore_whole_facets(scene_, buffers, threads);
    EXPECT_EQ(rows(buffers), before);
  }
}

// Many buffers, so that several threads take some each.
TEST_F(WholeFacets, DoNotDependOnThreads) {
  constexpr std::size_t count = 6000;
  const auto buffers = [] {
    std::vector<PieceBuffer> result;
    for (std::size_t b = 0; b < count; ++b) {
      const auto facet = static_cast<FacetIndex>(b % 5);
      result.push_back(buffer({part(facet, facet_share::whole / 1200 / 2, 1)}));
    }
    // What is missing, for all facets but one.
    for (FacetIndex facet = 0; facet < 4; ++facet) {
      result.push_back(
          buffer({part(facet, facet_share::whole - facet_share::whole / 1200 / 2 * 1200, 1)}));
    }
    return result;
  };
  std::vector<PieceBuffer> one = buffers();
  restore_whole_facets(scene_, one, 1);
  std::vector<PieceBuffer> three = buffers();
  restore_whole_facets(scene_, three, 3);
  EXPECT_EQ(rows(one), rows(three));
  std::size_t pieces = 0;
  for (const PieceBuffer& b : one) pieces += b.pieces.size();
  EXPECT_EQ(pieces, 4 + 1200);
  for (FacetIndex facet = 0; facet < 4; ++facet) {
    ASSERT_EQ(one[facet].pieces.size(), 1);
    EXPECT_EQ(one[facet].pieces[0].share, facet_share::whole);
  }
}

// The facet of the unit cube in z = 0 between walls: a rectangle, whose corners are known.
class SlicesOfWholeFacets : public WholeFacets {
 protected:
  static constexpr double position = 0.25;

  FacetIndex bottom() const {
    for (FacetIndex facet = 0; facet < scene_.facets.size(); ++facet) {
      if (scene_.bounds.facets[2][facet].upper < 0.5) return facet;
    }
    ADD_FAILURE() << "no facet in z = 0";
    return 0;
  }

  PieceBuffer slice(Sign kept_of_x, Sign kept_of_y) {
    Slice slice;
    if (kept_of_x != Sign::Zero) slice.add({PlaneRef::of_wall(Axis::X, position), kept_of_x});
    if (kept_of_y != Sign::Zero) slice.add({PlaneRef::of_wall(Axis::Y, position), kept_of_y});
    const OrientedPlaneRef plane = scene_.facets[bottom()].plane;
    collector_.add_slice(plane, plane.sense, bottom(), half / 2, slice);
    return collector_.take();
  }

  PieceCollector collector_;
};

TEST_F(SlicesOfWholeFacets, AreCutIfAPartIsMissing) {
  std::vector<PieceBuffer> buffers{slice(Sign::Positive, Sign::Zero),
                                   slice(Sign::Positive, Sign::Negative)};
  restore_whole_facets(scene_, buffers, 1);
  const std::array<std::array<Range, 3>, 2> expected{
      {{Range{position, 1}, Range{0, 1}, Range{0, 0}},
       {Range{position, 1}, Range{0, position}, Range{0, 0}}}};
  for (std::size_t b = 0; b < 2; ++b) {
    ASSERT_EQ(buffers[b].pieces.size(), 1);
    const BoundaryPiece& piece = buffers[b].pieces.front();
    EXPECT_FALSE(piece.is_slice);
    ASSERT_EQ(piece.corner_count, 4);
    std::array<Range, 3> bounds;
    for (const PieceCorner& corner : buffers[b].corners_of(piece)) {
      const Vertex vertex = corner.is_point
                                ? scene_.geometry.vertex(static_cast<PointId>(corner.vertex))
                                : buffers[b].meeting_points[corner.vertex];
      for (const Axis axis : {Axis::X, Axis::Y, Axis::Z}) {
        Range& range = bounds[static_cast<std::size_t>(axis)];
        range.lower = std::min(range.lower, vertex.coordinate(axis));
        range.upper = std::max(range.upper, vertex.coordinate(axis));
      }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(bounds[axis].lower, expected[b][axis].lower);
      EXPECT_EQ(bounds[axis].upper, expected[b][axis].upper);
    }
  }
}

TEST_F(SlicesOfWholeFacets, AddUpToAWhole) {
  std::vector<PieceBuffer> buffers{
      slice(Sign::Positive, Sign::Positive), slice(Sign::Positive, Sign::Negative),
      slice(Sign::Negative, Sign::Positive), slice(Sign::Negative, Sign::Negative)};
  restore_whole_facets(scene_, buffers, 1);
  EXPECT_EQ(rows(buffers), (std::vector<Row>{{{bottom(), facet_share::whole, 0}}, {}, {}, {}}));
  EXPECT_FALSE(buffers.front().pieces.front().is_slice);
  EXPECT_TRUE(buffers.front().corners.empty());
}

}  // namespace
}  // namespace exactcsg
