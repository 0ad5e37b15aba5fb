// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/number/plane_table.hpp"

namespace exactcsg {

namespace {

Plane plane_through(const PointTable& points, const std::array<PointId, 3>& through) {
  return plane_through(homogeneous_of(points.exact(through[0])),
                       homogeneous_of(points.exact(through[1])),
                       homogeneous_of(points.exact(through[2])));
}

double coordinate(const ApproximatePoint& p, Axis axis) {
  return axis == Axis::X ? p.x : axis == Axis::Y ? p.y : p.z;
}

bool share_coordinate(const PointTable& points, const std::array<PointId, 3>& through, Axis axis) {
  const double first = coordinate(points.approximate(through[0]), axis);
  for (const PointId id : {through[1], through[2]}) {
    if (coordinate(points.approximate(id), axis) != first) return false;
  }
  const auto inexact = [&points](PointId id) { return points.approximate(id).error != 0; };
  if (!inexact(through[0]) && !inexact(through[1]) && !inexact(through[2])) return true;
  const Rational& exact = coordinate(points.exact(through[0]), axis);
  return coordinate(points.exact(through[1]), axis) == exact &&
         coordinate(points.exact(through[2]), axis) == exact;
}

double position_error(const PointTable& points, PointId id, Axis axis) {
  const ApproximatePoint& p = points.approximate(id);
  if (p.error == 0) return 0;
  const bool exact = rational_of(coordinate(p, axis)) == coordinate(points.exact(id), axis);
  return exact ? 0 : p.error * error_inflation;
}

// A plane that is exactly axis-parallel is recognised before anything is rounded: then its normal
// has no error, and coordinates can be compared with it instead of products.
std::optional<ApproximatePlane> axis_parallel_through(const PointTable& points,
                                                      const std::array<PointId, 3>& through,
                                                      const ApproximatePlane& plane) {
  for (const Axis axis : {Axis::X, Axis::Y, Axis::Z}) {
    if (!share_coordinate(points, through, axis)) continue;
    // The other two normal coefficients are zero, so this is the largest one, of certain sign.
    const double normal = axis == Axis::X ? plane.a : axis == Axis::Y ? plane.b : plane.c;
    return axis_parallel(axis, normal > 0 ? 1 : -1,
                         coordinate(points.approximate(through[0]), axis),
                         position_error(points, through[0], axis));
  }
  return std::nullopt;
}

}  // namespace

std::uint32_t AddedPlanes::add(const PointTable& points, const std::array<PointId, 3>& through) {
  PlaneSource source{through, nullptr, true};
  std::optional<ApproximatePlane> plane =
      approximate_plane_through(points.approximate(through[0]), points.approximate(through[1]),
                                points.approximate(through[2]));
  if (!plane) {
    source.exact = std::make_unique<const Plane>(plane_through(points, through));
    plane = exactcsg::approximate(*source.exact);
  } else if (const auto parallel = axis_parallel_through(points, through, *plane)) {
    plane = parallel;
  }
  approximate_.push_back(*plane);
  sources_.push_back(std::move(source));
  return size() - 1;
}

std::uint32_t AddedPlanes::add(const Plane& plane) {
  approximate_.push_back(exactcsg::approximate(plane));
  sources_.push_back({{}, std::make_unique<const Plane>(plane), false});
  return size() - 1;
}

const Plane& AddedPlanes::exact(const PointTable& points, std::uint32_t i) {
  PlaneSource& source = sources_[i];
  if (!source.exact) {
    source.exact = std::make_unique<const Plane>(plane_through(points, source.points));
  }
  return *source.exact;
}

void AddedPlanes::sharpen(const PointTable& points, std::uint32_t i) {
  approximate_[i] = exactcsg::approximate(exact(points, i));
}

PlaneTable::PlaneTable(AddedPlanes& added, const std::vector<std::uint32_t>& members)
    : exact_(members.size()) {
  approximate_.reserve(members.size());
  points_.reserve(members.size());
  for (const std::uint32_t i : members) {
    PlaneSource source = added.take_source(i);
    if (source.exact) exact_.set(points_.size(), std::move(source.exact));
    approximate_.push_back(added.approximate(i));
    points_.push_back(source.points);
  }
}

}  // namespace exactcsg
