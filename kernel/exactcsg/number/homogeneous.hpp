// SPDX-License-Identifier: Apache-2.0
#pragma once

// Homogeneous integer coordinates of points and of meeting points of planes, and the bounds on
// their bits. Private to the kernel. [Exact]

#include <algorithm>
#include <array>
#include <cstdint>

#include "exactcsg/number/exact_tiers.hpp"
#include "exactcsg/number/geometry.hpp"
#include "exactcsg/number/point.hpp"

namespace exactcsg {

// (x/w, y/w, z/w), w != 0
template <class T>
struct Homogeneous {
  T x, y, z, w;
};

template <class T>
const T& coordinate(const Homogeneous<T>& p, Axis axis) {
  return axis == Axis::X ? p.x : axis == Axis::Y ? p.y : p.z;
}

template <class T>
struct Coefficients {
  T a, b, c, d;
};

// The coordinates over their least common denominator; w > 0.
Homogeneous<Integer> homogeneous_of(const Point3& point);

// REQUIRES p.w != 0
Point3 point_of(const Homogeneous<Integer>& p);

// The point moved up along the axis by one.
Homogeneous<Integer> moved_along_axis(Homogeneous<Integer> point, Axis axis);

// The coprime coefficients of the plane through three points. THROWS Error(DegenerateFacet)
Plane plane_through(const Homogeneous<Integer>& p, const Homogeneous<Integer>& q,
                    const Homogeneous<Integer>& r);

inline int bit_length(const Integer& value) {
  return static_cast<int>(mpz_sizeinbase(value.get_mpz_t(), 2));
}

// A plane as a formula's operand: exact coefficients of the table, or {axis = mantissa 2^exponent},
// and the bits of its coefficients.
struct PlaneOperand {
  const Plane* plane = nullptr;  // null: a wall
  Axis axis = Axis::X;
  std::int64_t mantissa = 0;
  int exponent = 0;
  int normal_bits = 0;  // |a|, |b|, |c| < 2^normal_bits
  int offset_bits = 0;  // |d| < 2^offset_bits
};

PlaneOperand operand_of(const Plane& plane);
// {coordinate along axis = position}. REQUIRES a finite position
PlaneOperand operand_of_wall(Axis axis, double position);

template <class T>
Coefficients<T> load(const PlaneOperand& operand) {
  if (operand.plane != nullptr) {
    const Plane& plane = *operand.plane;
    return {integer_from<T>(plane.a), integer_from<T>(plane.b), integer_from<T>(plane.c),
            integer_from<T>(plane.d)};
  }
  const int normal_shift = std::max(-operand.exponent, 0);
  const int offset_shift = std::max(operand.exponent, 0);
  const auto normal = [&operand, normal_shift](Axis axis) {
    return operand.axis == axis ? integer_from<T>(1, normal_shift) : integer_from<T>(0, 0);
  };
  return {normal(Axis::X), normal(Axis::Y), normal(Axis::Z),
          integer_from<T>(-operand.mantissa, offset_shift)};
}

template <class T>
Homogeneous<T> load(const Homogeneous<Integer>& p) {
  return {integer_from<T>(p.x), integer_from<T>(p.y), integer_from<T>(p.z), integer_from<T>(p.w)};
}

template <class T>
struct Cofactors {
  T x, y, z;
};

template <class T>
Cofactors<T> cross(const Coefficients<T>& p, const Coefficients<T>& q) {
  return {p.b * q.c - p.c * q.b, p.c * q.a - p.a * q.c, p.a * q.b - p.b * q.a};
}

template <class T>
T determinant(const Coefficients<T>& p, const Cofactors<T>& of_p) {
  return p.a * of_p.x + p.b * of_p.y + p.c * of_p.z;
}

// By Cramer's rule: N x = -d, and N^-1 = (q x r, r x p, p x q) / det N, as columns.
template <class T>
Homogeneous<T> meeting_point(const Coefficients<T>& p, const Coefficients<T>& q,
                             const Coefficients<T>& r) {
  const Cofactors<T> of_p = cross(q, r);
  const Cofactors<T> of_q = cross(r, p);
  const Cofactors<T> of_r = cross(p, q);
  const T w = determinant(p, of_p);
  return {-(p.d * of_p.x + q.d * of_q.x + r.d * of_r.x),
          -(p.d * of_p.y + q.d * of_q.y + r.d * of_r.y),
          -(p.d * of_p.z + q.d * of_q.z + r.d * of_r.z), w};
}

// One coordinate: value / w.
template <class T>
struct HomogeneousCoordinate {
  T value, w;
};

template <class T>
const T& component(const Cofactors<T>& c, Axis axis) {
  return axis == Axis::X ? c.x : axis == Axis::Y ? c.y : c.z;
}

template <class T>
T cofactor(const Coefficients<T>& p, const Coefficients<T>& q, Axis axis) {
  if (axis == Axis::X) return p.b * q.c - p.c * q.b;
  if (axis == Axis::Y) return p.c * q.a - p.a * q.c;
  return p.a * q.b - p.b * q.a;
}

// The same formula as meeting_point, without the other two coordinates.
template <class T>
HomogeneousCoordinate<T> meeting_coordinate(const Coefficients<T>& p, const Coefficients<T>& q,
                                            const Coefficients<T>& r, Axis axis) {
  const Cofactors<T> of_p = cross(q, r);
  const T of_q = cofactor(r, p, axis);
  const T of_r = cofactor(p, q, axis);
  return {-(p.d * component(of_p, axis) + q.d * of_q + r.d * of_r), determinant(p, of_p)};
}

// Bits of homogeneous coordinates: |x|, |y|, |z| < 2^coordinate, |w| < 2^denominator.
struct HomogeneousBits {
  int coordinate = 0;
  int denominator = 0;
};

inline HomogeneousBits bits_of(const Homogeneous<Integer>& p) {
  return {std::max({bit_length(p.x), bit_length(p.y), bit_length(p.z)}), bit_length(p.w)};
}

// Of meeting_point: a 3x3 determinant is a sum of 6 < 2^3 products, one entry from each row. The
// partial sums that the formula forms are sums of some of these products.
inline HomogeneousBits bits_of_meeting_point(const std::array<PlaneOperand, 3>& planes) {
  const auto& [p, q, r] = planes;
  const int d = std::max({p.offset_bits + q.normal_bits + r.normal_bits,
                          p.normal_bits + q.offset_bits + r.normal_bits,
                          p.normal_bits + q.normal_bits + r.offset_bits});
  return {d + 3, p.normal_bits + q.normal_bits + r.normal_bits + 3};
}

// a x + b y + c z + d w
template <class T>
T value_at(const Coefficients<T>& plane, const Homogeneous<T>& p) {
  return plane.a * p.x + plane.b * p.y + plane.c * p.z + plane.d * p.w;
}

// A sum of 4 = 2^2 products.
inline int bits_of_value(const PlaneOperand& plane, const HomogeneousBits& p) {
  return std::max(plane.normal_bits + p.coordinate, plane.offset_bits + p.denominator) + 2;
}

}  // namespace exactcsg
