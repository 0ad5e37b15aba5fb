// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "exactcsg/number/geometry_data.hpp"
#include "exactcsg/number/meet.hpp"

namespace exactcsg {

namespace {

using Data = Geometry::Data;

constexpr Axis axes[] = {Axis::X, Axis::Y, Axis::Z};

Sign sign_of_difference(double x, double y) {
  return x > y ? Sign::Positive : x < y ? Sign::Negative : Sign::Zero;
}

bool equal(const Decision& decision) { return decision.sign == Sign::Zero; }

Sign recorded(const Decision& decision, TierStatistics& statistics) {
  statistics.record(decision.tier, equal(decision));
  return decision.sign;
}

// --- What is known without arithmetic ------------------------------------------------------------

// A wall, or a plane of the table that is exactly perpendicular to an axis.
std::optional<Axis> perpendicular_axis(const Data& data, PlaneRef plane) {
  if (plane.is_wall()) return plane.wall_axis();
  return exact_axis(data.planes.approximate()[plane.table_index()]);
}

// The position of such a plane, if it is a double.
std::optional<double> exact_position(const Data& data, PlaneRef plane) {
  if (plane.is_wall()) return plane.wall_position();
  const ApproximatePlane& p = data.planes.approximate()[plane.table_index()];
  if (!exact_axis(p) || p.offset_error != 0) return std::nullopt;
  return -p.d * (p.a + p.b + p.c) + 0.0;  // the normal is +-1 along its axis
}

bool is_incident(const Data& data, const Vertex& v, PlaneRef plane) {
  if (!v.is_point) return std::ranges::find(v.planes, plane) != std::end(v.planes);
  if (plane.is_wall()) return false;
  const auto known = data.planes_through(v.point);
  return std::ranges::find(known, plane.table_index()) != known.end();
}

bool is_same_vertex(const Vertex& v, const Vertex& w) {
  if (v.is_point != w.is_point) return false;
  return v.is_point ? v.point == w.point : std::ranges::equal(v.planes, w.planes);
}

// The input point at which the three planes are known to meet, if there is one: it is then known on
// which other planes it lies, and its integers are shorter.
std::optional<PointId> known_point(const Data& data, const Vertex& v) {
  constexpr std::size_t longest_search = 64;
  if (v.is_point) return v.point;
  PlaneRef rarest = v.planes[0];
  std::size_t fewest = longest_search + 1;
  for (const PlaneRef plane : v.planes) {
    if (plane.is_wall()) return std::nullopt;
    const std::size_t count = data.points_of_planes.row(plane.table_index()).size();
    if (count < fewest) {
      fewest = count;
      rarest = plane;
    }
  }
  if (fewest > longest_search) return std::nullopt;
  for (const std::uint32_t candidate : data.points_of_planes.row(rarest.table_index())) {
    const auto known = data.planes_of_points.row(candidate);
    const auto contains = [&known](PlaneRef plane) {
      return std::ranges::find(known, plane.table_index()) != known.end();
    };
    if (std::ranges::all_of(v.planes, contains)) return PointId{candidate};
  }
  return std::nullopt;
}

// The vertex, as an input point if it is known to be one.
Vertex resolved(const Data& data, const Vertex& v) {
  if (v.is_point) return v;
  const std::optional<PointId> known = known_point(data, v);
  if (!known) return v;
  Vertex point;
  const ApproximatePoint& position = data.points.approximate(*known);
  point.x = position.x;
  point.y = position.y;
  point.z = position.z;
  point.error = position.error;
  point.point = *known;
  point.is_point = true;
  return point;
}

// A plane perpendicular to the axis that is one of the meeting point's own.
std::optional<PlaneRef> own_perpendicular(const Data& data, const Vertex& v, Axis axis) {
  if (v.is_point) return std::nullopt;
  for (const PlaneRef plane : v.planes) {
    if (perpendicular_axis(data, plane) == axis) return plane;
  }
  return std::nullopt;
}

bool share_perpendicular(const Data& data, const Vertex& v, const Vertex& w, Axis axis) {
  if (const auto plane = own_perpendicular(data, v, axis)) return is_incident(data, w, *plane);
  if (const auto plane = own_perpendicular(data, w, axis)) return is_incident(data, v, *plane);
  return false;
}

// The vertex's coordinate, if it is known to be this double.
std::optional<double> exact_coordinate(const Data& data, const Vertex& v, Axis axis) {
  if (v.error == 0) return v.coordinate(axis);
  if (const auto plane = own_perpendicular(data, v, axis)) return exact_position(data, *plane);
  return std::nullopt;
}

// --- Integers
// --------------------------------------------------------------------------------------

// A point, or three planes, as the operand of formulas that do not care which.
class VertexOperand {
 public:
  VertexOperand(const Data& data, const Vertex& v) {
    if (v.is_point) {
      point_ = &data.homogeneous(v.point);
      bits_ = bits_of(*point_);
    } else {
      planes_ = data.operands(v);
      bits_ = bits_of_meeting_point(planes_);
    }
  }
  const HomogeneousBits& bits() const { return bits_; }

  template <class T>
  Homogeneous<T> load() const {
    if (point_ != nullptr) return exactcsg::load<T>(*point_);
    const auto& [p, q, r] = planes_;
    return meeting_point(exactcsg::load<T>(p), exactcsg::load<T>(q), exactcsg::load<T>(r));
  }
  template <class T>
  HomogeneousCoordinate<T> load(Axis axis) const {
    if (point_ != nullptr) {
      return {integer_from<T>(coordinate(*point_, axis)), integer_from<T>(point_->w)};
    }
    const auto& [p, q, r] = planes_;
    return meeting_coordinate(exactcsg::load<T>(p), exactcsg::load<T>(q), exactcsg::load<T>(r),
                              axis);
  }

 private:
  const Homogeneous<Integer>* point_ = nullptr;
  std::array<PlaneOperand, 3> planes_{};
  HomogeneousBits bits_;
};

Decision exact_side(const VertexOperand& vertex, const PlaneOperand& plane) {
  return decide(bits_of_value(plane, vertex.bits()), [&]<class T>() {
    const Homogeneous<T> p = vertex.load<T>();
    return sign_of(T(value_at(load<T>(plane), p))) * sign_of(p.w);
  });
}

Decision exact_compare(const VertexOperand& v, const VertexOperand& w, Axis axis) {
  // v / v.w - w / w.w has the sign of (v w.w - w v.w) v.w w.w.
  const int bits = std::max(v.bits().coordinate + w.bits().denominator,
                            w.bits().coordinate + v.bits().denominator) +
                   1;
  return decide(bits, [&]<class T>() {
    const HomogeneousCoordinate<T> p = v.load<T>(axis);
    const HomogeneousCoordinate<T> q = w.load<T>(axis);
    return sign_of(T(p.value * q.w - q.value * p.w)) * sign_of(p.w) * sign_of(q.w);
  });
}

// --- Planes that facets with a common edge lie in
// --------------------------------------------------

// Which side of the line through two points of a plane another point of that plane is on, along an
// arbitrary direction; Zero: the doubles cannot tell.
Sign side_of_line(const ApproximatePoint& from, const ApproximatePoint& to,
                  const ApproximatePlane& plane, const ApproximatePoint& point) {
  const double ux = to.x - from.x, uy = to.y - from.y, uz = to.z - from.z;
  const double wx = point.x - from.x, wy = point.y - from.y, wz = point.z - from.z;
  const double u = std::max({std::fabs(ux), std::fabs(uy), std::fabs(uz)});
  const double w = std::max({std::fabs(wx), std::fabs(wy), std::fabs(wz)});
  const double value =
      plane.a * (uy * wz - uz * wy) + plane.b * (uz * wx - ux * wz) + plane.c * (ux * wy - uy * wx);
  // With r = 2^-52, entries of u are off by at most e, those of w by at most f. The normal counts
  // as it is, at most 1 along each axis: any direction out of the plane would do, and one in it
  // would make the determinant nothing. So six products are off by at most u f + w e + e f each;
  // their roundings by less than 15 r u w in all.
  const double e = from.error + to.error + 0x1p-52 * u;
  const double f = from.error + point.error + 0x1p-52 * w;
  const double bound =
      8 * (u * f + w * e + e * f) + 0x1p-46 * u * w + std::numeric_limits<double>::min();
  return value > bound ? Sign::Positive : value < -bound ? Sign::Negative : Sign::Zero;
}

// A meeting point on a plane that has a known edge in common with the one asked for: in its plane
// it lies on the same side of the edge as some input point, or on the other side. So the planes
// need not be met exactly where they are nearly one.
std::optional<Decision> side_across_edge(const Data& data, const Vertex& v, PlaneRef plane) {
  const ApproximatePoint position{v.x, v.y, v.z, v.error};
  for (const PlaneRef own : v.planes) {
    const std::optional<PointPair> edge = common_points(data, own, plane);
    if (!edge) continue;
    const ApproximatePlane& near = data.planes.approximate()[own.table_index()];
    const ApproximatePoint& from = data.points.approximate(edge->first);
    const ApproximatePoint& to = data.points.approximate(edge->second);
    const Sign side = side_of_line(from, to, near, position);
    if (side == Sign::Zero) continue;
    constexpr std::size_t some = 16;
    const auto candidates = data.points_of_planes.row(own.table_index());
    for (const std::uint32_t candidate : candidates.first(std::min(some, candidates.size()))) {
      const PointId point{candidate};
      const Sign other = side_of_line(from, to, near, data.points.approximate(point));
      if (other == Sign::Zero) continue;
      const Decision decision =
          exact_side(VertexOperand(data, vertex_of(point, data.points.approximate(point))),
                     data.operand(plane));
      return Decision{decision.sign * other * side, decision.tier};
    }
  }
  return std::nullopt;
}

// --- The tiers in turn
// -----------------------------------------------------------------------------

Decision side_without_filter(const Data& data, const Vertex& meeting, PlaneRef plane) {
  if (is_incident(data, meeting, plane)) return {Sign::Zero, Tier::Symbolic};
  const Vertex v = resolved(data, meeting);
  if (v.is_point && is_incident(data, v, plane)) return {Sign::Zero, Tier::Symbolic};
  if (const auto axis = perpendicular_axis(data, plane)) {
    const auto position = exact_position(data, plane);
    const auto coordinate = exact_coordinate(data, v, *axis);
    if (position && coordinate) {
      const Sign above = sign_of_difference(*coordinate, *position);
      if (plane.is_wall()) return {above, Tier::Double};
      const ApproximatePlane& p = data.planes.approximate()[plane.table_index()];
      return {p.a + p.b + p.c > 0 ? above : -above, Tier::Double};
    }
  }
  if (!v.is_point) {
    if (const auto decision = side_across_edge(data, v, plane)) return *decision;
  }
  return exact_side(VertexOperand(data, v), data.operand(plane));
}

// Zero: the doubles cannot tell. The rounding of the difference as in Geometry::filtered_side, that
// of the sum of the errors besides.
Sign filtered_compare(const Vertex& v, const Vertex& w, Axis axis) {
  const double difference = v.coordinate(axis) - w.coordinate(axis);
  const double bound = (v.error + w.error) * (1 + 0x1p-50);
  return difference > bound ? Sign::Positive : difference < -bound ? Sign::Negative : Sign::Zero;
}

// Input points have their coordinates at hand: equal ones, which are frequent, are equal limb by
// limb.
Decision compare_points(const Data& data, const Vertex& v, const Vertex& w, Axis axis) {
  if (v.error == 0 && w.error == 0) {
    return {sign_of_difference(v.coordinate(axis), w.coordinate(axis)), Tier::Double};
  }
  const RationalView x = data.points.exact(v.point)[static_cast<std::size_t>(axis)];
  const RationalView y = data.points.exact(w.point)[static_cast<std::size_t>(axis)];
  if (equal(x, y)) return {Sign::Zero, Tier::Symbolic};
  return {compare(x, y) < 0 ? Sign::Negative : Sign::Positive, Tier::Unbounded};
}

Decision compare(const Data& data, const Vertex& first, const Vertex& second, Axis axis) {
  if (const Sign sign = filtered_compare(first, second, axis); sign != Sign::Zero) {
    return {sign, Tier::Double};
  }
  if (first.is_point && second.is_point) return compare_points(data, first, second, axis);
  if (share_perpendicular(data, first, second, axis)) return {Sign::Zero, Tier::Symbolic};
  const Vertex v = resolved(data, first);
  const Vertex w = resolved(data, second);
  if (is_same_vertex(v, w) || share_perpendicular(data, v, w, axis)) {
    return {Sign::Zero, Tier::Symbolic};
  }
  const auto x = exact_coordinate(data, v, axis);
  const auto y = x ? exact_coordinate(data, w, axis) : std::nullopt;
  if (y) return {sign_of_difference(*x, *y), Tier::Double};
  return exact_compare(VertexOperand(data, v), VertexOperand(data, w), axis);
}

// Of w's three planes: does v lie on each? Sign::Positive stands for "no".
Decision lies_on_own_planes(const Data& data, const Vertex& v, const Vertex& w) {
  Decision result{Sign::Zero, Tier::Symbolic};
  for (const PlaneRef plane : w.planes) {
    const Decision decision = side_without_filter(data, v, plane);
    result.tier = std::max(result.tier, decision.tier);
    if (!equal(decision)) return {Sign::Positive, result.tier};
  }
  return result;
}

// Sign::Positive stands for "different".
Decision same_position(const Data& data, const Vertex& first, const Vertex& second) {
  if (is_same_vertex(first, second)) return {Sign::Zero, Tier::Symbolic};
  if (first.is_point && second.is_point) return {Sign::Positive, Tier::Symbolic};
  for (const Axis axis : axes) {
    if (filtered_compare(first, second, axis) != Sign::Zero) return {Sign::Positive, Tier::Double};
  }
  const Vertex v = resolved(data, first);
  const Vertex w = resolved(data, second);
  if (is_same_vertex(v, w)) return {Sign::Zero, Tier::Symbolic};
  if (v.is_point && w.is_point) return {Sign::Positive, Tier::Symbolic};
  if (v.error == 0 && w.error == 0) return {Sign::Zero, Tier::Double};
  return w.is_point ? lies_on_own_planes(data, w, v) : lies_on_own_planes(data, v, w);
}

std::strong_ordering ordering(Sign sign) { return static_cast<int>(sign) <=> 0; }

}  // namespace

Sign Geometry::side_beyond_filter(const Vertex& v, PlaneRef plane,
                                  TierStatistics& statistics) const {
  return recorded(side_without_filter(*data_, v, plane), statistics);
}

Sign Geometry::compare_coordinate(const Vertex& v, Axis axis, double value,
                                  TierStatistics& statistics) const {
  const double difference = v.coordinate(axis) - value;
  if (std::fabs(difference) > v.error * (1 + 0x1p-50)) {
    statistics.record(Tier::Double, false);
    return sign_of_difference(difference, 0);
  }
  if (const auto plane = own_perpendicular(*data_, v, axis)) {
    if (const auto position = exact_position(*data_, *plane)) {
      return recorded({sign_of_difference(*position, value), Tier::Symbolic}, statistics);
    }
  }
  if (v.error == 0) {
    return recorded({sign_of_difference(v.coordinate(axis), value), Tier::Double}, statistics);
  }
  return recorded(exact_side(VertexOperand(*data_, v), operand_of_wall(axis, value)), statistics);
}

Sign Geometry::compare_coordinate(const Vertex& v, const Vertex& w, Axis axis,
                                  TierStatistics& statistics) const {
  return recorded(compare(*data_, v, w, axis), statistics);
}

bool Geometry::same_position(const Vertex& v, const Vertex& w, TierStatistics& statistics) const {
  return recorded(exactcsg::same_position(*data_, v, w), statistics) == Sign::Zero;
}

std::strong_ordering Geometry::compare_position(const Vertex& v, const Vertex& w,
                                                TierStatistics& statistics) const {
  if (const Sign sign = filtered_compare(v, w, Axis::X); sign != Sign::Zero) {
    return ordering(recorded({sign, Tier::Double}, statistics));
  }
  Decision result = exactcsg::same_position(*data_, v, w);
  if (!equal(result)) {
    for (const Axis axis : axes) {
      const Decision along = compare(*data_, v, w, axis);
      result = {along.sign, std::max(result.tier, along.tier)};
      if (!equal(along)) break;
    }
  }
  return ordering(recorded(result, statistics));
}

Sign Geometry::orientation(PlaneRef p, PlaneRef q, PlaneRef r, TierStatistics& statistics) const {
  const auto parallel = [this](PlaneRef s, PlaneRef t) {
    const auto axis = perpendicular_axis(*data_, s);
    return s == t || (axis && axis == perpendicular_axis(*data_, t));
  };
  const ApproximateDeterminant det =
      approximate_determinant(approximate(p), approximate(q), approximate(r));
  if (std::fabs(det.value) > det.error) {
    return recorded({sign_of_difference(det.value, 0), Tier::Double}, statistics);
  }
  if (parallel(p, q) || parallel(q, r) || parallel(r, p)) {
    return recorded({Sign::Zero, Tier::Symbolic}, statistics);
  }
  const std::array<PlaneOperand, 3> planes{data_->operand(p), data_->operand(q), data_->operand(r)};
  // The offsets take no part in the determinant but are loaded with the normals, and must fit too.
  const int bits = std::max({bits_of_meeting_point(planes).denominator, planes[0].offset_bits,
                             planes[1].offset_bits, planes[2].offset_bits});
  return recorded(decide(bits,
                         [&planes]<class T>() {
                           const Coefficients<T> second = load<T>(planes[1]);
                           const Coefficients<T> third = load<T>(planes[2]);
                           return sign_of(T(determinant(load<T>(planes[0]), cross(second, third))));
                         }),
                  statistics);
}

}  // namespace exactcsg
