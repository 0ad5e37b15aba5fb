// SPDX-License-Identifier: Apache-2.0
#pragma once

// The points and planes of one evaluation, and every sign that the evaluator asks of them.
//
// A Geometry holds exact points and planes once each: equal points share one id, coincident planes
// (either sense) share one PlaneRef. It is immutable once built and may be read by any number of
// threads; exact plane coefficients are computed lazily, at most a few times, and published
// atomically.
//
// A Vertex is a small value: an input point, or the meeting point of three planes. It always
// carries a certified double position: the true coordinates differ from (x, y, z) by at most
// `error` each.
//
// Every predicate answers exactly, through the four tiers of docs/exactness.md (symbolic, double
// filter, fixed-width integers, unbounded integers), and counts the tier in the statistics it is
// handed (one object a task or thread; never shared).
//
// Exact. Source: DESIGN section 3 (docs/exactness.md); the tiers after google/s2geometry.

#include <array>
#include <bit>
#include <cmath>
#include <compare>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "exactcsg/number/exact_points.hpp"
#include "exactcsg/number/point.hpp"
#include "exactcsg/number/rational_view.hpp"
#include "exactcsg/number/tier_statistics.hpp"

namespace exactcsg {

enum class Axis : unsigned char { X, Y, Z };

inline const Rational& coordinate(const Point3& p, Axis axis) {
  return coordinate(p, static_cast<std::size_t>(axis));
}

enum class PointId : std::uint32_t {};

// A plane without orientation beyond that of its own stored normal: a plane of the table, or a wall
// {axis = position}, whose normal points along the positive axis and which needs no table.
class PlaneRef {
 public:
  constexpr PlaneRef() = default;
  static constexpr PlaneRef of_table(std::uint32_t index) {
    return PlaneRef(static_cast<std::uint64_t>(index) << 2U);
  }
  // REQUIRES position == round_wall_position(position)
  static PlaneRef of_wall(Axis axis, double position) {
    // Adding zero turns -0 into 0: one plane, one reference.
    const auto upper = std::bit_cast<std::uint64_t>(position + 0.0) & ~std::uint64_t{3};
    return PlaneRef(upper | (static_cast<std::uint64_t>(axis) + 1U));
  }

  constexpr bool is_wall() const { return (bits_ & 3U) != 0; }
  constexpr std::uint32_t table_index() const { return static_cast<std::uint32_t>(bits_ >> 2U); }
  // REQUIRES is_wall()
  constexpr Axis wall_axis() const { return static_cast<Axis>((bits_ & 3U) - 1U); }
  constexpr double wall_position() const {
    return std::bit_cast<double>(bits_ & ~std::uint64_t{3});
  }
  constexpr std::uint64_t bits() const { return bits_; }
  friend constexpr auto operator<=>(PlaneRef, PlaneRef) = default;

 private:
  explicit constexpr PlaneRef(std::uint64_t bits) : bits_(bits) {}
  // The low two bits: 0 table index above, 1..3 wall of axis X..Z with the upper 62 bits of the
  // double above.
  std::uint64_t bits_ = ~std::uint64_t{3};
};

// The nearest double below or equal in magnitude whose last two mantissa bits are zero: wall
// positions are such doubles, so that a PlaneRef can hold them.
inline double round_wall_position(double position) {
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(position) & ~std::uint64_t{3});
}

// One side's sense of a stored plane: `sense` +1 if the oriented plane has the stored normal.
struct OrientedPlaneRef {
  PlaneRef plane;
  signed char sense = 1;
  friend constexpr auto operator<=>(const OrientedPlaneRef&, const OrientedPlaneRef&) = default;
};

struct Vertex {
  double x = 0;
  double y = 0;
  double z = 0;
  double error = 0;    // certified: |true - stored| <= error for each coordinate
  PlaneRef planes[3];  // of a meeting point: three planes in ascending order of bits()
  PointId point{};
  bool is_point = false;

  double coordinate(Axis axis) const { return axis == Axis::X ? x : axis == Axis::Y ? y : z; }
};

// The vertex is the meeting point of this plane and two others.
inline bool is_made_by(const Vertex& v, PlaneRef plane) {
  return !v.is_point && (v.planes[0] == plane || v.planes[1] == plane || v.planes[2] == plane);
}

// |true - stored| <= error for each coordinate; error 0 says that the doubles are the coordinates.
// An error of infinity: the coordinates are outside the doubles' range, the stored ones mean
// nothing.
struct ApproximatePoint {
  double x = 0;
  double y = 0;
  double z = 0;
  double error = 0;
};

ApproximatePoint approximate(const Point3& point);

// What a Geometry wants to know of a point before it is added; any thread may find it.
struct HashedPoint {
  std::uint64_t hash = 0;
  ApproximatePoint near;
};
HashedPoint hashed(const Point3& point);

struct PreparedPlane;  // prepared_plane.hpp: the same of a plane

inline Vertex vertex_of(PointId id, const ApproximatePoint& near) {
  Vertex v;
  v.x = near.x;
  v.y = near.y;
  v.z = near.z;
  v.error = near.error;
  v.point = id;
  v.is_point = true;
  return v;
}

// An exact point as it lies in memory, and its nearest doubles.
struct NearPointView {
  PointView exact;
  std::array<double, 3> nearest;
};

class Geometry {
 public:
  class Builder;
  ~Geometry();
  Geometry(Geometry&&) noexcept;
  Geometry& operator=(Geometry&&) noexcept;

  // The canonical reference of the plane that Builder::add_plane returned index `added` for.
  OrientedPlaneRef plane(std::uint32_t added) const;
  std::span<const OrientedPlaneRef> planes() const;  // by the same index
  std::uint32_t plane_count() const;                 // distinct planes
  std::uint32_t point_count() const;  // distinct points; ids are 0 ... point_count() - 1

  // Exact coprime integer coefficients with the stored normal's sense; walls too.
  const Plane& exact_plane(PlaneRef plane) const;  // REQUIRES !plane.is_wall()
  Plane exact_plane_value(PlaneRef plane) const;   // any
  PointRecord point(PointId id) const;
  Point3 exact_point(const Vertex& v) const { return point_of(exact_view(v).exact); }
  // The same, of limbs that last until the thread calls this again. COST: less than of the point
  NearPointView exact_view(const Vertex& v) const;
  // Ask the memory for what point(id) will read, and exact_view of the meeting point of planes like
  // this one: passes in an order that is not that of the ids wait for most of it.
  void ask_for_point(PointId id) const;
  void ask_for_points_on(PlaneRef plane) const;

  Vertex vertex(PointId id) const {
    return vertex_of(id, approximate_points_[static_cast<std::size_t>(id)]);
  }
  const ApproximatePoint& approximate(PointId id) const {
    return approximate_points_[static_cast<std::size_t>(id)];
  }
  // The meeting point of three planes. REQUIRES their normals to be linearly independent.
  // The certified error is small compared with the position (a badly conditioned meeting point is
  // computed exactly and rounded).
  Vertex meet(PlaneRef p, PlaneRef q, PlaneRef r) const;
  // The same where r crosses the segment between two vertices on p and q, which lie on different
  // sides of it: found from those where p and q are nearly parallel.
  Vertex meet(PlaneRef p, PlaneRef q, PlaneRef r, const Vertex& from, const Vertex& to) const;

  // The sign of n.v + d with the stored normal n.
  // LAW predicate.1  equals side(exact_plane_value(plane), exact_point(v)).
  Sign side(const Vertex& v, PlaneRef plane, TierStatistics& statistics) const {
    // A meeting point lies on its own planes. (Of points the incidences are looked up later: they
    // cost more than the filter.)
    if (is_made_by(v, plane)) {
      statistics.record(Tier::Symbolic, true);
      return Sign::Zero;
    }
    const double value = filtered_side(v, plane);
    if (value == 0) return side_beyond_filter(v, plane, statistics);
    statistics.record(Tier::Double, false);
    return value > 0 ? Sign::Positive : Sign::Negative;
  }
  // The sign of (coordinate of v along axis) - value.
  Sign compare_coordinate(const Vertex& v, Axis axis, double value,
                          TierStatistics& statistics) const;
  // The sign of (coordinate of v) - (coordinate of w). LAW predicate.2 a total preorder.
  Sign compare_coordinate(const Vertex& v, const Vertex& w, Axis axis,
                          TierStatistics& statistics) const;
  // LAW predicate.3  same_position(v, w) iff exact_point(v) == exact_point(w)
  bool same_position(const Vertex& v, const Vertex& w, TierStatistics& statistics) const;
  // Lexicographic by x, y, z, exactly.
  std::strong_ordering compare_position(const Vertex& v, const Vertex& w,
                                        TierStatistics& statistics) const;
  // The sign of det(n_p, n_q, n_r) of the stored normals. Zero: the planes share a direction.
  Sign orientation(PlaneRef p, PlaneRef q, PlaneRef r, TierStatistics& statistics) const;

  // Certified double coefficients of the stored plane, scaled so that the largest of |a|, |b|, |c|
  // is in [0.5, 1]; the true (scaled) coefficients differ by at most normal_error / offset_error.
  struct ApproximatePlane {
    double a, b, c, d;
    double normal_error;
    double offset_error;
  };
  ApproximatePlane approximate(PlaneRef plane) const {
    return plane.is_wall() ? approximate_wall(plane) : approximate_[plane.table_index()];
  }

  // A number of the sign of n.v + d, or zero if the doubles cannot tell.
  static double filtered_side(const ApproximatePlane& plane, const ApproximatePoint& v);

  struct Data;  // private to the implementation

 private:
  explicit Geometry(std::unique_ptr<Data> data);

  static ApproximatePlane approximate_wall(PlaneRef wall);
  double filtered_side(const Vertex& v, PlaneRef plane) const;
  Sign side_beyond_filter(const Vertex& v, PlaneRef plane, TierStatistics& statistics) const;
  ApproximatePoint exactly_met(const Vertex& v) const;

  std::unique_ptr<Data> data_;
  const ApproximatePlane* approximate_ = nullptr;         // by table index; owned by data_
  const ApproximatePoint* approximate_points_ = nullptr;  // by id; likewise
  friend class Builder;
};

// Row f says that points[v] lies on the plane first_plane + of_rows[f], for each v of
// corners[begins[f] ... begins[f + 1]). Without of_rows row f is of plane first_plane + f.
struct PointsOnPlanes {
  std::span<const PointId> points;
  std::span<const std::uint32_t> begins;
  std::span<const std::uint32_t> corners;
  std::span<const std::uint32_t> of_rows;
  std::uint32_t first_plane = 0;  // as added
};

class Geometry::Builder {
 public:
  Builder();
  ~Builder();

  // Equal points get equal ids. COST: amortised O(1) hash of the exact value.
  PointId add_point(const Point3& point);
  // The same of points that `owner` keeps alive, as the Geometry will keep the owner: they are not
  // copied.
  void add_owner(std::shared_ptr<const void> owner);
  // The ids are written to `ids`. REQUIRES as many of them and of hashes as points, in their order
  void add_owned_points(const ExactPoints& points, std::span<const HashedPoint> hashed,
                        std::span<PointId> ids);
  Point3 point(PointId id) const;
  // The plane through three points, counter-clockwise from outside. Lazy: nothing exact is computed
  // unless the certified double is too poor or another plane may coincide.
  // THROWS Error(DegenerateFacet) if they are collinear. Returns 0, 1, 2, ... in order of calls.
  std::uint32_t add_plane(PointId p, PointId q, PointId r);
  // The same of what prepared_plane made of three points, or of two and an axis; no incidences are
  // added.
  std::uint32_t add_plane(PreparedPlane plane, PointId p, PointId q, PointId r);
  std::uint32_t add_plane(PreparedPlane plane, PointId p, PointId q, Axis axis);
  // REQUIRES coprime coefficients (LAW plane.1)
  std::uint32_t add_plane(const Plane& plane);
  // Room for so many planes at once, each of which is to be set, by any thread, before anything
  // else is done. Returns the index of the first one.
  std::uint32_t add_planes(std::size_t count, unsigned threads = 1);
  void set_plane(std::uint32_t added, PreparedPlane plane, PointId p, PointId q, PointId r);
  void set_plane(std::uint32_t added, PreparedPlane plane, PointId p, PointId q, Axis axis);
  // States that the point lies on the added plane (not checked in release builds): tier 0.
  void add_incidence(PointId point, std::uint32_t added_plane);
  // The same of many. REQUIRES that what is referred to lasts until build()
  void add_incidences(const PointsOnPlanes& rows);

  // Room for so many more of each.
  void reserve(std::size_t points, std::size_t planes);

  // Finds coincident planes once and for all. COST: O(n log n) doubles, exact comparisons only
  // between planes whose certified doubles cannot tell them apart.
  // threads: 0 for as many as there are cores; the result does not depend on them.
  Geometry build(unsigned threads = 1) &&;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

inline Geometry::ApproximatePlane Geometry::approximate_wall(PlaneRef wall) {
  const Axis axis = wall.wall_axis();
  return {axis == Axis::X ? 1.0 : 0.0,
          axis == Axis::Y ? 1.0 : 0.0,
          axis == Axis::Z ? 1.0 : 0.0,
          -wall.wall_position(),
          0,
          0};
}

// A number of the sign of n.v + d, or zero if the double filter cannot tell.
//
// A wall: the rounded difference x - w has the sign of the exact one, and its size by a factor of
// 1 +- u (u = 2^-53), so that it decides if it exceeds error * (1 + 2u).
//
// A plane, |a|, |b|, |c| <= 1, L = |x| + |y| + |z|: the computed a x + b y + c z + d is off by
//   normal_error * L + 3 error * (1 + normal_error) + offset_error  (errors of the data)
//   + 4.01 u (L + |d|)                                              (four roundings of each term)
// and an underflow, which the smallest normal number outweighs. With 6 u and 4 error in place of
// 4.01 u and 3.01 error the roundings of the bound itself are paid for, since the plane's errors
// are inflated by 2^-45 when they are stored and normal_error <= 2^-30. A contraction into fused
// multiply-adds only leaves roundings out. If a sum overflows, so does L or the bound is right for
// the infinite value; comparing with NaN decides nothing.
inline double Geometry::filtered_side(const Vertex& v, PlaneRef plane) const {
  if (plane.is_wall()) {
    const double difference = v.coordinate(plane.wall_axis()) - plane.wall_position();
    return std::fabs(difference) > v.error * (1 + 0x1p-50) ? difference : 0;
  }
  return filtered_side(approximate_[plane.table_index()], {v.x, v.y, v.z, v.error});
}

inline double Geometry::filtered_side(const ApproximatePlane& p, const ApproximatePoint& v) {
  constexpr double rounding = 6 * 0x1p-53;
  const double value = p.a * v.x + p.b * v.y + p.c * v.z + p.d;
  const double length = std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z);
  const double bound = length * (p.normal_error + rounding) +
                       (p.offset_error + std::fabs(p.d) * rounding) + 4 * v.error + 0x1p-1022;
  return std::fabs(value) > bound ? value : 0;
}

}  // namespace exactcsg
