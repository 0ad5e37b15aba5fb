// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Predicates in plain rational arithmetic, written for the tests alone: no filter, no integers,
// none of the kernel's formulas beyond +, -, *, / of mpq_class.

#include <array>
#include <stdexcept>

#include "exactcsg/number/point.hpp"

namespace exactcsg::reference {

struct RationalPlane {
  std::array<Rational, 3> normal;
  Rational offset;
};

inline RationalPlane plane_through(const Point3& p, const Point3& q, const Point3& r) {
  const std::array<Rational, 3> u{q.x - p.x, q.y - p.y, q.z - p.z};
  const std::array<Rational, 3> v{r.x - p.x, r.y - p.y, r.z - p.z};
  RationalPlane plane;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const std::size_t k = (i + 2) % 3;
    plane.normal[i] = u[j] * v[k] - u[k] * v[j];
  }
  plane.offset = -(plane.normal[0] * p.x + plane.normal[1] * p.y + plane.normal[2] * p.z);
  return plane;
}

inline RationalPlane rational(const Plane& plane) {
  return {{Rational(plane.a), Rational(plane.b), Rational(plane.c)}, Rational(plane.d)};
}

inline bool is_degenerate(const RationalPlane& plane) {
  return plane.normal[0] == 0 && plane.normal[1] == 0 && plane.normal[2] == 0;
}

inline Rational value_at(const RationalPlane& plane, const Point3& p) {
  return plane.normal[0] * p.x + plane.normal[1] * p.y + plane.normal[2] * p.z + plane.offset;
}

inline Rational determinant(const RationalPlane& p, const RationalPlane& q,
                            const RationalPlane& r) {
  const auto& a = p.normal;
  const auto& b = q.normal;
  const auto& c = r.normal;
  return a[0] * b[1] * c[2] + a[1] * b[2] * c[0] + a[2] * b[0] * c[1] - a[2] * b[1] * c[0] -
         a[0] * b[2] * c[1] - a[1] * b[0] * c[2];
}

// Gaussian elimination with rational pivots. REQUIRES independent normals
inline Point3 meeting_point(const RationalPlane& p, const RationalPlane& q,
                            const RationalPlane& r) {
  std::array<std::array<Rational, 4>, 3> m;
  std::size_t row = 0;
  for (const RationalPlane* plane : {&p, &q, &r}) {
    m[row++] = {plane->normal[0], plane->normal[1], plane->normal[2], Rational(-plane->offset)};
  }
  for (std::size_t i = 0; i < 3; ++i) {
    std::size_t pivot = i;
    while (pivot < 3 && m[pivot][i] == 0) ++pivot;
    if (pivot == 3) throw std::logic_error("dependent normals");
    std::swap(m[i], m[pivot]);
    for (std::size_t k = 0; k < 3; ++k) {
      if (k == i || m[k][i] == 0) continue;
      const Rational factor = m[k][i] / m[i][i];
      for (std::size_t j = i; j < 4; ++j) m[k][j] -= factor * m[i][j];
    }
  }
  return {m[0][3] / m[0][0], m[1][3] / m[1][1], m[2][3] / m[2][2]};
}

// The same point set, in either sense: proportional coefficients.
inline bool coincide(const RationalPlane& p, const RationalPlane& q) {
  const std::array<Rational, 4> a{p.normal[0], p.normal[1], p.normal[2], p.offset};
  const std::array<Rational, 4> b{q.normal[0], q.normal[1], q.normal[2], q.offset};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j) {
      if (a[i] * b[j] != a[j] * b[i]) return false;
    }
  }
  return true;
}

}  // namespace exactcsg::reference
