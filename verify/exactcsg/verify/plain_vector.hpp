// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Vectors of doubles, for quantities that are held against a bound with room to spare.
// [Approximate]

#include <array>
#include <cmath>
#include <cstddef>

namespace exactcsg::verify {

using PlainVector = std::array<double, 3>;

inline PlainVector operator-(const PlainVector& a, const PlainVector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline PlainVector operator+(const PlainVector& a, const PlainVector& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline PlainVector operator*(double s, const PlainVector& a) {
  return {s * a[0], s * a[1], s * a[2]};
}
inline double dot(const PlainVector& a, const PlainVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline PlainVector cross(const PlainVector& a, const PlainVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double length(const PlainVector& a) { return std::sqrt(dot(a, a)); }

// The parameter in [0, 1] of the point of segment ab nearest to p, and the distance to it.
struct Nearest {
  double parameter = 0;
  double distance = 0;
};
inline Nearest nearest_on_segment(const PlainVector& a, const PlainVector& b,
                                  const PlainVector& p) {
  const PlainVector d = b - a;
  const double squared = dot(d, d);
  const double s = squared > 0 ? std::fmin(1.0, std::fmax(0.0, dot(p - a, d) / squared)) : 0.0;
  return {s, length(p - (a + s * d))};
}

// The axis along which a plane with this normal is projected with the least loss.
inline std::size_t longest_axis(const PlainVector& normal) {
  std::size_t longest = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    if (std::fabs(normal[k]) > std::fabs(normal[longest])) longest = k;
  }
  return longest;
}

// Whether a ray from p along axis drop + 1, in the projection along axis `drop`, crosses the
// outline an odd number of times; summed up over outlines, whether p is between them.
// `corner(i)`, i < count: the outline's points.
template <class Corner>
bool crosses_oddly(std::size_t drop, const PlainVector& p, std::size_t count, Corner corner) {
  const std::size_t u = (drop + 1) % 3;
  const std::size_t v = (drop + 2) % 3;
  bool odd = false;
  for (std::size_t i = 0; i < count; ++i) {
    const PlainVector& a = corner(i);
    const PlainVector& b = corner((i + 1) % count);
    if ((a[v] > p[v]) == (b[v] > p[v])) continue;
    if (p[u] < a[u] + (b[u] - a[u]) * (p[v] - a[v]) / (b[v] - a[v])) odd = !odd;
  }
  return odd;
}

}  // namespace exactcsg::verify
