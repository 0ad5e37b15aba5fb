// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/number/homogeneous.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "exactcsg/number/common_denominator.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg {

namespace {

std::string text_of(const Homogeneous<Integer>& p) {
  const Point3 point = point_of(p);
  return '(' + to_text(point.x) + ", " + to_text(point.y) + ", " + to_text(point.z) + ')';
}

// What plane_through computes with: kept by each thread, since allocating took longer than
// computing.
struct PlaneScratch {
  Integer common_w;
  Integer factor;
  std::array<Integer, 3> p;  // over common_w
  std::array<Integer, 3> u;  // q - p, likewise
  std::array<Integer, 3> v;  // r - p
  std::array<Integer, 3> normal;
  Integer offset;
};

std::array<const Integer*, 3> coordinates_of(const Homogeneous<Integer>& point) {
  return {&point.x, &point.y, &point.z};
}

void set_common_w(PlaneScratch& s, const Homogeneous<Integer>& p, const Homogeneous<Integer>& q,
                  const Homogeneous<Integer>& r) {
  s.common_w = p.w;
  for (const Homogeneous<Integer>* other : {&q, &r}) {
    make_multiple(s.common_w, other->w);
  }
}

// `factor` is overwritten.
void scale_to_common_w(const Integer& common_w, const Homogeneous<Integer>& point,
                       std::array<Integer, 3>& result, Integer& factor) {
  const auto from = coordinates_of(point);
  if (point.w == common_w) {
    for (std::size_t i = 0; i < 3; ++i) result[i] = *from[i];
    return;
  }
  mpz_divexact(factor.get_mpz_t(), common_w.get_mpz_t(), point.w.get_mpz_t());
  for (std::size_t i = 0; i < 3; ++i) {
    mpz_mul(result[i].get_mpz_t(), from[i]->get_mpz_t(), factor.get_mpz_t());
  }
}

// Powers of two are most of what the differences of doubles have in common.
void halve_while_even(std::array<Integer, 3>& vector) {
  mp_bitcnt_t zeros = ~mp_bitcnt_t{0};
  for (const Integer& c : vector) zeros = std::min(zeros, mpz_scan1(c.get_mpz_t(), 0));
  if (zeros == 0 || zeros == ~mp_bitcnt_t{0}) return;
  for (Integer& c : vector) mpz_tdiv_q_2exp(c.get_mpz_t(), c.get_mpz_t(), zeros);
}

void make_normal_coprime(PlaneScratch& s) {
  mpz_gcd(s.factor.get_mpz_t(), s.normal[0].get_mpz_t(), s.normal[1].get_mpz_t());
  if (s.factor != 1) {
    mpz_gcd(s.factor.get_mpz_t(), s.factor.get_mpz_t(), s.normal[2].get_mpz_t());
  }
  if (s.factor == 1) return;
  for (Integer& c : s.normal) mpz_divexact(c.get_mpz_t(), c.get_mpz_t(), s.factor.get_mpz_t());
}

}  // namespace

Homogeneous<Integer> homogeneous_of(const Point3& point) {
  Homogeneous<Integer> result;
  result.w = point.x.get_den();
  make_multiple(result.w, point.y.get_den());
  make_multiple(result.w, point.z.get_den());
  set_scaled(result.x, point.x, result.w);
  set_scaled(result.y, point.y, result.w);
  set_scaled(result.z, point.z, result.w);
  return result;
}

Point3 point_of(const Homogeneous<Integer>& p) {
  Point3 point{Rational(p.x, p.w), Rational(p.y, p.w), Rational(p.z, p.w)};
  point.x.canonicalize();
  point.y.canonicalize();
  point.z.canonicalize();
  return point;
}

Homogeneous<Integer> moved_along_axis(Homogeneous<Integer> point, Axis axis) {
  (axis == Axis::X ? point.x : axis == Axis::Y ? point.y : point.z) += point.w;
  return point;
}

Plane plane_through(const Homogeneous<Integer>& p, const Homogeneous<Integer>& q,
                    const Homogeneous<Integer>& r) {
  thread_local PlaneScratch s;
  set_common_w(s, p, q, r);
  scale_to_common_w(s.common_w, p, s.p, s.factor);
  scale_to_common_w(s.common_w, q, s.u, s.factor);
  scale_to_common_w(s.common_w, r, s.v, s.factor);
  for (std::size_t i = 0; i < 3; ++i) {
    s.u[i] -= s.p[i];
    s.v[i] -= s.p[i];
  }
  halve_while_even(s.u);
  halve_while_even(s.v);
  set_cross(s.normal, s.u, s.v);
  if (s.normal[0] == 0 && s.normal[1] == 0 && s.normal[2] == 0) {
    throw Error(ErrorId::DegenerateFacet,
                {text_of(p) + ", " + text_of(q) + " and " + text_of(r) + " are collinear",
                 "three points that are not on one line"});
  }
  make_normal_coprime(s);
  // n.(x - p/w) = 0; times w: (n w).x - n.p = 0. Since the components of n are coprime, the four
  // coefficients' common factor is that of w and n.p.
  s.offset = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    mpz_submul(s.offset.get_mpz_t(), s.normal[i].get_mpz_t(), s.p[i].get_mpz_t());
  }
  mpz_gcd(s.factor.get_mpz_t(), s.common_w.get_mpz_t(), s.offset.get_mpz_t());
  mpz_divexact(s.common_w.get_mpz_t(), s.common_w.get_mpz_t(), s.factor.get_mpz_t());
  mpz_divexact(s.offset.get_mpz_t(), s.offset.get_mpz_t(), s.factor.get_mpz_t());
  if (s.common_w != 1) {
    for (Integer& c : s.normal) c *= s.common_w;
  }
  return {s.normal[0], s.normal[1], s.normal[2], s.offset};
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
