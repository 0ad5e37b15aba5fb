// SPDX-License-Identifier: Apache-2.0
#pragma once

// Exact points, vectors, affine maps and planes of 3-space, as plain values. [Exact]

#include <array>
#include <compare>
#include <cstddef>
#include <span>

#include "exactcsg/number/exact.hpp"

namespace exactcsg {

struct Vector3 {
  Rational x, y, z;
  friend bool operator==(const Vector3&, const Vector3&) = default;
};

struct Point3 {
  Rational x, y, z;
  friend bool operator==(const Point3&, const Point3&) = default;
};

// Along axis 0, 1 or 2: x, y or z.
inline const Rational& coordinate(const Point3& p, std::size_t axis) {
  return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
}
inline const Rational& coordinate(const Vector3& v, std::size_t axis) {
  return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

// Lexicographic by x, y, z.
std::strong_ordering compare(const Point3& p, const Point3& q);
inline bool operator<(const Point3& p, const Point3& q) { return compare(p, q) < 0; }

Vector3 operator-(const Point3& p, const Point3& q);
Point3 operator+(const Point3& p, const Vector3& v);
Vector3 operator*(const Rational& s, const Vector3& v);
Rational dot(const Vector3& u, const Vector3& v);
Vector3 cross(const Vector3& u, const Vector3& v);
// The same of integers, without allocating where `result` has room already.
// REQUIRES that result is neither u nor v
void set_cross(std::array<Integer, 3>& result, const std::array<Integer, 3>& u,
               const std::array<Integer, 3>& v);

// x -> M x + t, row by row: m[i] = {M_i0, M_i1, M_i2, t_i}.
struct AffineMap {
  std::array<std::array<Rational, 4>, 3> m;

  static AffineMap identity();
  friend bool operator==(const AffineMap&, const AffineMap&) = default;
};

// LAW map.1  (f * g)(p) == f(g(p))
AffineMap operator*(const AffineMap& f, const AffineMap& g);
Point3 apply(const AffineMap& f, const Point3& p);
// The determinant of the linear part: 0 singular, < 0 mirroring.
Rational determinant(const AffineMap& f);
// REQUIRES determinant(f) != 0.  LAW map.2  inverse(f) * f == identity()
AffineMap inverse(const AffineMap& f);

// The plane a x + b y + c z + d = 0, and the half-space a x + b y + c z + d <= 0 whose
// outward normal is (a, b, c).
// LAW plane.1  a, b, c, d are coprime integers and (a, b, c) != 0, so equal oriented planes have
// equal coefficients.
struct Plane {
  Integer a, b, c, d;
  friend bool operator==(const Plane&, const Plane&) = default;
};

// Lexicographic by a, b, c, d.
std::strong_ordering compare(const Plane& p, const Plane& q);
Plane opposite(const Plane& p);
// Coprime integers of the same oriented plane. THROWS Error(DegenerateHalfSpace) if a = b = c = 0.
Plane make_plane(const Rational& a, const Rational& b, const Rational& c, const Rational& d);
// The plane through p, q, r, seen counter-clockwise from outside (normal (q-p) x (r-p)).
// THROWS Error(DegenerateFacet) if they are collinear.
Plane plane_through(const Point3& p, const Point3& q, const Point3& r);
// The sign of a x + b y + c z + d: Negative is inside the half-space.
Sign side(const Plane& plane, const Point3& point);
// The image of the half-space under an invertible map, also a mirroring one.
// THROWS Error(SingularMap)
Plane apply(const AffineMap& f, const Plane& plane);

}  // namespace exactcsg
