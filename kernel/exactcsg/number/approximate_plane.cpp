// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/number/approximate_plane.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace exactcsg {

namespace {

constexpr double unit = 0x1p-53;  // the relative error of one rounding
constexpr double infinity = std::numeric_limits<double>::infinity();

struct Rounded {
  double value = 0;
  double error = 0;
};

// value * 2^-scale, the value truncated to 53 bits.
Rounded rounded(const Integer& value, long scale) {
  if (value == 0) return {};
  long exponent = 0;
  const double mantissa = mpz_get_d_2exp(&exponent, value.get_mpz_t());
  exponent -= scale;
  if (exponent > 1000) return {0, infinity};
  // Too small for a normal double: 0 is as good, to far less than any other error here.
  if (exponent < -1000) return {0, 0x1p-1000};
  const double result = std::ldexp(mantissa, static_cast<int>(exponent));
  const std::size_t significant =
      mpz_sizeinbase(value.get_mpz_t(), 2) - mpz_scan1(value.get_mpz_t(), 0);
  // Truncation loses less than a unit in the last place, 2^-52 of the value.
  return {result, significant <= 53 ? 0 : std::fabs(result) * 0x1p-52 * error_inflation};
}

double largest(double x, double y, double z) {
  return std::max({std::fabs(x), std::fabs(y), std::fabs(z)});
}

// The plane through p of this normal, whose components are off by at most `error`.
std::optional<ApproximatePlane> plane_of_normal(const std::array<double, 3>& normal, double error,
                                                const ApproximatePoint& p) {
  const auto& [a, b, c] = normal;
  const double n = largest(a, b, c);
  if (!(n > 0x1p-900 && n < 0x1p400)) return std::nullopt;
  const double normal_error = error * error_inflation;
  if (!(normal_error <= poorest_normal * n)) return std::nullopt;
  // d = -n.p: the errors of p and n, and three roundings of each term.
  const double length = std::fabs(p.x) + std::fabs(p.y) + std::fabs(p.z);
  const double d = -(a * p.x + b * p.y + c * p.z);
  const double offset_error =
      3 * n * p.error + normal_error * (length + 3 * p.error) + 4 * unit * n * length;
  if (!(length < 0x1p400)) return std::nullopt;
  // Brings n into [0.5, 1); scaling by a power of two rounds only what underflows.
  const double scale =
      std::bit_cast<double>((std::uint64_t{2045} << 52U) -
                            (std::bit_cast<std::uint64_t>(n) & (std::uint64_t{0x7ff} << 52U)));
  return ApproximatePlane{a * scale,
                          b * scale,
                          c * scale,
                          d * scale,
                          normal_error * scale,
                          (offset_error * scale + 0x1p-1000) * error_inflation};
}

}  // namespace

ApproximatePlane axis_parallel(Axis axis, int sense, double position, double error) {
  ApproximatePlane plane{0, 0, 0, -sense * position + 0.0, 0, error};
  (axis == Axis::X ? plane.a : axis == Axis::Y ? plane.b : plane.c) = sense;
  return plane;
}

ApproximatePlane approximate(const Plane& plane) {
  const auto parallel = [&plane](Axis axis, const Integer& coefficient) {
    Rational position(-plane.d, coefficient);
    position.canonicalize();
    const ApproximatePoint on_axis = approximate(Point3{position, 0, 0});
    return axis_parallel(axis, sgn(coefficient), on_axis.x, on_axis.error * error_inflation);
  };
  if (plane.b == 0 && plane.c == 0) return parallel(Axis::X, plane.a);
  if (plane.c == 0 && plane.a == 0) return parallel(Axis::Y, plane.b);
  if (plane.a == 0 && plane.b == 0) return parallel(Axis::Z, plane.c);
  const auto scale = static_cast<long>(
      std::max({mpz_sizeinbase(plane.a.get_mpz_t(), 2), mpz_sizeinbase(plane.b.get_mpz_t(), 2),
                mpz_sizeinbase(plane.c.get_mpz_t(), 2)}));
  const Rounded a = rounded(plane.a, scale);
  const Rounded b = rounded(plane.b, scale);
  const Rounded c = rounded(plane.c, scale);
  const Rounded d = rounded(plane.d, scale);
  return {a.value, b.value, c.value, d.value, std::max({a.error, b.error, c.error}), d.error};
}

std::optional<ApproximatePlane> approximate_plane_through(const ApproximatePoint& p,
                                                          const ApproximatePoint& q,
                                                          const ApproximatePoint& r) {
  const double ux = q.x - p.x;
  const double uy = q.y - p.y;
  const double uz = q.z - p.z;
  const double vx = r.x - p.x;
  const double vy = r.y - p.y;
  const double vz = r.z - p.z;
  // |u - true u| <= du: the points' errors and one rounding (a difference never underflows).
  const double u = largest(ux, uy, uz);
  const double v = largest(vx, vy, vz);
  const double du = p.error + q.error + unit * u;
  const double dv = p.error + r.error + unit * v;
  const double a = uy * vz - uz * vy;
  const double b = uz * vx - ux * vz;
  const double c = ux * vy - uy * vx;
  // u_i v_j differs from the true product by u dv + v du + du dv; two such products make a
  // component, each rounded once (at most u v * unit), and their difference (at most 2 u v) too:
  // 4 u v * unit, of which the fifth covers second-order terms. Underflow cannot matter: n >
  // 2^-900.
  return plane_of_normal({a, b, c}, 2 * (u * dv + v * du + du * dv) + 5 * unit * u * v, p);
}

std::optional<ApproximatePlane> approximate_plane_along(const ApproximatePoint& p,
                                                        const ApproximatePoint& q, Axis axis) {
  const double ux = q.x - p.x;
  const double uy = q.y - p.y;
  const double uz = q.z - p.z;
  // The points' errors and one rounding of the difference.
  const double error = p.error + q.error + unit * largest(ux, uy, uz);
  switch (axis) {
    case Axis::X:
      return plane_of_normal({0, uz, -uy}, error, p);
    case Axis::Y:
      return plane_of_normal({-uz, 0, ux}, error, p);
    default:
      return plane_of_normal({uy, -ux, 0}, error, p);
  }
}

ApproximatePlane opposite(const ApproximatePlane& p) {
  return {-p.a, -p.b, -p.c, -p.d, p.normal_error, p.offset_error};
}

bool certainly_different(const ApproximatePlane& p, const ApproximatePlane& q) {
  // Proportional coefficients have equal cross products with those of the axis on which p is
  // largest. Each product's data error is at most the sum of the normal errors (|coefficients| <=
  // 1) or, of the offset, as written below; two products and a difference round by 4 units at most.
  const double px[3] = {p.a, p.b, p.c};
  const double qx[3] = {q.a, q.b, q.c};
  const std::size_t i = std::fabs(p.a) >= std::fabs(p.b)
                            ? (std::fabs(p.a) >= std::fabs(p.c) ? 0U : 2U)
                            : (std::fabs(p.b) >= std::fabs(p.c) ? 1U : 2U);
  const double normal_bound =
      2.1 * (p.normal_error + q.normal_error) + 5 * unit + std::numeric_limits<double>::min();
  for (const std::size_t j : {(i + 1) % 3, (i + 2) % 3}) {
    if (std::fabs(px[j] * qx[i] - qx[j] * px[i]) > normal_bound) return true;
  }
  const double offset_bound =
      (std::fabs(p.d) * (q.normal_error + 5 * unit) + std::fabs(q.d) * (p.normal_error + 5 * unit) +
       1.1 * (p.offset_error + q.offset_error)) *
          error_inflation +
      std::numeric_limits<double>::min();
  return std::fabs(p.d * qx[i] - q.d * px[i]) > offset_bound;
}

}  // namespace exactcsg
