// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/polygon.hpp"

#include <cmath>

#include "exactcsg/support/error.hpp"

namespace exactcsg {

namespace {

PlaneSplit split_of(bool negative, bool positive) {
  if (negative && positive) return PlaneSplit::Both;
  if (negative) return PlaneSplit::AllNegative;
  return positive ? PlaneSplit::AllPositive : PlaneSplit::InPlane;
}

}  // namespace

PlaneSplit split_signs(const Geometry& geometry, const CornerView& polygon, PlaneRef plane,
                       std::vector<Sign>& signs, TierStatistics& statistics) {
  signs.resize(polygon.size());
  bool negative = false;
  bool positive = false;
  polygon.for_each_vertex([&](std::size_t i, const Vertex& vertex) {
    signs[i] = geometry.side(vertex, plane, statistics);
    negative |= signs[i] == Sign::Negative;
    positive |= signs[i] == Sign::Positive;
  });
  return split_of(negative, positive);
}

PlaneSplit wall_signs(const Geometry& geometry, const CornerView& polygon, Axis axis,
                      double position, std::vector<Sign>& signs, TierStatistics& statistics) {
  signs.resize(polygon.size());
  bool negative = false;
  bool positive = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const auto [value, error] = polygon.coordinate(i, axis);
    const double difference = value - position;
    // The filter of compare_coordinate, without the vertex.
    if (std::abs(difference) > error * (1 + 0x1p-50)) {
      signs[i] = difference > 0 ? Sign::Positive : Sign::Negative;
      statistics.record(Tier::Double, false);
    } else {
      signs[i] = geometry.compare_coordinate(polygon.vertex(i), axis, position, statistics);
    }
    negative |= signs[i] == Sign::Negative;
    positive |= signs[i] == Sign::Positive;
  }
  return split_of(negative, positive);
}

PolygonCut::PolygonCut(const Geometry& geometry, const CornerView& polygon, PlaneRef supporting,
                       PlaneRef plane, std::span<const Sign> signs)
    : plane_(plane) {
  std::size_t found = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Sign there = signs[i + 1 == polygon.size() ? 0 : i + 1];
    if (signs[i] == Sign::Zero || there != -signs[i]) continue;
    if (found == crossings_.size()) {
      throw Error(ErrorId::InternalError, {"a facet that is not convex", "a convex one"});
    }
    const std::size_t next = i + 1 == polygon.size() ? 0 : i + 1;
    crossings_[found++] = geometry.meet(supporting, polygon.side_plane(i), plane, polygon.vertex(i),
                                        polygon.vertex(next));
  }
}

void PolygonCut::append_part(const CornerView& polygon, std::span<const Sign> signs, Sign kept,
                             std::vector<Corner>& result) const {
  const std::size_t count = polygon.size();
  std::size_t crossing = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Sign here = signs[i];
    const Sign there = signs[i + 1 == count ? 0 : i + 1];
    if (here == kept || here == Sign::Zero) {
      // A corner in the cutting plane whose next side leaves the kept part starts the cut side.
      const bool leaves = here == Sign::Zero && there != kept;
      result.push_back({polygon.vertex(i), leaves ? plane_ : polygon.side_plane(i)});
    }
    if (here != Sign::Zero && there == -here) {
      result.push_back({crossings_[crossing++], there == kept ? polygon.side_plane(i) : plane_});
    }
  }
}

void Slicer::append(const Geometry& geometry, const CornerView& polygon, PlaneRef supporting,
                    const Slice& slice, std::vector<Corner>& result) {
  CornerView part = polygon;
  const std::span<const Slice::Wall> walls = slice.walls();
  for (std::size_t i = 0; i + 1 < walls.size(); ++i) {
    std::vector<Corner>& next = parts_[i % 2];
    next.clear();
    cut(geometry, part, supporting, walls[i], next);
    part = next;
  }
  cut(geometry, part, supporting, walls.back(), result);
}

void Slicer::cut(const Geometry& geometry, const CornerView& polygon, PlaneRef supporting,
                 const Slice::Wall& wall, std::vector<Corner>& result) {
  TierStatistics counted_before;  // when the slice was made
  const PlaneSplit split = wall_signs(geometry, polygon, wall.plane.wall_axis(),
                                      wall.plane.wall_position(), signs_, counted_before);
  if (split == PlaneSplit::Both) {
    PolygonCut(geometry, polygon, supporting, wall.plane, signs_)
        .append_part(polygon, signs_, wall.kept, result);
  } else {
    polygon.append_to(result);
  }
}

}  // namespace exactcsg
