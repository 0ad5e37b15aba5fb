// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/number/orientation.hpp"

#include <array>
#include <cmath>

namespace exactcsg {

namespace {

Sign exact_orientation(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
  return sign_of(dot(cross(b - a, c - a), d - a));
}

}  // namespace

Sign orientation(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
  // mpq_get_d truncates: each coordinate is off by less than one unit in the last place,
  // 2u |x| with u = 2^-53. Differences of coordinates of magnitude at most m are off by
  // e = 2 * 2u m + u * 2m = 6u m; call D >= |difference|, computed. The determinant is a sum of six
  // products of three differences: each product is off by at most 3 (D+e)^2 e + 3u (D+e)^3, and the
  // sum's own rounding adds at most 5u * 6 (D+e)^3. We use twice that.
  const auto doubles = [](const Point3& p) {
    return std::array{p.x.get_d(), p.y.get_d(), p.z.get_d()};
  };
  const auto pa = doubles(a);
  const auto pb = doubles(b);
  const auto pc = doubles(c);
  const auto pd = doubles(d);
  double magnitude = 0;
  double widest = 0;
  std::array<double, 3> u{};
  std::array<double, 3> v{};
  std::array<double, 3> w{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (const double x : {pa[i], pb[i], pc[i], pd[i]})
      magnitude = std::max(magnitude, std::abs(x));
    u[i] = pb[i] - pa[i];
    v[i] = pc[i] - pa[i];
    w[i] = pd[i] - pa[i];
    for (const double x : {u[i], v[i], w[i]}) widest = std::max(widest, std::abs(x));
  }
  constexpr double unit = 0x1p-53;
  const double difference_error = 6 * unit * magnitude;
  const double reach = widest + difference_error;
  const double bound =
      2 * (18 * reach * reach * difference_error + 48 * unit * reach * reach * reach);
  const double determinant = (u[1] * v[2] - u[2] * v[1]) * w[0] +
                             (u[2] * v[0] - u[0] * v[2]) * w[1] +
                             (u[0] * v[1] - u[1] * v[0]) * w[2];
  // Outside this range an intermediate result may have under- or overflowed.
  const bool trustworthy = bound > 1e-250 && bound < 1e250;
  if (trustworthy && determinant > bound) return Sign::Positive;
  if (trustworthy && determinant < -bound) return Sign::Negative;
  return exact_orientation(a, b, c, d);
}

}  // namespace exactcsg
