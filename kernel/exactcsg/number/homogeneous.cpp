// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/number/homogeneous.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <utility>

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

// What meeting_point_of_line computes with.
struct LineScratch {
  Integer common_w;
  Integer common_factor;
  std::array<Integer, 3> p;          // over common_w
  std::array<Integer, 3> direction;  // a multiple of q - p
  Integer at_p;                      // the plane's value at p, times common_w
  Integer slope;                     // the same of the direction
  Integer numerator;
  Integer denominator;
};

void divide_exactly(Integer& value, const Integer& divisor) {
  if (divisor != 1) mpz_divexact(value.get_mpz_t(), value.get_mpz_t(), divisor.get_mpz_t());
}

void set_dot(Integer& result, const std::array<const Integer*, 3>& normal,
             const std::array<Integer, 3>& vector) {
  mpz_mul(result.get_mpz_t(), normal[0]->get_mpz_t(), vector[0].get_mpz_t());
  mpz_addmul(result.get_mpz_t(), normal[1]->get_mpz_t(), vector[1].get_mpz_t());
  mpz_addmul(result.get_mpz_t(), normal[2]->get_mpz_t(), vector[2].get_mpz_t());
}

// p_i / w - at_p d_i / (slope w), where at_p and slope have no common factor and slope > 0. In
// lowest terms: the common factor of the numerator slope p_i - at_p d_i and of slope is that of d_i
// and slope; what is left of slope has none with what is left of the numerator, which may have one
// with w. So every common divisor sought is that of a short number and another.
Rational coordinate_of_line(LineScratch& s, std::size_t i) {
  Integer& x = s.numerator;
  Integer& w = s.denominator;
  Integer& factor = s.common_factor;
  mpz_mul(x.get_mpz_t(), s.slope.get_mpz_t(), s.p[i].get_mpz_t());
  mpz_submul(x.get_mpz_t(), s.at_p.get_mpz_t(), s.direction[i].get_mpz_t());
  mpz_gcd(factor.get_mpz_t(), s.slope.get_mpz_t(), s.direction[i].get_mpz_t());
  divide_exactly(x, factor);
  w = s.slope;
  divide_exactly(w, factor);
  mpz_gcd(factor.get_mpz_t(), x.get_mpz_t(), s.common_w.get_mpz_t());
  divide_exactly(x, factor);
  mpz_divexact(factor.get_mpz_t(), s.common_w.get_mpz_t(), factor.get_mpz_t());
  w *= factor;
  Rational result;
  result.get_num() = x;
  // Allocated anew, which is faster than made longer.
  mpz_clear(result.get_den_mpz_t());
  mpz_init_set(result.get_den_mpz_t(), w.get_mpz_t());
  return result;
}

// Sets slope and at_p, without a common factor. `direction` is divided by a power of two.
void set_slope(LineScratch& s, const Plane& plane) {
  halve_while_even(s.direction);
  const std::array<const Integer*, 3> normal{&plane.a, &plane.b, &plane.c};
  set_dot(s.slope, normal, s.direction);
  set_dot(s.at_p, normal, s.p);
  mpz_addmul(s.at_p.get_mpz_t(), plane.d.get_mpz_t(), s.common_w.get_mpz_t());
  mpz_gcd(s.common_factor.get_mpz_t(), s.at_p.get_mpz_t(), s.slope.get_mpz_t());
  if (s.slope < 0) s.common_factor = -s.common_factor;
  divide_exactly(s.at_p, s.common_factor);
  divide_exactly(s.slope, s.common_factor);
}

// The coordinate of all points of a plane, if it is perpendicular to the axis.
std::optional<Rational> common_coordinate(const Plane& plane, std::size_t axis) {
  const std::array<const Integer*, 3> normal{&plane.a, &plane.b, &plane.c};
  if (*normal[(axis + 1) % 3] != 0 || *normal[(axis + 2) % 3] != 0) return std::nullopt;
  // The coefficients are coprime already.
  Rational position;
  position.get_num() = *normal[axis] < 0 ? plane.d : Integer(-plane.d);
  position.get_den() = abs(*normal[axis]);
  return position;
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

Point3 meeting_point_of_line(const Point3& p, const Homogeneous<Integer>& homogeneous_p,
                             const Homogeneous<Integer>& homogeneous_q, const Plane& plane) {
  thread_local LineScratch s;
  s.common_w = homogeneous_p.w;
  make_multiple(s.common_w, homogeneous_q.w);
  scale_to_common_w(s.common_w, homogeneous_p, s.p, s.common_factor);
  scale_to_common_w(s.common_w, homogeneous_q, s.direction, s.common_factor);
  for (std::size_t i = 0; i < 3; ++i) s.direction[i] -= s.p[i];
  bool is_prepared = false;
  const auto of_line_and_plane = [&](std::size_t i) {
    if (!std::exchange(is_prepared, true)) set_slope(s, plane);
    return coordinate_of_line(s, i);
  };
  const auto met = [&](std::size_t i) {
    if (s.direction[i] == 0) return coordinate(p, i);
    if (const std::optional<Rational> position = common_coordinate(plane, i)) return *position;
    return of_line_and_plane(i);
  };
  return {met(0), met(1), met(2)};
}

std::optional<Point3> copied_meeting_point(const Point3& p, const Point3& q, const Plane& plane) {
  std::optional<std::size_t> along;
  for (std::size_t i = 0; i < 3; ++i) {
    if (coordinate(p, i) == coordinate(q, i)) continue;
    if (along) return std::nullopt;
    along = i;
  }
  const std::optional<Rational> position = common_coordinate(plane, *along);
  if (!position) return std::nullopt;
  Point3 result = p;
  (*along == 0 ? result.x : *along == 1 ? result.y : result.z) = *position;
  return result;
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
