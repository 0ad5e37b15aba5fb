// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/solid/vertex_row.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace exactcsg {
namespace {

// LAW vertex_row.1: vertices of both kinds, added one by one and set in places.
TEST(VertexRow, GivesWhatWasAdded) {
  Geometry::Builder builder;
  for (int i = 0; i < 5; ++i) builder.add_point({i, 2 * i, 0});
  const Geometry geometry = std::move(builder).build();
  std::vector<Vertex> vertices;
  for (std::uint32_t i = 0; i < 5; ++i) {
    vertices.push_back(geometry.vertex(PointId{i}));
    vertices.push_back(geometry.meet(PlaneRef::of_wall(Axis::X, i), PlaneRef::of_wall(Axis::Y, 7),
                                     PlaneRef::of_wall(Axis::Z, 0.5)));
    vertices.push_back(geometry.vertex(PointId{4 - i}));
  }
  VertexRow row(geometry, vertices);
  VertexRow::Counts next{vertices.size(), 5};
  row.grow(2, next);
  for (const Vertex& vertex : vertices) row.set(vertex, next);
  ASSERT_EQ(row.size(), 2 * vertices.size());
  for (std::size_t i = 0; i < row.size(); ++i) {
    const Vertex& expected = vertices[i % vertices.size()];
    ASSERT_EQ(row.is_point(i), expected.is_point);
    EXPECT_EQ(row[i].is_point, expected.is_point);
    EXPECT_EQ(row[i].x, expected.x);
    EXPECT_EQ(row[i].y, expected.y);
    EXPECT_EQ(row[i].error, expected.error);
    if (expected.is_point) {
      EXPECT_EQ(row.point(i), expected.point);
    } else {
      for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(row[i].planes[k], expected.planes[k]);
    }
  }
}

}  // namespace
}  // namespace exactcsg
