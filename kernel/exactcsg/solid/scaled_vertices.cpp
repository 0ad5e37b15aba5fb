// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/scaled_vertices.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <span>

#include "exactcsg/number/common_denominator.hpp"
#include "exactcsg/number/digits.hpp"
#include "exactcsg/number/limbs.hpp"

namespace exactcsg {

namespace {

using CoordinateRanges = std::array<CoordinateRange, 3>;

// An exponent e with every extent of the vertices below 2^e, and not much more.
long extent_exponent(const CoordinateRanges& ranges) {
  long exponent = -1000000;
  for (const CoordinateRange& range : ranges) {
    const Rational extent = range.highest - range.lowest;
    if (extent == 0) continue;
    exponent =
        std::max(exponent, static_cast<long>(mpz_sizeinbase(extent.get_num_mpz_t(), 2)) -
                               static_cast<long>(mpz_sizeinbase(extent.get_den_mpz_t(), 2)) + 1);
  }
  return exponent;
}

Rational power_of_two(long exponent) {
  Rational power = 1;
  if (exponent >= 0) {
    mpq_mul_2exp(power.get_mpq_t(), power.get_mpq_t(), static_cast<mp_bitcnt_t>(exponent));
  } else {
    mpq_div_2exp(power.get_mpq_t(), power.get_mpq_t(), static_cast<mp_bitcnt_t>(-exponent));
  }
  return power;
}

// floor(value * 2^shift)
Integer floor_shifted(const Rational& value, long shift) {
  Integer numerator = value.get_num();
  Integer denominator = value.get_den();
  if (shift >= 0) {
    numerator <<= static_cast<mp_bitcnt_t>(shift);
  } else {
    denominator <<= static_cast<mp_bitcnt_t>(-shift);
  }
  Integer result;
  mpz_fdiv_q(result.get_mpz_t(), numerator.get_mpz_t(), denominator.get_mpz_t());
  return result;
}

// Coordinates are non-negative and shorter than a result's limbs once the origin is subtracted, so
// that it is enough to know every number on the way but for multiples of 2^(64 limbs).
using Limbs = std::span<mp_limb_t>;

// Loops instead of calls: there are few limbs.
void set(Limbs result, LimbSpan value) {
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = i < value.size() ? value[i] : 0;
}

void subtract(Limbs from, const mp_limb_t* value) {
  mp_limb_t borrow = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const UnsignedInt128 difference = UnsignedInt128{from[i]} - value[i] - borrow;
    from[i] = static_cast<mp_limb_t>(difference);
    borrow = static_cast<mp_limb_t>(difference >> 127U);
  }
}

void negate(Limbs value) {
  mpn_neg(value.data(), value.data(), static_cast<mp_size_t>(value.size()));
}

void set(Limbs result, const Integer& value) {
  set(result, limbs_of(value));
  if (value < 0) negate(result);
}

// Room that grows when it has to.
class Room {
 public:
  mp_limb_t* of(std::size_t size) {
    if (limbs_.size() < size) limbs_.resize(size);
    return limbs_.data();
  }

 private:
  std::vector<mp_limb_t> limbs_;
};

// Division by a number of one limb that is divided by often. (N. Moeller and T. Granlund, Improved
// division by invariant integers, 2011, algorithm 4.)
class ShortDivisor {
 public:
  ShortDivisor() = default;
  explicit ShortDivisor(mp_limb_t divisor)
      : divisor_(divisor),
        shift_(std::countl_zero(divisor)),
        normalized_(divisor << shift_),
        // floor((2^128 - 1) / normalized) - 2^64
        reciprocal_(static_cast<mp_limb_t>(~(UnsignedInt128{normalized_} << 64U) / normalized_)) {}

  mp_limb_t divisor() const { return divisor_; }
  // Dividends are to be multiplied by 2^shift before.
  int shift() const { return shift_; }
  // Sets the quotient of that dividend, as many limbs. Whether nothing remains.
  bool divide(mp_limb_t* quotient, LimbSpan dividend) const {
    mp_limb_t rest = 0;
    for (std::size_t i = dividend.size(); i > 0; --i) quotient[i - 1] = step(rest, dividend[i - 1]);
    return rest == 0;
  }
  // The next limb of a quotient; `rest` is below the divisor times 2^shift, before and after.
  mp_limb_t step(mp_limb_t& rest, mp_limb_t dividend) const {
    const UnsignedInt128 estimate =
        UnsignedInt128{reciprocal_} * rest + (UnsignedInt128{rest} << 64U | dividend);
    mp_limb_t digit = static_cast<mp_limb_t>(estimate >> 64U) + 1;
    rest = dividend - digit * normalized_;
    if (rest > static_cast<mp_limb_t>(estimate)) {
      --digit;
      rest += normalized_;
    }
    if (rest >= normalized_) {
      ++digit;
      rest -= normalized_;
    }
    return digit;
  }

 private:
  mp_limb_t divisor_ = 0;
  int shift_ = 0;
  mp_limb_t normalized_ = 0;
  mp_limb_t reciprocal_ = 0;
};

// Numbers times a power of two, cut to integers.
class GridScaling {
 public:
  explicit GridScaling(long shift) : shift_(shift) {}

  void operator()(Limbs result, const RationalView& value) {
    if (result.size() == 2 && !value.is_zero()) {
      auto quotient = short_quotient(value);
      if (!quotient) quotient = quotient_of_heads(value);
      if (quotient) {
        const UnsignedInt128 magnitude = UnsignedInt128{quotient->high} << 64U | quotient->low;
        // -(q + rest) is between -q - 1 and -q.
        const UnsignedInt128 scaled =
            value.negative ? -magnitude - (quotient->whole ? 0 : 1) : magnitude;
        result[0] = static_cast<mp_limb_t>(scaled);
        result[1] = static_cast<mp_limb_t>(scaled >> 64U);
        return;
      }
    }
    const bool whole = set_magnitude(result, value);
    if (!value.negative) return;
    negate(result);
    // -(q + rest) is between -q - 1 and -q.
    if (!whole) mpn_sub_1(result.data(), result.data(), static_cast<mp_size_t>(result.size()), 1);
  }

 private:
  // Of a magnitude. `whole` says that nothing was cut off.
  struct Cut {
    LimbSpan limbs;
    bool whole = true;
  };

  // The lowest two limbs of a quotient.
  struct ShortQuotient {
    mp_limb_t low = 0;
    mp_limb_t high = 0;
    bool whole = true;
  };

  // Of the numbers that most vertices have: at most two limbs above one limb times a power of two,
  // shifted upwards by less than two limbs.
  std::optional<ShortQuotient> short_quotient(const RationalView& value) {
    const LimbSpan divisor = value.denominator;
    if (value.numerator.size() > 2 || divisor.empty()) return std::nullopt;
    const long zeros = count_low_zeros(divisor);
    const auto whole = static_cast<std::size_t>(zeros) / GMP_NUMB_BITS;
    if (divisor.size() > whole + 2) return std::nullopt;
    const mp_limb_t above = whole + 1 < divisor.size() ? divisor[whole + 1] : 0;
    const UnsignedInt128 odd = (UnsignedInt128{above} << 64U | divisor[whole]) >>
                               static_cast<unsigned>(zeros % GMP_NUMB_BITS);
    if (odd >> 64U != 0) return std::nullopt;
    const ShortDivisor& by = short_divisor(static_cast<mp_limb_t>(odd));
    const long shift = shift_ - zeros + by.shift();
    if (shift < 0 || shift >= 2 * GMP_NUMB_BITS) return std::nullopt;
    const mp_limb_t high = value.numerator.size() == 2 ? value.numerator[1] : 0;
    const auto bits = static_cast<unsigned>(shift) % GMP_NUMB_BITS;
    const UnsignedInt128 low = (UnsignedInt128{high} << 64U | value.numerator[0]) << bits;
    const mp_limb_t top = high >> 1U >> (63 - bits);
    mp_limb_t rest = 0;
    if (top != 0) by.step(rest, top);
    ShortQuotient quotient;
    quotient.high = by.step(rest, static_cast<mp_limb_t>(low >> 64U));
    quotient.low = by.step(rest, static_cast<mp_limb_t>(low));
    if (shift >= GMP_NUMB_BITS) {
      quotient.high = quotient.low;
      quotient.low = by.step(rest, 0);
    }
    quotient.whole = rest == 0;
    return quotient;
  }

  // The first 128 bits of a magnitude, the first of them set, the lower limb first.
  struct LongHead {
    std::array<mp_limb_t, 2> limbs{};
    long length = 0;  // of the whole, in bits
  };

  static LongHead long_head(LimbSpan value) {
    const std::size_t size = value.size();
    const auto limb = [&](std::size_t i) { return i <= size ? value[size - i] : 0; };
    const int zeros = std::countl_zero(limb(1));
    const auto joined = [&](mp_limb_t high, mp_limb_t low) {
      return high << zeros | low >> 1U >> (63 - zeros);
    };
    return {{joined(limb(2), limb(3)), joined(limb(1), limb(2))},
            static_cast<long>(size) * GMP_NUMB_BITS - zeros};
  }

  // Of long numbers, if it is certain where they are cut. With n and d the heads of numerator and
  // denominator as integers, cut by less than 1, value 2^shift is n / d 2^e, e the difference of
  // the lengths and the shift, and n / d is between 1/2 and 2; f = floor(n 2^126 / d) is at most
  // 1 above and 2 below value 2^shift 2^(126 - e).
  std::optional<ShortQuotient> quotient_of_heads(const RationalView& value) {
    if (value.denominator.empty()) return std::nullopt;
    const LongHead n = long_head(value.numerator);
    const LongHead d = long_head(value.denominator);
    const long e = n.length - d.length + shift_;
    constexpr long bits = 126;
    constexpr long most = bits - 12;
    if (e < 0 || e > most) return std::nullopt;
    // n 2^128, that is, two bits more.
    const std::array<mp_limb_t, 4> dividend{0, 0, n.limbs[0], n.limbs[1]};
    std::array<mp_limb_t, 3> quotient{};
    std::array<mp_limb_t, 2> remainder{};
    mpn_tdiv_qr(quotient.data(), remainder.data(), 0, dividend.data(), 4, d.limbs.data(), 2);
    const UnsignedInt128 f = (UnsignedInt128{quotient[1]} << 64U | quotient[0]) >> 2U |
                             UnsignedInt128{quotient[2]} << bits;
    const auto cut = static_cast<unsigned>(bits - e);
    constexpr unsigned margin = 8;
    const UnsignedInt128 result = f >> cut;
    if ((f + margin) >> cut != result || f < margin || (f - margin) >> cut != result) {
      return std::nullopt;
    }
    return ShortQuotient{static_cast<mp_limb_t>(result), static_cast<mp_limb_t>(result >> 64U),
                         false};
  }

  // Whether nothing was cut off.
  bool set_magnitude(Limbs result, const RationalView& value) {
    if (value.is_zero()) {
      set(result, LimbSpan());
      return true;
    }
    if (value.has_binary_denominator()) {
      const Cut cut = shifted(value.numerator, shift_ - static_cast<long>(value.exponent));
      set(result, cut.limbs);
      return cut.whole;
    }
    // Of decimals and doubles the odd part is short.
    const LimbSpan divisor = value.denominator;
    const long zeros = count_low_zeros(divisor);
    if (head_of(divisor).length - zeros <= GMP_NUMB_BITS) {
      const ShortDivisor& odd = short_divisor(shifted_limb(divisor, zeros));
      return set_quotient(result, shifted(value.numerator, shift_ - zeros + odd.shift()), odd);
    }
    if (shift_ >= 0) {
      return set_quotient(result, shifted(value.numerator, shift_).limbs, divisor);
    }
    return set_quotient(result, value.numerator, shifted(divisor, -shift_).limbs);
  }

  // value / 2^zeros, which has one limb.
  static mp_limb_t shifted_limb(LimbSpan value, long zeros) {
    const auto whole = static_cast<std::size_t>(zeros) / GMP_NUMB_BITS;
    const auto rest = static_cast<unsigned>(zeros % GMP_NUMB_BITS);
    const mp_limb_t low = value[whole] >> rest;
    if (rest == 0 || whole + 1 == value.size()) return low;
    return low | value[whole + 1] << (GMP_NUMB_BITS - rest);
  }

  const ShortDivisor& short_divisor(mp_limb_t divisor) {
    constexpr mp_limb_t spread = 0x9e3779b97f4a7c15U;
    ShortDivisor& known = divisors_[divisor * spread >> 60U];
    if (known.divisor() != divisor) known = ShortDivisor(divisor);
    return known;
  }

  // The numerator may have been cut: what is cut off twice is cut off as by one division.
  bool set_quotient(Limbs result, const Cut& numerator, const ShortDivisor& divisor) {
    mp_limb_t* const quotient = quotient_.of(numerator.limbs.size());
    const bool divides = divisor.divide(quotient, numerator.limbs);
    set(result, {quotient, numerator.limbs.size()});
    return numerator.whole && divides;
  }

  bool set_quotient(Limbs result, LimbSpan numerator, LimbSpan divisor) {
    if (numerator.size() < divisor.size()) {
      set(result, LimbSpan());
      return false;
    }
    const std::size_t size = numerator.size() - divisor.size() + 1;
    mp_limb_t* const quotient = quotient_.of(size);
    mp_limb_t* const remainder = remainder_.of(divisor.size());
    mpn_tdiv_qr(quotient, remainder, 0, numerator.data(), static_cast<mp_size_t>(numerator.size()),
                divisor.data(), static_cast<mp_size_t>(divisor.size()));
    set(result, {quotient, size});
    return mpn_zero_p(remainder, static_cast<mp_size_t>(divisor.size())) != 0;
  }

  // value * 2^shift, no leading zero. Until it is called again.
  Cut shifted(LimbSpan value, long shift) {
    if (shift < 0) return shifted_down(value, -shift);
    const auto whole = static_cast<std::size_t>(shift) / GMP_NUMB_BITS;
    const auto rest = static_cast<unsigned>(shift % GMP_NUMB_BITS);
    mp_limb_t* const begin = shifted_.of(value.size() + whole + 1);
    for (std::size_t i = 0; i < whole; ++i) begin[i] = 0;
    mp_limb_t* const to = begin + whole;
    to[value.size()] = 0;
    if (rest == 0) {
      std::copy_n(value.data(), value.size(), to);
    } else {
      to[value.size()] = mpn_lshift(to, value.data(), static_cast<mp_size_t>(value.size()), rest);
    }
    return {LimbSpan(begin, whole + value.size() + (to[value.size()] == 0 ? 0 : 1))};
  }

  Cut shifted_down(LimbSpan value, long shift) {
    const auto whole = static_cast<std::size_t>(shift) / GMP_NUMB_BITS;
    const auto rest = static_cast<unsigned>(shift % GMP_NUMB_BITS);
    if (whole >= value.size()) return {{}, false};
    const LimbSpan kept = value.subspan(whole);
    mp_limb_t cut = 0;
    for (std::size_t i = 0; i < whole; ++i) cut |= value[i];
    if (rest == 0) return {kept, cut == 0};
    mp_limb_t* const to = shifted_.of(kept.size());
    cut |= mpn_rshift(to, kept.data(), static_cast<mp_size_t>(kept.size()), rest);
    return {LimbSpan(to, kept.size() - (to[kept.size() - 1] == 0 ? 1 : 0)), cut == 0};
  }

  long shift_;
  std::array<ShortDivisor, 16> divisors_;  // by the upper bits of a hash
  Room shifted_;
  Room quotient_;
  Room remainder_;
};

// Numbers times a common denominator of theirs.
class ExactScaling {
 public:
  explicit ExactScaling(const Integer& common) : common_(common) {}

  void operator()(Limbs result, const RationalView& value) {
    if (value.is_zero()) {
      set(result, LimbSpan());
      return;
    }
    if (!equal_denominators(value, last_)) {
      last_ = value;
      set_factor(value);
    }
    mpz_t numerator;
    mpz_mul(product_.get_mpz_t(), factor_.get_mpz_t(),
            mpz_roinit_n(numerator, value.numerator.data(),
                         static_cast<mp_size_t>(value.numerator.size())));
    set(result, product_);
    if (value.negative) negate(result);
  }

 private:
  void set_factor(const RationalView& value) {
    if (value.has_binary_denominator()) {
      mpz_tdiv_q_2exp(factor_.get_mpz_t(), common_.get_mpz_t(), value.exponent);
      return;
    }
    set_denominator(denominator_, value);
    mpz_divexact(factor_.get_mpz_t(), common_.get_mpz_t(), denominator_.get_mpz_t());
  }

  const Integer& common_;
  RationalView last_;
  Integer factor_ = common_;  // that common_ is of the last one's denominator
  Integer denominator_;
  Integer product_;
};

// `scaled(rational)` is an Integer, monotone; `set_scaled(limbs, view)` sets the limbs to the same.
template <class Scaled, class SetScaled>
void fill(ScaledVertices& s, const Boundary& boundary, const CoordinateRanges& ranges,
          const Scaled& scaled, SetScaled set_scaled) {
  std::array<Integer, 3> lowest;
  for (std::size_t i = 0; i < 3; ++i) {
    lowest[i] = scaled(ranges[i].lowest);
    const Integer extent = scaled(ranges[i].highest) - lowest[i];
    if (extent > s.largest) s.largest = extent;
  }
  s.origin = {lowest[0] * s.unit, lowest[1] * s.unit, lowest[2] * s.unit};
  s.width = (mpz_sizeinbase(s.largest.get_mpz_t(), 2) + 2 + 59) / 60;
  s.limbs.resize(3 * s.width * boundary.vertices.size());
  std::vector<mp_limb_t> origin(3 * s.width);
  for (std::size_t i = 0; i < 3; ++i) set(Limbs(origin).subspan(i * s.width, s.width), lowest[i]);
  mp_limb_t* to = s.limbs.data();
  PointView last;
  for (std::size_t v = 0; v < boundary.vertices.size(); ++v) {
    const PointView vertex = boundary.vertices.view(v);
    for (std::size_t i = 0; i < 3; ++i, to += s.width) {
      // Neighbours in lexicographic order often have coordinates in common.
      if (v > 0 && equal(vertex[i], last[i])) {
        std::copy_n(to - 3 * s.width, s.width, to);
        continue;
      }
      set_scaled(Limbs(to, s.width), vertex[i]);
      subtract(Limbs(to, s.width), origin.data() + i * s.width);
    }
    last = vertex;
  }
}

}  // namespace

// Rounding to nearest is monotone: only equal doubles leave the order open.
CoordinateRange coordinate_range(const Boundary& boundary, std::size_t axis) {
  const bool has_doubles = boundary.approximate.size() == boundary.vertices.size();
  double least = 0;
  double greatest = 0;
  if (has_doubles) {
    least = greatest = boundary.approximate.front()[axis];
    for (const std::array<double, 3>& vertex : boundary.approximate) {
      least = std::min(least, vertex[axis]);
      greatest = std::max(greatest, vertex[axis]);
    }
  }
  std::optional<RationalView> lowest;
  std::optional<RationalView> highest;
  for (std::size_t v = 0; v < boundary.vertices.size(); ++v) {
    const bool may_be_lowest = !has_doubles || boundary.approximate[v][axis] == least;
    const bool may_be_highest = !has_doubles || boundary.approximate[v][axis] == greatest;
    if (!may_be_lowest && !may_be_highest) continue;
    const RationalView exact = boundary.vertices.view(v)[axis];
    if (may_be_lowest && (!lowest || compare(exact, *lowest) < 0)) lowest = exact;
    if (may_be_highest && (!highest || compare(*highest, exact) < 0)) highest = exact;
  }
  return {rational_of(*lowest), rational_of(*highest)};
}

bool has_short_common_denominator(const Boundary& boundary) {
  return short_common_denominator(boundary.vertices).has_value();
}

ScaledVertices scale_vertices(const Boundary& boundary, int bits) {
  ScaledVertices s;
  if (boundary.vertices.empty()) {
    s.unit = 1;
    s.exact = true;
    return s;
  }
  const CoordinateRanges ranges{coordinate_range(boundary, 0), coordinate_range(boundary, 1),
                                coordinate_range(boundary, 2)};
  if (const std::optional<Integer> common = short_common_denominator(boundary.vertices)) {
    s.exact = true;
    s.unit = Rational(Integer(1), *common);
    const auto scaled = [&](const Rational& value) {
      Integer result;
      set_scaled(result, value, *common);
      return result;
    };
    fill(s, boundary, ranges, scaled, ExactScaling(*common));
  } else {
    const long shift = bits - extent_exponent(ranges);
    s.unit = power_of_two(-shift);
    fill(
        s, boundary, ranges, [shift](const Rational& value) { return floor_shifted(value, shift); },
        GridScaling(shift));
  }
  return s;
}

void set_coordinates(std::array<Integer, 3>& result, const ScaledVertices& vertices,
                     std::uint32_t vertex) {
  const mp_limb_t* from = vertices.of(vertex);
  for (Integer& coordinate : result) {
    mp_limb_t* const to =
        mpz_limbs_write(coordinate.get_mpz_t(), static_cast<mp_size_t>(vertices.width));
    std::copy_n(from, vertices.width, to);
    mpz_limbs_finish(coordinate.get_mpz_t(), static_cast<mp_size_t>(vertices.width));
    from += vertices.width;
  }
}

}  // namespace exactcsg
