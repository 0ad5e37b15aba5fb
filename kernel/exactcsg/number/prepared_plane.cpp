// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/number/prepared_plane.hpp"

#include <array>
#include <optional>

#include "exactcsg/number/approximate_plane.hpp"
#include "exactcsg/number/coincidence.hpp"
#include "exactcsg/number/homogeneous.hpp"

namespace exactcsg {

namespace {

double coordinate(const ApproximatePoint& p, Axis axis) {
  return axis == Axis::X ? p.x : axis == Axis::Y ? p.y : p.z;
}

bool share_coordinate(const NearPoint& p, const NearPoint& q, Axis axis) {
  if (coordinate(p.near, axis) != coordinate(q.near, axis)) return false;
  if (p.near.error == 0 && q.near.error == 0) return true;
  return coordinate(p.exact, axis) == coordinate(q.exact, axis);
}

double position_error(const NearPoint& p, Axis axis) {
  if (p.near.error == 0) return 0;
  const bool exact = rational_of(coordinate(p.near, axis)) == coordinate(p.exact, axis);
  return exact ? 0 : p.near.error * error_inflation;
}

// Of a plane whose points share the point's coordinate along the axis: recognised before anything
// is rounded, its normal has no error, and coordinates can be compared with it instead of products.
ApproximatePlane axis_parallel_at(const NearPoint& p, Axis axis, const ApproximatePlane& plane) {
  // The other two normal coefficients are zero, so this is the largest one, of certain sign.
  const double normal = axis == Axis::X ? plane.a : axis == Axis::Y ? plane.b : plane.c;
  return axis_parallel(axis, normal > 0 ? 1 : -1, coordinate(p.near, axis),
                       position_error(p, axis));
}

PreparedPlane with_key(const ApproximatePlane& near, std::unique_ptr<const Plane> exact = nullptr) {
  return {near, key_of(near), std::move(exact)};
}

PreparedPlane exactly(Plane plane) {
  auto exact = std::make_unique<const Plane>(std::move(plane));
  const ApproximatePlane near = approximate(*exact);
  return with_key(near, std::move(exact));
}

constexpr std::array<Axis, 3> axes{Axis::X, Axis::Y, Axis::Z};

}  // namespace

std::optional<PreparedPlane> quickly_prepared_plane(const NearPoint& p, const NearPoint& q,
                                                    const NearPoint& r) {
  const std::optional<ApproximatePlane> near = approximate_plane_through(p.near, q.near, r.near);
  if (!near) return std::nullopt;
  for (const Axis axis : axes) {
    if (share_coordinate(p, q, axis) && share_coordinate(p, r, axis)) {
      return with_key(axis_parallel_at(p, axis, *near));
    }
  }
  return with_key(*near);
}

PreparedPlane prepared_plane(const NearPoint& p, const NearPoint& q, const NearPoint& r) {
  if (auto plane = quickly_prepared_plane(p, q, r)) return *std::move(plane);
  return exactly(
      plane_through(homogeneous_of(p.exact), homogeneous_of(q.exact), homogeneous_of(r.exact)));
}

PreparedPlane prepared_plane(const NearPoint& p, const NearPoint& q, Axis axis) {
  const std::optional<ApproximatePlane> near = approximate_plane_along(p.near, q.near, axis);
  if (!near) {
    const Homogeneous<Integer> first = homogeneous_of(p.exact);
    return exactly(plane_through(first, homogeneous_of(q.exact), moved_along_axis(first, axis)));
  }
  for (const Axis other : axes) {
    if (other != axis && share_coordinate(p, q, other)) {
      return with_key(axis_parallel_at(p, other, *near));
    }
  }
  return with_key(*near);
}

PreparedPlane prepared_plane(const Plane& plane) { return exactly(plane); }

}  // namespace exactcsg
