// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/number/geometry.hpp"

#include <algorithm>
#include <cmath>

#include "exactcsg/number/geometry_data.hpp"
#include "exactcsg/number/line_meeting.hpp"
#include "exactcsg/number/meet.hpp"
#include "exactcsg/number/rounding.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg {

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

PointRecord Geometry::point(PointId id) const { return data_->points.record(id); }

void Geometry::ask_for_point(PointId id) const { data_->points.ask_for(id); }

void Geometry::ask_for_points_on(PlaneRef plane) const {
  if (plane.is_wall()) return;
  __builtin_prefetch(&data_->points_of_planes.begin[plane.table_index()]);
  __builtin_prefetch(&approximate_[plane.table_index()]);
}

namespace {

double coordinate(const ApproximatePoint& p, std::size_t axis) {
  return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
}

// A coordinate of an input point, whose doubles are the nearest ones already.
void copy_coordinate(const Geometry::Data& data, PointId id, std::size_t axis,
                     NearPointView& result) {
  const ApproximatePoint& near = data.points.approximate(id);
  RationalView& exact = result.exact[axis];
  exact = data.points.exact(id)[axis];
  result.nearest[axis] =
      std::isfinite(near.error) ? coordinate(near, axis) : round_to_nearest(exact).value;
}

NearPointView input_point(const Geometry::Data& data, PointId id) {
  const ApproximatePoint& near = data.points.approximate(id);
  NearPointView result{data.points.exact(id), {near.x, near.y, near.z}};
  if (!std::isfinite(near.error)) {
    for (std::size_t axis = 0; axis < 3; ++axis) copy_coordinate(data, id, axis, result);
  }
  return result;
}

bool agree(const Geometry::Data& data, const PointPair& line, std::size_t axis) {
  const ApproximatePoint& p = data.points.approximate(line.first);
  const ApproximatePoint& q = data.points.approximate(line.second);
  if (coordinate(p, axis) != coordinate(q, axis)) return false;
  if (p.error == 0 && q.error == 0) return true;
  return equal(data.points.exact(line.first)[axis], data.points.exact(line.second)[axis]);
}

// A point of a plane whose coordinate along the axis is that of all points of the plane, if one is
// known.
std::optional<PointId> point_across(const Geometry::Data& data, std::uint32_t plane,
                                    std::size_t axis) {
  if (exact_axis(data.planes.approximate()[plane]) != static_cast<Axis>(axis)) return std::nullopt;
  const auto points = data.points_of_planes.row(plane);
  if (points.empty()) return std::nullopt;
  return PointId{points.front()};
}

// The meeting point of planes across the three axes, each of which gives its coordinate.
std::optional<NearPointView> corner_of_axes(const Geometry::Data& data, const Vertex& v) {
  NearPointView result;
  std::array<bool, 3> copied{};
  for (const PlaneRef plane : v.planes) {
    if (plane.is_wall()) return std::nullopt;
    const auto axis = exact_axis(data.planes.approximate()[plane.table_index()]);
    const auto points = data.points_of_planes.row(plane.table_index());
    if (!axis || points.empty()) return std::nullopt;
    const auto i = static_cast<std::size_t>(*axis);
    copy_coordinate(data, PointId{points.front()}, i, result);
    copied[i] = true;
  }
  if (!copied[0] || !copied[1] || !copied[2]) return std::nullopt;
  return result;
}

// Where a line through two input points meets a plane.
NearPointView meet_line(const Geometry::Data& data, const PointPair& line, std::uint32_t plane) {
  NearPointView result;
  std::array<bool, 3> copied{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::optional<PointId> source;
    if (agree(data, line, axis)) {
      source = line.first;
    } else {
      source = point_across(data, plane, axis);
    }
    if (!source) continue;
    copy_coordinate(data, *source, axis, result);
    copied[axis] = true;
  }
  if (copied[0] && copied[1] && copied[2]) return result;
  const PointView met = meeting_point_of_line(data.points.exact(line.first),
                                              data.points.exact(line.second), data.form(plane));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (copied[axis]) continue;
    result.exact[axis] = met[axis];
    result.nearest[axis] = round_to_nearest(met[axis]).value;
  }
  return result;
}

}  // namespace

NearPointView Geometry::exact_view(const Vertex& v) const {
  if (v.is_point) return input_point(*data_, v.point);
  if (const auto corner = corner_of_axes(*data_, v)) return *corner;
  for (std::size_t i = 0; i < 3; ++i) {
    const PlaneRef plane = v.planes[i];
    if (plane.is_wall()) continue;
    if (const auto line = common_points(*data_, v.planes[(i + 1) % 3], v.planes[(i + 2) % 3])) {
      return meet_line(*data_, *line, plane.table_index());
    }
  }
  NearPointView result;
  const auto [p, q, r] = data_->operands(v);
  thread_local Point3 met;
  met = point_of(meeting_point(load<Integer>(p), load<Integer>(q), load<Integer>(r)));
  result.exact = view_of(met);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    result.nearest[axis] = round_to_nearest(result.exact[axis]).value;
  }
  return result;
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
