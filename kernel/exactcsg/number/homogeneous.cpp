// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/number/homogeneous.hpp"

#include <bit>
#include <cmath>

#include "exactcsg/support/error.hpp"

namespace exactcsg {

namespace {

std::string text_of(const Homogeneous<Integer>& p) {
  const Point3 point = point_of(p);
  return '(' + to_text(point.x) + ", " + to_text(point.y) + ", " + to_text(point.z) + ')';
}

Integer scaled(const Rational& value, const Integer& denominator) {
  if (value.get_den() == denominator) return value.get_num();
  return value.get_num() * (denominator / value.get_den());
}

// (q - p) times p.w q.w > 0, or times p.w if that is q.w too
Cofactors<Integer> difference(const Homogeneous<Integer>& p, const Homogeneous<Integer>& q) {
  if (p.w == q.w) return {q.x - p.x, q.y - p.y, q.z - p.z};
  return {q.x * p.w - p.x * q.w, q.y * p.w - p.y * q.w, q.z * p.w - p.z * q.w};
}

}  // namespace

Homogeneous<Integer> homogeneous_of(const Point3& point) {
  Homogeneous<Integer> result;
  result.w = lcm(lcm(point.x.get_den(), point.y.get_den()), point.z.get_den());
  result.x = scaled(point.x, result.w);
  result.y = scaled(point.y, result.w);
  result.z = scaled(point.z, result.w);
  return result;
}

Point3 point_of(const Homogeneous<Integer>& p) {
  Point3 point{Rational(p.x, p.w), Rational(p.y, p.w), Rational(p.z, p.w)};
  point.x.canonicalize();
  point.y.canonicalize();
  point.z.canonicalize();
  return point;
}

Plane plane_through(const Homogeneous<Integer>& p, const Homogeneous<Integer>& q,
                    const Homogeneous<Integer>& r) {
  const Cofactors<Integer> u = difference(p, q);
  const Cofactors<Integer> v = difference(p, r);
  Plane plane;
  plane.a = u.y * v.z - u.z * v.y;
  plane.b = u.z * v.x - u.x * v.z;
  plane.c = u.x * v.y - u.y * v.x;
  if (plane.a == 0 && plane.b == 0 && plane.c == 0) {
    throw Error(ErrorId::DegenerateFacet,
                {text_of(p) + ", " + text_of(q) + " and " + text_of(r) + " are collinear",
                 "three points that are not on one line"});
  }
  // Small factors are taken out first: the numbers that follow are shorter for it.
  const Integer common = gcd(gcd(plane.a, plane.b), plane.c);
  if (common != 1) {
    for (Integer* coefficient : {&plane.a, &plane.b, &plane.c}) {
      mpz_divexact(coefficient->get_mpz_t(), coefficient->get_mpz_t(), common.get_mpz_t());
    }
  }
  // n.(x - p) = 0; times p.w: (n p.w).x - n.(p.x, p.y, p.z) = 0. Since a, b, c are coprime, the
  // four coefficients' common factor is that of p.w and d.
  plane.d = -(plane.a * p.x + plane.b * p.y + plane.c * p.z);
  const Integer factor = gcd(p.w, plane.d);
  const Integer scale = p.w / factor;
  plane.a *= scale;
  plane.b *= scale;
  plane.c *= scale;
  plane.d /= factor;
  return plane;
}

PlaneOperand operand_of(const Plane& plane) {
  PlaneOperand operand;
  operand.plane = &plane;
  operand.normal_bits = std::max({bit_length(plane.a), bit_length(plane.b), bit_length(plane.c)});
  operand.offset_bits = bit_length(plane.d);
  return operand;
}

PlaneOperand operand_of_wall(Axis axis, double position) {
  PlaneOperand operand;
  operand.axis = axis;
  operand.normal_bits = 1;
  operand.offset_bits = 1;
  if (position == 0) return operand;
  int exponent = 0;
  operand.mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(position, &exponent), 53));
  operand.exponent = exponent - 53;
  const int zeros = std::countr_zero(static_cast<std::uint64_t>(operand.mantissa));
  operand.mantissa /= std::int64_t{1} << zeros;
  operand.exponent += zeros;
  operand.normal_bits = std::max(-operand.exponent, 0) + 1;
  operand.offset_bits = 53 - zeros + std::max(operand.exponent, 0);
  return operand;
}

}  // namespace exactcsg
