// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/number/geometry.hpp"

#include <algorithm>

#include "exactcsg/number/geometry_data.hpp"
#include "exactcsg/number/meet.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg {

namespace {

struct PointPair {
  PointId first;
  PointId second;
};

// Two input points on both planes, if that is known: the ends of an edge that facets share.
std::optional<PointPair> common_points(const Geometry::Data& data, PlaneRef p, PlaneRef q) {
  if (p.is_wall() || q.is_wall()) return std::nullopt;
  auto points = data.points_of_planes.row(p.table_index());
  const auto other_points = data.points_of_planes.row(q.table_index());
  std::uint32_t other = q.table_index();
  if (other_points.size() < points.size()) {
    points = other_points;
    other = p.table_index();
  }
  // Longer rows are not worth the search.
  constexpr std::size_t some = 64;
  std::optional<PointId> first;
  for (const std::uint32_t candidate : points.first(std::min(some, points.size()))) {
    const PointId point{candidate};
    const auto planes = data.planes_through(point);
    if (std::find(planes.begin(), planes.end(), other) == planes.end()) continue;
    if (first) return PointPair{*first, point};
    first = point;
  }
  return std::nullopt;
}

}  // namespace

Geometry::Geometry(std::unique_ptr<Data> data)
    : data_(std::move(data)),
      approximate_(data_->planes.approximate()),
      approximate_points_(data_->points.approximate()) {}
Geometry::~Geometry() = default;
Geometry::Geometry(Geometry&&) noexcept = default;
Geometry& Geometry::operator=(Geometry&&) noexcept = default;

OrientedPlaneRef Geometry::plane(std::uint32_t added) const { return data_->of_added[added]; }

std::span<const OrientedPlaneRef> Geometry::planes() const { return data_->of_added; }

std::uint32_t Geometry::plane_count() const { return data_->planes.size(); }

std::uint32_t Geometry::point_count() const {
  return static_cast<std::uint32_t>(data_->points.size());
}

const Plane& Geometry::exact_plane(PlaneRef plane) const {
  return data_->exact(plane.table_index());
}

Plane Geometry::exact_plane_value(PlaneRef plane) const {
  if (!plane.is_wall()) return exact_plane(plane);
  const Coefficients<Integer> c = load<Integer>(data_->operand(plane));
  return {c.a, c.b, c.c, c.d};
}

const Point3& Geometry::point(PointId id) const { return data_->points.exact(id); }

Point3 Geometry::exact_point(const Vertex& v) const {
  if (v.is_point) return point(v.point);
  for (std::size_t i = 0; i < 3; ++i) {
    const PlaneRef plane = v.planes[i];
    if (plane.is_wall()) continue;
    if (const auto line = common_points(*data_, v.planes[(i + 1) % 3], v.planes[(i + 2) % 3])) {
      const Point3& first = point(line->first);
      if (auto copied = copied_meeting_point(first, point(line->second), exact_plane(plane))) {
        return *std::move(copied);
      }
      return meeting_point_of_line(first, data_->homogeneous(line->first),
                                   data_->homogeneous(line->second), exact_plane(plane));
    }
  }
  const auto [p, q, r] = data_->operands(v);
  return point_of(meeting_point(load<Integer>(p), load<Integer>(q), load<Integer>(r)));
}

namespace {

Vertex meeting_vertex(PlaneRef p, PlaneRef q, PlaneRef r) {
  if (q < p) std::swap(p, q);
  if (r < q) std::swap(q, r);
  if (q < p) std::swap(p, q);
  Vertex v;
  v.planes[0] = p;
  v.planes[1] = q;
  v.planes[2] = r;
  return v;
}

void set_position(Vertex& v, const ApproximatePoint& position) {
  v.x = position.x;
  v.y = position.y;
  v.z = position.z;
  v.error = position.error;
}

ApproximatePoint position_of(const Vertex& v) { return {v.x, v.y, v.z, v.error}; }

double length_of(const ApproximatePoint& point) {
  return std::fabs(point.x) + std::fabs(point.y) + std::fabs(point.z);
}

// Of a position's error, as a share of its distance from the origin: another way of computing it
// would not find it much better.
constexpr double good = 0x1p-44;

}  // namespace

// The position of a meeting point, computed exactly and rounded.
ApproximatePoint Geometry::exactly_met(const Vertex& v) const {
  const auto [s, t, u] = data_->operands(v);
  const Homogeneous<Integer> exact =
      meeting_point(load<Integer>(s), load<Integer>(t), load<Integer>(u));
  if (exact.w == 0) {
    throw Error(ErrorId::InternalError,
                {"three planes that share a direction", "planes that meet in one point"});
  }
  return exactcsg::approximate(point_of(exact));
}

Vertex Geometry::meet(PlaneRef p, PlaneRef q, PlaneRef r) const {
  Vertex v = meeting_vertex(p, q, r);
  const std::optional<ApproximatePoint> position = approximate_meeting_point(
      {approximate(v.planes[0]), approximate(v.planes[1]), approximate(v.planes[2])});
  set_position(v, position ? *position : exactly_met(v));
  return v;
}

Vertex Geometry::meet(PlaneRef p, PlaneRef q, PlaneRef r, const Vertex& from,
                      const Vertex& to) const {
  Vertex v = meeting_vertex(p, q, r);
  const ApproximatePlane crossed = approximate(r);
  // Between the ends is quicker to compute, and mostly as good. Where the ends have a coordinate in
  // common, so has what lies between them: of the three planes only r has to be snapped to.
  std::optional<ApproximatePoint> position =
      approximate_crossing(crossed, position_of(from), position_of(to));
  if (position) snap(crossed, *position);
  if (!position || position->error > good * length_of(*position)) {
    const std::optional<ApproximatePoint> met = approximate_meeting_point(
        {approximate(v.planes[0]), approximate(v.planes[1]), approximate(v.planes[2])});
    if (met && (!position || met->error < position->error)) position = met;
  }
  set_position(v, position ? *position : exactly_met(v));
  return v;
}

}  // namespace exactcsg
