// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/number/rational_view.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>

#include "exactcsg/number/limbs.hpp"

namespace exactcsg {

namespace {

__extension__ using Wide = unsigned __int128;

void assign_magnitude(mpz_ptr result, LimbSpan limbs) {
  const auto size = static_cast<mp_size_t>(limbs.size());
  if (size == 0) {
    mpz_set_ui(result, 0);
    return;
  }
  std::copy(limbs.begin(), limbs.end(), mpz_limbs_write(result, size));
  mpz_limbs_finish(result, size);
}

void assign_denominator(mpz_ptr result, const RationalView& value) {
  if (value.has_binary_denominator()) {
    mpz_set_ui(result, 1);
    mpz_mul_2exp(result, result, value.exponent);
  } else {
    assign_magnitude(result, value.denominator);
  }
}

Head head_of_denominator(const RationalView& value) {
  if (!value.has_binary_denominator()) return head_of(value.denominator);
  return {std::uint64_t{1} << 63U, static_cast<long>(value.exponent) + 1};
}

// bits * 2^length, the first bit set.
struct Product {
  Wide bits;
  long length;
};

Product operator*(const Head& a, const Head& b) {
  Product product{Wide{a.bits} * b.bits, a.length + b.length};
  if (product.bits >> 127U == 0) {
    product.bits <<= 1U;
    --product.length;
  }
  return product;
}

// |a| * denominator of b, as an Integer.
void assign_cross_product(Integer& result, const RationalView& a, const RationalView& b) {
  const auto size = static_cast<mp_size_t>(a.numerator.size());
  mpz_t numerator;
  mpz_srcptr factor = mpz_roinit_n(numerator, a.numerator.data(), size);
  if (b.has_binary_denominator()) {
    mpz_mul_2exp(result.get_mpz_t(), factor, b.exponent);
    return;
  }
  mpz_t denominator;
  mpz_mul(result.get_mpz_t(), factor,
          mpz_roinit_n(denominator, b.denominator.data(),
                       static_cast<mp_size_t>(b.denominator.size())));
}

// A loop: there are few limbs.
bool equal_limbs(LimbSpan a, LimbSpan b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] != b[i]) return false;
  }
  return true;
}

std::strong_ordering compare_magnitudes(LimbSpan a, LimbSpan b) {
  if (a.size() != b.size()) return a.size() <=> b.size();
  return mpn_cmp(a.data(), b.data(), static_cast<mp_size_t>(a.size())) <=> 0;
}

// REQUIRES neither is zero
std::strong_ordering compare_magnitudes(const RationalView& a, const RationalView& b) {
  if (equal_denominators(a, b)) return compare_magnitudes(a.numerator, b.numerator);
  // Heads are cut by less than one, so that a product's bits, as they are made to begin with a one,
  // are cut by less than 2 (2^64 + 2^64 + 1).
  constexpr Wide margin = Wide{1} << 67U;
  const Product mine = head_of(a.numerator) * head_of_denominator(b);
  const Product other = head_of(b.numerator) * head_of_denominator(a);
  const auto exceeds = [](const Product& p, const Product& q) {
    if (p.length == q.length) return p.bits > q.bits && p.bits - q.bits > margin;
    // A product that is nearly a power of two may reach it with what was cut off.
    return p.length > q.length + 1 || (p.length > q.length && q.bits < Wide{0} - margin);
  };
  if (exceeds(mine, other)) return std::strong_ordering::greater;
  if (exceeds(other, mine)) return std::strong_ordering::less;
  thread_local Integer left;
  thread_local Integer right;
  assign_cross_product(left, a, b);
  assign_cross_product(right, b, a);
  return cmp(left, right) <=> 0;
}

}  // namespace

RationalView view_of(const Integer& numerator, const Integer& denominator) {
  RationalView view;
  view.numerator = limbs_of(numerator);
  view.negative = sgn(numerator) < 0;
  const LimbSpan limbs = limbs_of(denominator);
  constexpr std::size_t longest_exponent = std::size_t{1} << 31U;
  if (is_power_of_two(limbs) && limbs.size() <= longest_exponent / GMP_NUMB_BITS) {
    view.exponent = GMP_NUMB_BITS * (limbs.size() - 1) +
                    static_cast<mp_bitcnt_t>(std::countr_zero(limbs.back()));
  } else {
    view.denominator = limbs;
  }
  return view;
}

RationalView view_of(const Rational& value) { return view_of(value.get_num(), value.get_den()); }

PointView view_of(const Point3& point) {
  return {view_of(point.x), view_of(point.y), view_of(point.z)};
}

void assign(Rational& result, const RationalView& value) {
  assign_magnitude(result.get_num_mpz_t(), value.numerator);
  if (value.negative) mpz_neg(result.get_num_mpz_t(), result.get_num_mpz_t());
  assign_denominator(result.get_den_mpz_t(), value);
}

Rational rational_of(const RationalView& value) {
  Rational result;
  assign(result, value);
  return result;
}

Point3 point_of(const PointView& point) {
  return {rational_of(point[0]), rational_of(point[1]), rational_of(point[2])};
}

void set_denominator(Integer& result, const RationalView& value) {
  assign_denominator(result.get_mpz_t(), value);
}

// Different numbers mostly differ in the numerator's lowest limb already.
bool equal(const RationalView& a, const RationalView& b) {
  return a.negative == b.negative && equal_limbs(a.numerator, b.numerator) &&
         equal_denominators(a, b);
}

bool equal_denominators(const RationalView& a, const RationalView& b) {
  return a.exponent == b.exponent && equal_limbs(a.denominator, b.denominator);
}

std::strong_ordering compare(const RationalView& a, const RationalView& b) {
  if (a.negative != b.negative) return b.negative <=> a.negative;
  if (a.is_zero() || b.is_zero()) return a.numerator.size() <=> b.numerator.size();
  return a.negative ? compare_magnitudes(b, a) : compare_magnitudes(a, b);
}

std::strong_ordering compare(const PointView& p, const PointView& q) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::strong_ordering order = compare(p[axis], q[axis]);
    if (order != 0) return order;
  }
  return std::strong_ordering::equal;
}

}  // namespace exactcsg
