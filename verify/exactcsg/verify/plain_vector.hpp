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

}  // namespace exactcsg::verify
