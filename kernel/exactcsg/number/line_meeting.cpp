// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/number/line_meeting.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include "exactcsg/number/common_denominator.hpp"
#include "exactcsg/number/limbs.hpp"
#include "exactcsg/number/short_meeting.hpp"

namespace exactcsg {

namespace {

using Vector = std::array<Integer, 3>;

// numerator / (odd 2^exponent)
struct Scaled {
  Vector numerator;
  Integer odd;  // an odd number > 0
  mp_bitcnt_t exponent = 0;
};

// What is computed with: kept by each thread, since allocating took longer than computing.
struct Scratch {
  std::array<Scaled, 3> points;
  Vector u;
  Vector v;
  Integer factor;
  Integer other_factor;
  Integer common_odd;
  Integer at_p;
  Integer slope;
  std::array<Integer, 3> numerators;
  std::array<Integer, 3> denominators;
};

Scratch& scratch() {
  thread_local Scratch result;
  return result;
}

mp_bitcnt_t count_zeros(const Integer& value) { return mpz_scan1(value.get_mpz_t(), 0); }

void shift_left(Integer& value, mp_bitcnt_t count) {
  if (count > 0) mpz_mul_2exp(value.get_mpz_t(), value.get_mpz_t(), count);
}

void shift_right(Integer& value, mp_bitcnt_t count) {
  if (count > 0) mpz_tdiv_q_2exp(value.get_mpz_t(), value.get_mpz_t(), count);
}

void multiply(Integer& value, const Integer& factor) {
  if (factor != 1) mpz_mul(value.get_mpz_t(), value.get_mpz_t(), factor.get_mpz_t());
}

void divide_exactly(Integer& value, const Integer& divisor) {
  if (divisor != 1) mpz_divexact(value.get_mpz_t(), value.get_mpz_t(), divisor.get_mpz_t());
}

void set_gcd(Integer& result, const Integer& a, const Integer& b) {
  mpz_gcd(result.get_mpz_t(), a.get_mpz_t(), b.get_mpz_t());
}

// Powers of two are most of what the differences of doubles have in common.
void halve_while_even(Vector& vector) {
  mp_bitcnt_t zeros = ~mp_bitcnt_t{0};
  for (const Integer& c : vector) {
    if (c != 0) zeros = std::min(zeros, count_zeros(c));
  }
  if (zeros == ~mp_bitcnt_t{0}) return;
  for (Integer& c : vector) shift_right(c, zeros);
}

// Where a coordinate is common, the others often have a long factor in common: the radius of the
// circle that is drawn across the axis.
void shorten(Vector& vector, Integer& factor) {
  halve_while_even(vector);
  for (std::size_t i = 0; i < 3; ++i) {
    if (vector[i] != 0) continue;
    Integer& a = vector[(i + 1) % 3];
    Integer& b = vector[(i + 2) % 3];
    set_gcd(factor, a, b);
    if (factor == 0) return;
    divide_exactly(a, factor);
    divide_exactly(b, factor);
    return;
  }
}

// The odd part of a denominator, if it has one limb.
std::optional<mp_limb_t> short_odd_part(LimbSpan denominator, mp_bitcnt_t zeros) {
  const std::size_t whole = zeros / GMP_NUMB_BITS;
  const auto rest = static_cast<unsigned>(zeros % GMP_NUMB_BITS);
  const LimbSpan kept = denominator.subspan(whole);
  if (kept.size() == 1) return kept[0] >> rest;
  if (kept.size() > 2 || rest == 0 || kept[1] >> rest != 0) return std::nullopt;
  return kept[0] >> rest | kept[1] << (GMP_NUMB_BITS - rest);
}

std::optional<mp_limb_t> short_common_multiple(const std::array<mp_limb_t, 3>& numbers) {
  mp_limb_t common = numbers[0];
  for (const mp_limb_t number : {numbers[1], numbers[2]}) {
    if (common % number == 0) continue;
    if (__builtin_mul_overflow(common, number / std::gcd(common, number), &common)) {
      return std::nullopt;
    }
  }
  return common;
}

// An integer of somebody else's limbs, for GMP to read.
class IntegerView {
 public:
  explicit IntegerView(LimbSpan limbs, bool negative = false) {
    const auto size = static_cast<mp_size_t>(limbs.size());
    mpz_roinit_n(value_, limbs.data(), negative ? -size : size);
  }
  static IntegerView of_numerator(const RationalView& value) {
    return IntegerView(value.numerator, value.negative);
  }
  mpz_srcptr get() const { return value_; }

 private:
  mpz_t value_;
};

// numerator * factor * 2^shift
void set_multiple(Integer& result, const IntegerView& numerator, mp_limb_t factor,
                  mp_bitcnt_t shift) {
  if (factor == 1) {
    mpz_mul_2exp(result.get_mpz_t(), numerator.get(), shift);
    return;
  }
  mpz_mul_ui(result.get_mpz_t(), numerator.get(), factor);
  shift_left(result, shift);
}

// The odd parts of the denominators are long. `odd` is overwritten.
void set_long_scaled(Scaled& result, const PointView& point,
                     const std::array<mp_bitcnt_t, 3>& exponents, Integer& odd) {
  const auto set_odd = [&](std::size_t i) {
    if (point[i].has_binary_denominator()) {
      odd = 1;
      return;
    }
    mpz_tdiv_q_2exp(odd.get_mpz_t(), IntegerView(point[i].denominator).get(), exponents[i]);
  };
  result.odd = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    set_odd(i);
    make_multiple(result.odd, odd);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    set_odd(i);
    mpz_divexact(odd.get_mpz_t(), result.odd.get_mpz_t(), odd.get_mpz_t());
    mpz_mul(result.numerator[i].get_mpz_t(), IntegerView::of_numerator(point[i]).get(),
            odd.get_mpz_t());
    shift_left(result.numerator[i], result.exponent - exponents[i]);
  }
}

// `odd` is overwritten.
void set_scaled(Scaled& result, const PointView& point, Integer& odd) {
  std::array<mp_bitcnt_t, 3> exponents{};
  std::array<mp_limb_t, 3> odds{};
  bool all_short = true;
  for (std::size_t i = 0; i < 3; ++i) {
    odds[i] = 1;
    if (point[i].has_binary_denominator()) {
      exponents[i] = point[i].exponent;
      continue;
    }
    const LimbSpan denominator = point[i].denominator;
    exponents[i] = static_cast<mp_bitcnt_t>(count_low_zeros(denominator));
    const std::optional<mp_limb_t> odd_part = short_odd_part(denominator, exponents[i]);
    all_short = all_short && odd_part;
    odds[i] = odd_part.value_or(1);
  }
  result.exponent = std::max({exponents[0], exponents[1], exponents[2]});
  const auto common = all_short ? short_common_multiple(odds) : std::nullopt;
  if (!common) {
    set_long_scaled(result, point, exponents, odd);
    return;
  }
  result.odd = *common;
  for (std::size_t i = 0; i < 3; ++i) {
    set_multiple(result.numerator[i], IntegerView::of_numerator(point[i]), *common / odds[i],
                 result.exponent - exponents[i]);
  }
}

// Coprime factors with a of_a = b of_b.
void set_common_factors(const Integer& a, const Integer& b, Integer& of_a, Integer& of_b) {
  if (a.fits_ulong_p() && b.fits_ulong_p()) {
    const mp_limb_t common = std::gcd(a.get_ui(), b.get_ui());
    of_a = b.get_ui() / common;
    of_b = a.get_ui() / common;
    return;
  }
  const Integer common = gcd(a, b);
  of_a = b / common;
  of_b = a / common;
}

// A positive multiple of q - p. `of_p` and `of_q` are overwritten.
void set_direction(Vector& result, const Scaled& p, const Scaled& q, Integer& of_p, Integer& of_q) {
  const mp_bitcnt_t exponent = std::max(p.exponent, q.exponent);
  const bool same_odd = p.odd == q.odd;
  if (same_odd && p.exponent == q.exponent) {
    for (std::size_t i = 0; i < 3; ++i) {
      mpz_sub(result[i].get_mpz_t(), q.numerator[i].get_mpz_t(), p.numerator[i].get_mpz_t());
    }
    return;
  }
  if (same_odd) {
    of_p = of_q = 1;
  } else {
    set_common_factors(p.odd, q.odd, of_p, of_q);
  }
  shift_left(of_p, exponent - p.exponent);
  shift_left(of_q, exponent - q.exponent);
  for (std::size_t i = 0; i < 3; ++i) {
    mpz_mul(result[i].get_mpz_t(), q.numerator[i].get_mpz_t(), of_q.get_mpz_t());
    mpz_submul(result[i].get_mpz_t(), p.numerator[i].get_mpz_t(), of_p.get_mpz_t());
  }
}

void set_dot(Integer& result, const Vector& a, const Vector& b) {
  mpz_mul(result.get_mpz_t(), a[0].get_mpz_t(), b[0].get_mpz_t());
  mpz_addmul(result.get_mpz_t(), a[1].get_mpz_t(), b[1].get_mpz_t());
  mpz_addmul(result.get_mpz_t(), a[2].get_mpz_t(), b[2].get_mpz_t());
}

}  // namespace

PlaneForm plane_form_through(const PointView& p, const PointView& q, const PointView& r) {
  if (auto form = short_plane_form_through(p, q, r)) return *std::move(form);
  Scratch& s = scratch();
  auto& [a, b, c] = s.points;
  set_scaled(a, p, s.factor);
  set_scaled(b, q, s.factor);
  set_scaled(c, r, s.factor);
  set_direction(s.u, a, b, s.factor, s.other_factor);
  set_direction(s.v, a, c, s.factor, s.other_factor);
  shorten(s.u, s.factor);
  shorten(s.v, s.factor);
  PlaneForm form;
  Vector& normal = s.numerators;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const std::size_t k = (i + 2) % 3;
    mpz_mul(normal[i].get_mpz_t(), s.u[j].get_mpz_t(), s.v[k].get_mpz_t());
    mpz_submul(normal[i].get_mpz_t(), s.u[k].get_mpz_t(), s.v[j].get_mpz_t());
  }
  halve_while_even(normal);
  set_dot(s.at_p, normal, a.numerator);
  for (std::size_t i = 0; i < 3; ++i) form.normal[i] = normal[i];
  form.offset = s.at_p;
  form.odd = a.odd;
  form.exponent = a.exponent;
  return form;
}

PlaneForm plane_form_of(const Plane& plane) {
  return {{plane.a, plane.b, plane.c}, -plane.d, 1, 0};
}

namespace {

// p_i / (odd 2^exponent) - at_p d_i / (slope odd 2^exponent), where `numerator` is p_i, and at_p
// and slope > 0 have no common factor. In lowest terms: the common factor of the numerator
// slope p_i - at_p d_i and of slope is that of d_i and slope; what is left of slope has none with
// what is left of the numerator, which may have one with odd 2^exponent.
RationalView coordinate_of_line(Scratch& s, std::size_t i, const Integer& direction,
                                mp_bitcnt_t exponent) {
  Integer& x = s.numerators[i];
  Integer& w = s.denominators[i];
  mpz_mul(x.get_mpz_t(), s.slope.get_mpz_t(), x.get_mpz_t());
  mpz_submul(x.get_mpz_t(), s.at_p.get_mpz_t(), direction.get_mpz_t());
  if (x == 0) return {};
  if (direction == 1) {
    s.factor = 1;
  } else {
    set_gcd(s.factor, s.slope, direction);
  }
  if (s.factor == 1) {
    w = s.slope;
  } else {
    divide_exactly(x, s.factor);
    mpz_divexact(w.get_mpz_t(), s.slope.get_mpz_t(), s.factor.get_mpz_t());
  }
  const mp_bitcnt_t halvings = std::min(count_zeros(x), exponent);
  shift_right(x, halvings);
  if (s.common_odd != 1) {
    set_gcd(s.factor, x, s.common_odd);
    divide_exactly(x, s.factor);
    if (s.factor == 1) {
      multiply(w, s.common_odd);
    } else {
      mpz_divexact(s.factor.get_mpz_t(), s.common_odd.get_mpz_t(), s.factor.get_mpz_t());
      multiply(w, s.factor);
    }
  }
  shift_left(w, exponent - halvings);
  return view_of(x, w);
}

}  // namespace

PointView meeting_point_of_line(const PointView& p, const PointView& q, const PlaneForm& plane) {
  if (const auto met = short_meeting_point_of_line(p, q, plane)) return *met;
  Scratch& s = scratch();
  auto& from = s.points[0];
  auto& to = s.points[1];
  Vector& direction = s.u;
  set_scaled(from, p, s.factor);
  const std::array<bool, 3> along{!equal(p[0], q[0]), !equal(p[1], q[1]), !equal(p[2], q[2])};
  if (along[0] + along[1] + along[2] == 1) {
    for (std::size_t i = 0; i < 3; ++i) direction[i] = along[i] ? 1 : 0;
  } else {
    set_scaled(to, q, s.factor);
    set_direction(direction, from, to, s.factor, s.other_factor);
    shorten(direction, s.factor);
  }
  set_dot(s.slope, plane.normal, direction);
  set_dot(s.at_p, plane.normal, from.numerator);

  // p and the plane over one denominator, common_odd 2^exponent.
  const mp_bitcnt_t exponent = std::max(from.exponent, plane.exponent);
  shift_left(s.at_p, exponent - from.exponent);
  mpz_mul_2exp(s.other_factor.get_mpz_t(), plane.offset.get_mpz_t(), exponent - plane.exponent);
  const bool same_odd = from.odd == plane.odd;
  if (!same_odd) {
    multiply(s.at_p, plane.odd);
    multiply(s.other_factor, from.odd);
    s.common_odd = from.odd * plane.odd;
  } else {
    s.common_odd = from.odd;
  }
  s.at_p -= s.other_factor;

  set_gcd(s.factor, s.at_p, s.slope);
  if (s.slope < 0) s.factor = -s.factor;
  divide_exactly(s.at_p, s.factor);
  divide_exactly(s.slope, s.factor);

  const auto met = [&](std::size_t i) -> RationalView {
    if (direction[i] == 0) return p[i];
    mpz_mul_2exp(s.numerators[i].get_mpz_t(), from.numerator[i].get_mpz_t(),
                 exponent - from.exponent);
    if (!same_odd) multiply(s.numerators[i], plane.odd);
    return coordinate_of_line(s, i, direction[i], exponent);
  };
  return {met(0), met(1), met(2)};
}

}  // namespace exactcsg
