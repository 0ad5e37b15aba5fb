// SPDX-License-Identifier: Apache-2.0
// Bounds, in limbs: numerators have at most 3, odd parts of denominators 1, exponents are below
// 192. Coordinates over a common denominator have at most 3 + 1 + 3 = 7, differences of them 8
// (and those of points over different odd parts 9), a normal 19, its product with a point 27.
// Of planes that are met, normals have at most 8 and offsets at most 14: products with the line
// have 18, over the common denominator 22, and a coordinate's numerator 18 + 12 + 3 or
// 22 + 9 + 3, cut or not by powers of two.
#include "exactcsg/number/short_meeting.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "exactcsg/number/few_limbs.hpp"

namespace exactcsg {

namespace {

static_assert(FewLimbs::capacity >= 40);

constexpr std::size_t most_limbs_of_numerators = 3;
constexpr unsigned long most_exponent = 3UL * GMP_NUMB_BITS;
constexpr std::size_t most_limbs_of_normals = 8;
constexpr std::size_t most_limbs_of_offsets = 14;

using Vector = std::array<FewLimbs, 3>;

// A denominator as an odd number times a power of two.
struct Denominator {
  mp_limb_t odd = 1;
  unsigned long exponent = 0;
};

std::optional<Denominator> denominator_of(const RationalView& value) {
  if (value.has_binary_denominator()) {
    if (value.exponent >= most_exponent) return std::nullopt;
    return Denominator{1, value.exponent};
  }
  const LimbSpan limbs = value.denominator;
  const auto zeros = static_cast<unsigned long>(count_low_zeros(limbs));
  if (zeros >= most_exponent) return std::nullopt;
  const std::size_t whole = zeros / GMP_NUMB_BITS;
  const auto rest = static_cast<unsigned>(zeros % GMP_NUMB_BITS);
  if (limbs.size() > whole + 2) return std::nullopt;
  mp_limb_t odd = limbs[whole] >> rest;
  if (limbs.size() == whole + 2) {
    if (rest == 0 || limbs[whole + 1] >> rest != 0) return std::nullopt;
    odd |= limbs[whole + 1] << (GMP_NUMB_BITS - rest);
  }
  return Denominator{odd, zeros};
}

// A point's coordinates as they are read.
struct Read {
  std::array<LimbSpan, 3> numerator;
  std::array<Denominator, 3> denominator;
  std::array<bool, 3> negative{};
  Denominator common;
};

// To the least common multiple, if its odd part has one limb.
bool widen(Denominator& common, const Denominator& other) {
  common.exponent = std::max(common.exponent, other.exponent);
  if (common.odd == 1) {
    common.odd = other.odd;
    return true;
  }
  if (common.odd == other.odd || common.odd % other.odd == 0) return true;
  const mp_limb_t factor = other.odd / std::gcd(common.odd, other.odd);
  return !__builtin_mul_overflow(common.odd, factor, &common.odd);
}

bool read(Read& result, const PointView& point) {
  result.common = {};
  for (std::size_t i = 0; i < 3; ++i) {
    const RationalView& value = point[i];
    result.numerator[i] = value.numerator;
    result.negative[i] = value.negative;
    const auto denominator = denominator_of(value);
    if (!denominator || result.numerator[i].size() > most_limbs_of_numerators) return false;
    result.denominator[i] = *denominator;
    if (!widen(result.common, *denominator)) return false;
  }
  return true;
}

void set_scaled(Vector& result, const Read& point, const Denominator& common) {
  for (std::size_t i = 0; i < 3; ++i) {
    result[i].set(point.numerator[i], point.negative[i]);
    if (point.denominator[i].odd != common.odd) {
      result[i].multiply(common.odd / point.denominator[i].odd);
    }
    result[i].shift_left(common.exponent - point.denominator[i].exponent);
  }
}

void set_difference(Vector& result, const Vector& a, const Vector& b) {
  for (std::size_t i = 0; i < 3; ++i) {
    result[i].set(a[i]);
    result[i].subtract(b[i]);
  }
}

void halve_while_even(Vector& vector) {
  unsigned long zeros = ~0UL;
  for (const FewLimbs& c : vector) {
    if (!c.is_zero()) zeros = std::min(zeros, c.count_zeros());
  }
  if (zeros == ~0UL) return;
  for (FewLimbs& c : vector) c.shift_right(zeros);
}

void divide_by_odd_gcd(FewLimbs& a, FewLimbs& b, FewLimbs& factor) {
  if (a.is_zero() || b.is_zero()) {
    if (!a.is_zero()) a.set(1);
    if (!b.is_zero()) b.set(1);
    return;
  }
  FewLimbs odd;
  odd.set(a);
  odd.shift_right(odd.count_zeros());
  factor.set_odd_gcd(odd, b);
  if (factor.is_magnitude_one()) return;
  a.divide_exactly(factor);
  b.divide_exactly(factor);
}

// A vector of the same direction, or of the opposite one: copies of a shape are moved by decimals,
// which their differences do not have any more, and where a coordinate is common, the others often
// have the radius of the circle in common that is drawn across the axis.
void shorten(Vector& vector, mp_limb_t odd, FewLimbs& factor) {
  halve_while_even(vector);
  const std::array<bool, 3> zero{vector[0].is_zero(), vector[1].is_zero(), vector[2].is_zero()};
  for (std::size_t i = 0; i < 3; ++i) {
    if (!zero[i]) continue;
    divide_by_odd_gcd(vector[(i + 1) % 3], vector[(i + 2) % 3], factor);
    return;
  }
  std::size_t divided = 0;
  while (divided < 3 && vector[divided].divide_if_exact(odd)) ++divided;
  if (divided == 3) return;
  for (std::size_t i = 0; i < divided; ++i) vector[i].multiply(odd);
}

void set_dot(FewLimbs& result, const Vector& a, const Vector& b) {
  result.set_product(a[0], b[0]);
  result.add_product(a[1], b[1]);
  result.add_product(a[2], b[2]);
}

void assign(Integer& result, const FewLimbs& value) {
  const auto size = static_cast<mp_size_t>(value.magnitude().size());
  if (size == 0) {
    result = 0;
    return;
  }
  std::copy_n(value.magnitude().data(), size, mpz_limbs_write(result.get_mpz_t(), size));
  mpz_limbs_finish(result.get_mpz_t(), value.is_negative() ? -size : size);
}

// What is computed with, and what views of results refer to.
struct Scratch {
  std::array<Read, 3> read;
  std::array<Vector, 3> points;
  Vector u;
  Vector v;
  Vector normal;
  FewLimbs factor;
  FewLimbs at_p;
  FewLimbs slope;
  FewLimbs offset;
  Vector numerators;
  Vector denominators;
};

Scratch& scratch() {
  thread_local Scratch result;
  return result;
}

bool has_zero(const Vector& vector) {
  return vector[0].is_zero() || vector[1].is_zero() || vector[2].is_zero();
}

}  // namespace

std::optional<PlaneForm> short_plane_form_through(const PointView& p, const PointView& q,
                                                  const PointView& r) {
  Scratch& s = scratch();
  if (!read(s.read[0], p) || !read(s.read[1], q) || !read(s.read[2], r)) return std::nullopt;
  Denominator common = s.read[0].common;
  if (!widen(common, s.read[1].common) || !widen(common, s.read[2].common)) return std::nullopt;
  for (std::size_t i = 0; i < 3; ++i) set_scaled(s.points[i], s.read[i], common);
  const auto& [a, b, c] = s.points;
  set_difference(s.u, b, a);
  set_difference(s.v, c, a);
  // Of the triangle's sides, one with a coordinate in common is the shortest.
  if (!has_zero(s.u) && !has_zero(s.v)) set_difference(s.v, c, b);
  shorten(s.u, common.odd, s.factor);
  shorten(s.v, common.odd, s.factor);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const std::size_t k = (i + 2) % 3;
    s.normal[i].set_product(s.u[j], s.v[k]);
    s.normal[i].subtract_product(s.u[k], s.v[j]);
  }
  halve_while_even(s.normal);
  set_dot(s.at_p, s.normal, a);
  PlaneForm form;
  for (std::size_t i = 0; i < 3; ++i) assign(form.normal[i], s.normal[i]);
  assign(form.offset, s.at_p);
  form.odd = common.odd;
  form.exponent = common.exponent;
  return form;
}

namespace {

void read(FewLimbs& result, const Integer& value) { result.set(limbs_of(value), sgn(value) < 0); }

bool is_short(const PlaneForm& plane) {
  return mpz_size(plane.normal[0].get_mpz_t()) <= most_limbs_of_normals &&
         mpz_size(plane.normal[1].get_mpz_t()) <= most_limbs_of_normals &&
         mpz_size(plane.normal[2].get_mpz_t()) <= most_limbs_of_normals &&
         mpz_size(plane.offset.get_mpz_t()) <= most_limbs_of_offsets && plane.odd.fits_ulong_p() &&
         plane.exponent < most_exponent;
}

// What the coordinates of a point of the line have in common: it is p - d at_p / (slope odd
// 2^exponent) with the direction d, slope > 0 odd and prime to at_p.
struct OnLine {
  unsigned long exponent_of_p = 0;  // p is over odd 2^exponent_of_p
  long exponent = 0;
  mp_limb_t odd = 1;
};

// p_i - at_p d_i / (slope odd 2^exponent), in lowest terms: the odd common factor of the numerator
// slope p_i 2^m - at_p d_i 2^n and of slope is that of d_i and slope; what is left of slope has
// none with what is left of the numerator, which may have one with odd.
RationalView coordinate_of_line(Scratch& s, std::size_t i, const FewLimbs& at_p_of_line,
                                const FewLimbs& direction, const OnLine& line) {
  FewLimbs& x = s.numerators[i];
  FewLimbs& w = s.denominators[i];
  FewLimbs& moved = s.offset;
  const long exponent = std::max(static_cast<long>(line.exponent_of_p), line.exponent);
  x.set_product(s.slope, at_p_of_line);
  x.shift_left(static_cast<unsigned long>(exponent) - line.exponent_of_p);
  moved.set_product(s.at_p, direction);
  moved.shift_left(static_cast<unsigned long>(exponent - line.exponent));
  x.subtract(moved);
  if (x.is_zero()) return {};
  s.factor.set_odd_gcd(s.slope, direction);
  w.set(s.slope);
  if (!s.factor.is_magnitude_one()) {
    x.divide_exactly(s.factor);
    w.divide_exactly(s.factor);
  }
  const unsigned long halvings = std::min(x.count_zeros(), static_cast<unsigned long>(exponent));
  x.shift_right(halvings);
  if (line.odd != 1) {
    const LimbSpan limbs = x.magnitude();
    const mp_limb_t common =
        mpn_gcd_1(limbs.data(), static_cast<mp_size_t>(limbs.size()), line.odd);
    if (common == 1) {
      w.multiply(line.odd);
    } else {
      x.divide_if_exact(common);
      w.multiply(line.odd / common);
    }
  }
  const unsigned long left = static_cast<unsigned long>(exponent) - halvings;
  RationalView view;
  view.numerator = x.magnitude();
  view.negative = x.is_negative();
  if (w.is_magnitude_one()) {
    view.exponent = left;
  } else {
    w.shift_left(left);
    view.denominator = w.magnitude();
  }
  return view;
}

}  // namespace

std::optional<PointView> short_meeting_point_of_line(const PointView& p, const PointView& q,
                                                     const PlaneForm& plane) {
  Scratch& s = scratch();
  if (!is_short(plane) || !read(s.read[0], p)) return std::nullopt;
  const std::array<bool, 3> along{!equal(p[0], q[0]), !equal(p[1], q[1]), !equal(p[2], q[2])};
  Denominator common = s.read[0].common;
  Vector& from = s.points[0];
  Vector& direction = s.u;
  if (along[0] + along[1] + along[2] == 1) {
    set_scaled(from, s.read[0], common);
    for (std::size_t i = 0; i < 3; ++i) direction[i].set(along[i] ? 1 : 0);
  } else {
    if (!read(s.read[1], q) || !widen(common, s.read[1].common)) return std::nullopt;
    set_scaled(from, s.read[0], common);
    set_scaled(s.points[1], s.read[1], common);
    set_difference(direction, s.points[1], from);
    shorten(direction, common.odd, s.factor);
  }
  OnLine line;
  line.odd = common.odd;
  const mp_limb_t odd_of_plane = plane.odd.get_ui();
  const bool same_odd = odd_of_plane == common.odd;
  if (!same_odd && __builtin_mul_overflow(common.odd, odd_of_plane, &line.odd)) {
    return std::nullopt;
  }
  for (std::size_t i = 0; i < 3; ++i) read(s.normal[i], plane.normal[i]);
  set_dot(s.slope, s.normal, direction);
  set_dot(s.at_p, s.normal, from);
  // p and the plane over one denominator.
  const unsigned long exponent = std::max<unsigned long>(common.exponent, plane.exponent);
  read(s.offset, plane.offset);
  s.at_p.shift_left(exponent - common.exponent);
  s.offset.shift_left(exponent - plane.exponent);
  if (!same_odd) {
    s.at_p.multiply(odd_of_plane);
    s.offset.multiply(common.odd);
    for (FewLimbs& coordinate : from) coordinate.multiply(odd_of_plane);
  }
  s.at_p.subtract(s.offset);
  line.exponent_of_p = common.exponent;
  // Powers of two go into the exponent.
  const unsigned long zeros_of_slope = s.slope.count_zeros();
  s.slope.shift_right(zeros_of_slope);
  line.exponent = static_cast<long>(exponent + zeros_of_slope);
  if (!s.at_p.is_zero()) {
    const unsigned long zeros = s.at_p.count_zeros();
    s.at_p.shift_right(zeros);
    line.exponent -= static_cast<long>(zeros);
  }
  if (s.slope.is_negative()) {
    s.slope.negate();
    s.at_p.negate();
  }
  if (s.at_p.is_zero()) {
    s.slope.set(1);
  } else {
    s.factor.set_odd_gcd(s.slope, s.at_p);
    s.at_p.divide_exactly(s.factor);
    s.slope.divide_exactly(s.factor);
  }
  const auto met = [&](std::size_t i) -> RationalView {
    if (direction[i].is_zero()) return p[i];
    return coordinate_of_line(s, i, from[i], direction[i], line);
  };
  return PointView{met(0), met(1), met(2)};
}

}  // namespace exactcsg
