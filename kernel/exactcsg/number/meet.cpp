// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/number/meet.hpp"

#include <algorithm>
#include <cmath>

#include "exactcsg/number/side_bound.hpp"

namespace exactcsg {

namespace {

constexpr double unit = 0x1p-53;

// Meeting points that are known worse than this, relative to their distance from the origin or the
// planes' offsets, are computed exactly.
constexpr double poorest_position = 1e-9;

// A cofactor: two products of at most 1, each rounded by at most a unit of 2^-53, and their
// difference of at most 2, rounded by at most 2: 4 units.
constexpr double cofactor_rounding = 4 * unit;
// A determinant: three products of a coefficient and a cofactor (at most 2), with the cofactors'
// errors (3 * 4), the products' (3 * 2) and two sums (4 + 6 at most): 28 units.
constexpr double determinant_rounding = 32 * unit;

struct DoubleVector {
  double x, y, z;
};

DoubleVector cross(const ApproximatePlane& p, const ApproximatePlane& q) {
  return {p.b * q.c - p.c * q.b, p.c * q.a - p.a * q.c, p.a * q.b - p.b * q.a};
}

double determinant(const ApproximatePlane& p, const DoubleVector& cofactors) {
  return p.a * cofactors.x + p.b * cofactors.y + p.c * cofactors.z;
}

// n x + d of the doubles, and how far it may be off what the true plane and point give: as in
// Geometry::filtered_side.
ApproximateDeterminant value_at(const ApproximatePlane& plane, const ApproximatePoint& point) {
  const double length = std::fabs(point.x) + std::fabs(point.y) + std::fabs(point.z);
  const double value = plane.a * point.x + plane.b * point.y + plane.c * point.z + plane.d;
  return {value, side_bound(plane, length, point.error)};
}

}  // namespace

void snap(const ApproximatePlane& plane, ApproximatePoint& point) {
  const std::optional<Axis> axis = exact_axis(plane);
  if (!axis) return;
  const double normal = plane.a + plane.b + plane.c;  // the other two are zero
  if (std::fabs(normal) != 1) return;
  const double position = -plane.d * normal + 0.0;
  (*axis == Axis::X ? point.x : *axis == Axis::Y ? point.y : point.z) = position;
}

ApproximateDeterminant approximate_determinant(const ApproximatePlane& p, const ApproximatePlane& q,
                                               const ApproximatePlane& r) {
  const double value = determinant(p, cross(q, r));
  // A cofactor changes by at most 2 (e_q + e_r) + 2 e_q e_r with the data, is at most 2 itself, and
  // three of them are summed with weights of at most 1 + e_p.
  const double data = 6.1 * (p.normal_error + q.normal_error + r.normal_error);
  return {value, (data + determinant_rounding) * error_inflation};
}

std::optional<ApproximatePoint> approximate_meeting_point(
    const std::array<ApproximatePlane, 3>& planes) {
  const auto& [p, q, r] = planes;
  const DoubleVector of_p = cross(q, r);
  const DoubleVector of_q = cross(r, p);
  const DoubleVector of_r = cross(p, q);
  const double det = determinant(p, of_p);
  const double smallest_det = std::fabs(det) - determinant_rounding;
  if (!(smallest_det > 0)) return std::nullopt;
  const double factor = -1 / det;
  ApproximatePoint point;
  point.x = (p.d * of_p.x + q.d * of_q.x + r.d * of_r.x) * factor;
  point.y = (p.d * of_p.y + q.d * of_q.y + r.d * of_r.y) * factor;
  point.z = (p.d * of_p.z + q.d * of_q.z + r.d * of_r.z) * factor;
  for (const ApproximatePlane& plane : planes) snap(plane, point);

  // However (x, y, z) was found, its distance from the true point t is bounded by its residuals:
  // with the true normals N + E and offsets d + o, (N + E)(t - x) = -(N x + d) - (E x + o), hence
  // |t - x| <= |(I + N^-1 E)^-1| |N^-1| (|N x + d| + |E x| + |o|) in the maximum norm.
  const double length = std::fabs(point.x) + std::fabs(point.y) + std::fabs(point.z);
  if (!(length < 0x1p1000)) return std::nullopt;
  const auto residual = [&point, length](const ApproximatePlane& s) {
    const double value = s.a * point.x + s.b * point.y + s.c * point.z + s.d;
    // As in Geometry::filtered_side, for a point without error.
    return std::fabs(value) + length * (s.normal_error + 6 * unit) +
           (s.offset_error + std::fabs(s.d) * (6 * unit)) + 0x1p-1022;
  };
  const double residual_p = residual(p);
  const double residual_q = residual(q);
  const double residual_r = residual(r);
  const auto magnitude = [](double cofactor) { return std::fabs(cofactor) + cofactor_rounding; };
  const auto row = [&](double x, double y, double z) {
    return magnitude(x) * residual_p + magnitude(y) * residual_q + magnitude(z) * residual_r;
  };
  const double weighted = std::max(
      {row(of_p.x, of_q.x, of_r.x), row(of_p.y, of_q.y, of_r.y), row(of_p.z, of_q.z, of_r.z)});
  // A row of N^-1 E: three cofactors of at most 2 over the determinant, times 3 e.
  const double normal_error = std::max({p.normal_error, q.normal_error, r.normal_error});
  const double contraction = 18.1 * normal_error / smallest_det;
  if (!(contraction < 0.5)) return std::nullopt;
  point.error = weighted / (smallest_det * (1 - contraction)) * error_inflation;
  const double scale = std::max({length, std::fabs(p.d), std::fabs(q.d), std::fabs(r.d)});
  if (!(point.error <= poorest_position * scale)) return std::nullopt;
  return point;
}

// With the values s, t of opposite signs at the two ends, known to e and f, the crossing divides
// the segment at s / (s - t); the true values S, T give
//   S / (S - T) - s / (s - t) = (s (T - t) - t (S - s)) / ((S - T) (s - t)),
// at most max(e, f) / (|s - t| - e - f) in magnitude. The true ends are off by their errors, and so
// is any point between them.
std::optional<ApproximatePoint> approximate_crossing(const ApproximatePlane& plane,
                                                     const ApproximatePoint& from,
                                                     const ApproximatePoint& to) {
  const ApproximateDeterminant s = value_at(plane, from);
  const ApproximateDeterminant t = value_at(plane, to);
  if (!(s.value < 0 ? t.value > 0 : s.value > 0 && t.value < 0)) return std::nullopt;
  const double difference = s.value - t.value;
  const double least_difference = std::fabs(difference) * (1 - 4 * unit) - (s.error + t.error);
  if (!(least_difference > 0)) return std::nullopt;
  const double share = s.value / difference;
  const double share_error = std::max(s.error, t.error) / least_difference + 4 * unit;
  const double end_error = std::max(from.error, to.error);
  ApproximatePoint point;
  double longest = 0;
  const auto between = [&](double a, double b) {
    longest = std::max(longest, std::fabs(b - a));
    return a + share * (b - a);
  };
  point.x = between(from.x, to.x);
  point.y = between(from.y, to.y);
  point.z = between(from.z, to.z);
  const double length = std::fabs(point.x) + std::fabs(point.y) + std::fabs(point.z);
  point.error = (end_error + (longest + 2 * end_error) * (share_error + 4 * unit) +
                 2 * unit * length + 0x1p-1022) *
                error_inflation;
  if (!(point.error <= poorest_position * std::max(length, std::fabs(plane.d)))) {
    return std::nullopt;
  }
  return point;
}

}  // namespace exactcsg
