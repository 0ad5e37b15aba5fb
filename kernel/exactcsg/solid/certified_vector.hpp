// SPDX-License-Identifier: Apache-2.0
#pragma once

// Vectors of doubles with bounds on how far they are off, and signs as far as they are certain.
// Internal to the evaluator. [Certified]

#include <array>

#include "exactcsg/number/certified_double.hpp"
#include "exactcsg/number/geometry.hpp"

namespace exactcsg {

using CertifiedVector = std::array<CertifiedDouble, 3>;

inline CertifiedVector position_of(const Vertex& v) {
  return {CertifiedDouble{v.x, v.error}, CertifiedDouble{v.y, v.error},
          CertifiedDouble{v.z, v.error}};
}
inline CertifiedVector position_of(const ApproximatePoint& p) {
  return {CertifiedDouble{p.x, p.error}, CertifiedDouble{p.y, p.error},
          CertifiedDouble{p.z, p.error}};
}

inline CertifiedVector difference(const CertifiedVector& p, const CertifiedVector& q) {
  return {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
}

inline CertifiedVector cross(const CertifiedVector& u, const CertifiedVector& v) {
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

inline CertifiedDouble dot(const CertifiedVector& u, const CertifiedVector& v) {
  return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

// Zero: unknown.
inline Sign sign_of_certain(const CertifiedDouble& x) {
  return x.value > x.error ? Sign::Positive : -x.value > x.error ? Sign::Negative : Sign::Zero;
}

}  // namespace exactcsg
