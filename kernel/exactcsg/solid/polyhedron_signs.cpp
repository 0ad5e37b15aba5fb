// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/polyhedron_signs.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>

#include "exactcsg/number/common_denominator.hpp"
#include "exactcsg/number/exact_tiers.hpp"

namespace exactcsg {

namespace {

__extension__ using Wide = __int128;

constexpr double ulp = std::numeric_limits<double>::epsilon();  // 2^-52, twice the unit roundoff
// Outside of this range of differences a product of three could leave the normal doubles.
constexpr double smallest_difference = 1e-70;
constexpr double largest_difference = 1e70;
constexpr std::size_t small_bits = 40;
constexpr std::size_t double_bits = std::numeric_limits<double>::digits;

double error_of_rounding(double largest) {
  return ulp * largest + std::numeric_limits<double>::min();
}

Sign sign_of_wide(Wide value) {
  return value > 0 ? Sign::Positive : value < 0 ? Sign::Negative : Sign::Zero;
}

struct Differences {
  std::array<double, 3> entries;
  double largest;
};

Differences differences(const std::array<double, 3>& from, const std::array<double, 3>& to) {
  Differences d{{to[0] - from[0], to[1] - from[1], to[2] - from[2]}, 0};
  d.largest = std::max({std::abs(d.entries[0]), std::abs(d.entries[1]), std::abs(d.entries[2])});
  return d;
}

}  // namespace

PolyhedronSigns::PolyhedronSigns(std::span<const Point3> points) {
  approximate_.reserve(points.size());
  const std::optional<Integer> common = short_common_denominator(points);
  if (!common || !set_small(points, *common)) set_long(points, common);
  point_error_ = coordinate_error_;
}

// Numerators and denominators are exact doubles, and one IEEE division rounds correctly.
bool PolyhedronSigns::set_small(std::span<const Point3> points, const Integer& common) {
  if (mpz_sizeinbase(common.get_mpz_t(), 2) > double_bits) return false;
  const std::uint64_t denominator = common.get_ui();
  small_.reserve(points.size());
  std::uint64_t all_magnitudes = 0;
  double largest = 0;
  for (const Point3& p : points) {
    std::array<std::int64_t, 3> scaled{};
    std::array<double, 3> rounded{};
    for (CoordinateIndex i = 0; i < 3; ++i) {
      const Rational& value = coordinate(p, i);
      std::uint64_t magnitude = mpz_get_ui(value.get_num_mpz_t());
      const bool fits =
          mpz_size(value.get_num_mpz_t()) <= 1 &&
          !__builtin_mul_overflow(magnitude, denominator / mpz_get_ui(value.get_den_mpz_t()),
                                  &magnitude) &&
          magnitude >> small_bits == 0;
      if (!fits) {
        small_.clear();
        approximate_.clear();
        return false;
      }
      all_magnitudes |= magnitude;
      scaled[i] = static_cast<std::int64_t>(magnitude);
      if (sgn(value) < 0) scaled[i] = -scaled[i];
      rounded[i] = static_cast<double>(scaled[i]) / static_cast<double>(denominator);
      largest = std::max(largest, std::abs(rounded[i]));
    }
    small_.push_back(scaled);
    approximate_.push_back(rounded);
  }
  numerator_bits_ = static_cast<std::size_t>(std::bit_width(all_magnitudes));
  weight_bits_ = 1;
  coordinate_error_ = std::has_single_bit(denominator) ? 0 : error_of_rounding(largest);
  return true;
}

void PolyhedronSigns::set_long(std::span<const Point3> points,
                               const std::optional<Integer>& common) {
  bool exactly_doubles = true;
  double largest = 0;
  exact_.reserve(points.size());
  weight_.reserve(points.size());
  for (const Point3& p : points) {
    std::array<double, 3> rounded{};
    for (CoordinateIndex i = 0; i < 3; ++i) {
      const Rational& value = coordinate(p, i);
      rounded[i] = nearest_double(value);
      largest = std::max(largest, std::abs(rounded[i]));
      exactly_doubles = exactly_doubles && std::isfinite(rounded[i]) && rounded[i] == value;
    }
    approximate_.push_back(rounded);
    Integer own = 1;
    if (!common) {
      unit_weights_ = false;
      own = lcm(lcm(p.x.get_den(), p.y.get_den()), p.z.get_den());
    }
    Exact scaled;
    for (CoordinateIndex i = 0; i < 3; ++i) {
      set_scaled(scaled[i], coordinate(p, i), common ? *common : own);
    }
    append(scaled, own);
  }
  coordinate_error_ = exactly_doubles ? 0 : error_of_rounding(largest);
}

void PolyhedronSigns::append(const Exact& numerators, const Integer& weight) {
  for (const Integer& n : numerators) {
    numerator_bits_ = std::max(numerator_bits_, mpz_sizeinbase(n.get_mpz_t(), 2));
  }
  weight_bits_ = std::max(weight_bits_, mpz_sizeinbase(weight.get_mpz_t(), 2));
  exact_.push_back(numerators);
  weight_.push_back(weight);
}

PolyhedronSigns::Index PolyhedronSigns::add_mean(
    std::span<const std::pair<Index, unsigned>> weighted) {
  // sum of k_i X_i / w_i over sum of k_i, with one common denominator
  Integer denominator = 1;
  unsigned long total = 0;
  for (const auto& [index, k] : weighted) {
    denominator = lcm(denominator, weight<Integer>(index));
    total += k;
  }
  Exact sum{0, 0, 0};
  std::array<double, 3> approximate{};
  for (const auto& [index, k] : weighted) {
    const Integer factor = denominator / weight<Integer>(index) * k;
    for (CoordinateIndex i = 0; i < 3; ++i) {
      sum[i] += numerator<Integer>(index, i) * factor;
      approximate[i] += approximate_[index][i] * static_cast<double>(k);
    }
  }
  double largest = 0;
  for (double& a : approximate) {
    a /= static_cast<double>(total);
    largest = std::max(largest, std::abs(a));
  }
  // A mean of values with error e has error e; the sums and the quotient round once each, relative
  // to at most the largest magnitude summed up.
  for (const auto& [index, k] : weighted) {
    for (const double a : approximate_[index]) largest = std::max(largest, std::abs(a));
  }
  const double rounding = 2 * static_cast<double>(weighted.size() + 2) * ulp * largest +
                          std::numeric_limits<double>::min();
  coordinate_error_ = std::max(coordinate_error_, point_error_ + rounding);
  append(sum, denominator * total);
  approximate_.push_back(approximate);
  unit_weights_ = false;
  return static_cast<Index>(approximate_.size() - 1);
}

template <class Integral>
Integral PolyhedronSigns::numerator(Index point, CoordinateIndex i) const {
  return point < small_.size() ? Integral(small_[point][i])
                               : integer_from<Integral>(exact_[point - small_.size()][i]);
}

template <class Integral>
Integral PolyhedronSigns::weight(Index point) const {
  return point < small_.size() ? Integral(std::int64_t{1})
                               : integer_from<Integral>(weight_[point - small_.size()]);
}

bool PolyhedronSigns::have_equal_weights(Index p, Index q) const {
  if (unit_weights_ || std::max(p, q) < small_.size()) return true;
  if (std::min(p, q) < small_.size()) return false;
  return weight_[p - small_.size()] == weight_[q - small_.size()];
}

template <class Integral>
std::array<Integral, 3> PolyhedronSigns::difference(Index from, Index to) const {
  const auto unweighted = [&](CoordinateIndex i) -> Integral {
    return numerator<Integral>(to, i) - numerator<Integral>(from, i);
  };
  if (have_equal_weights(from, to)) {
    return {unweighted(0), unweighted(1), unweighted(2)};
  }
  const auto head = weight<Integral>(from);
  const auto tail = weight<Integral>(to);
  const auto entry = [&](CoordinateIndex i) -> Integral {
    return numerator<Integral>(to, i) * head - numerator<Integral>(from, i) * tail;
  };
  return {entry(0), entry(1), entry(2)};
}

bool PolyhedronSigns::fits_stack(std::size_t factors) const {
  const std::size_t entry_bits = numerator_bits_ + weight_bits_ + 1;
  return factors * entry_bits + 3 <= static_cast<std::size_t>(wide_bits);
}

Sign PolyhedronSigns::along_normal(Index a, Index b, Index c, Index p, Index q) const {
  const Differences u = differences(approximate_[a], approximate_[b]);
  const Differences v = differences(approximate_[a], approximate_[c]);
  const Differences w = differences(approximate_[p], approximate_[q]);
  const double largest = std::max({u.largest, v.largest, w.largest});
  // Every entry is off by at most e (two coordinate errors and one rounding). The determinant is a
  // sum of 6 products of 3 entries: off by at most 6 (3 D^2 e + 3 D e^2 + e^3) <= 18.6 D^2 e for
  // e <= D / 100, and its evaluation rounds each product at most 5 times, 6 * 5 * (u / 2) D^3 with
  // u = 2^-52; rounded up generously.
  const double e = 2 * coordinate_error_ + ulp * largest;
  if (largest > smallest_difference && largest < largest_difference && e <= largest / 128) {
    const auto& [ux, uy, uz] = u.entries;
    const auto& [vx, vy, vz] = v.entries;
    const auto& [wx, wy, wz] = w.entries;
    const double determinant =
        (uy * vz - uz * vy) * wx + (uz * vx - ux * vz) * wy + (ux * vy - uy * vx) * wz;
    const double bound = largest * largest * (20 * e + 32 * ulp * largest);
    if (determinant > bound) return Sign::Positive;
    if (determinant < -bound) return Sign::Negative;
  }
  if (std::max({a, b, c, p, q}) < small_.size()) {
    std::array<std::array<Wide, 3>, 3> m;
    const std::array<std::array<Index, 2>, 3> rows{{{a, b}, {a, c}, {p, q}}};
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t i = 0; i < 3; ++i) {
        m[r][i] = Wide{small_[rows[r][1]][i]} - small_[rows[r][0]][i];
      }
    }
    // Entries below 2^41, minors below 2^83, the sum below 2^126.
    return sign_of_wide((m[0][1] * m[1][2] - m[0][2] * m[1][1]) * m[2][0] +
                        (m[0][2] * m[1][0] - m[0][0] * m[1][2]) * m[2][1] +
                        (m[0][0] * m[1][1] - m[0][1] * m[1][0]) * m[2][2]);
  }
  const auto exactly = [&]<class Integral>(Integral) {
    const auto x = difference<Integral>(a, b);
    const auto y = difference<Integral>(a, c);
    const auto z = difference<Integral>(p, q);
    const Integral determinant = (x[1] * y[2] - x[2] * y[1]) * z[0] +
                                 (x[2] * y[0] - x[0] * y[2]) * z[1] +
                                 (x[0] * y[1] - x[1] * y[0]) * z[2];
    return sign_of(determinant);
  };
  return fits_stack(3) ? exactly(WideInteger()) : exactly(Integer());
}

PolyhedronSigns::NearPlane PolyhedronSigns::near_plane(Index a, Index b, Index c) const {
  const Differences u = differences(approximate_[a], approximate_[b]);
  const Differences v = differences(approximate_[a], approximate_[c]);
  const auto& [ux, uy, uz] = u.entries;
  const auto& [vx, vy, vz] = v.entries;
  NearPlane plane{approximate_[a],
                  {uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx},
                  std::numeric_limits<double>::infinity(),
                  0};
  const double largest = std::max(u.largest, v.largest);
  const double e = 2 * coordinate_error_ + ulp * largest;
  if (!(largest > smallest_difference && largest < largest_difference && e <= largest / 128)) {
    return plane;
  }
  // With D = largest, r = 2^-52 and c = coordinate_error_: entries of the normal, at most 2.01 D^2,
  // are off by at most n = D (5 e + 4 r D), as in turn(); those of the vector w to the point by
  // 2 c + r W if none is above W. The product is off by at most
  //   3 n (W + 2 c + r W) + 3 * 2.01 D^2 (2 c + r W)
  // and its evaluation rounds each of three terms at most three times, 9.1 r D^2 W in all. By
  // n <= 0.04 D^2 that is less than W (3.1 n + 16 r D^2) + 12.4 c D^2; what underflows is less than
  // the least normal number.
  const double off = largest * (5 * e + 4 * ulp * largest);
  plane.slope = 3.2 * off + 20 * ulp * largest * largest;
  plane.offset = 13 * coordinate_error_ * largest * largest + std::numeric_limits<double>::min();
  return plane;
}

Sign PolyhedronSigns::turn(CoordinateIndex dropped, Index a, Index b, Index c) const {
  const CoordinateIndex i = (dropped + 1) % 3;
  const CoordinateIndex j = (dropped + 2) % 3;
  const auto& p = approximate_[a];
  const double ui = approximate_[b][i] - p[i];
  const double uj = approximate_[b][j] - p[j];
  const double vi = approximate_[c][i] - p[i];
  const double vj = approximate_[c][j] - p[j];
  const double largest = std::max({std::abs(ui), std::abs(uj), std::abs(vi), std::abs(vj)});
  const double e = 2 * coordinate_error_ + ulp * largest;
  if (largest > smallest_difference && largest < largest_difference && e <= largest / 128) {
    const double value = ui * vj - uj * vi;
    // 2 (2 D e + e^2) from the entries, 2 * 2 * (u / 2) D^2 from the evaluation.
    const double bound = largest * (5 * e + 4 * ulp * largest);
    if (value > bound) return Sign::Positive;
    if (value < -bound) return Sign::Negative;
  }
  if (std::max({a, b, c}) < small_.size()) {
    const auto& o = small_[a];
    const auto& s = small_[b];
    const auto& t = small_[c];
    return sign_of_wide(Wide{s[i] - o[i]} * (t[j] - o[j]) - Wide{s[j] - o[j]} * (t[i] - o[i]));
  }
  const auto exactly = [&]<class Integral>(Integral) {
    const auto x = difference<Integral>(a, b);
    const auto y = difference<Integral>(a, c);
    const Integral value = x[i] * y[j] - x[j] * y[i];
    return sign_of(value);
  };
  return fits_stack(2) ? exactly(WideInteger()) : exactly(Integer());
}

bool PolyhedronSigns::collinear(Index a, Index b, Index c) const {
  for (CoordinateIndex dropped = 0; dropped < 3; ++dropped) {
    if (turn(dropped, a, b, c) != Sign::Zero) return false;
  }
  return true;
}

Sign PolyhedronSigns::compare(CoordinateIndex coordinate, Index a, Index b) const {
  const double value = approximate_[b][coordinate] - approximate_[a][coordinate];
  const double bound = 2.0 * coordinate_error_ * (1 + 4 * ulp);
  if (value > bound) return Sign::Positive;
  if (value < -bound) return Sign::Negative;
  const Integer d = difference<Integer>(a, b)[coordinate];
  return sign_of(d);
}

Sign PolyhedronSigns::volume(std::span<const std::array<Index, 3>> triangles) const {
  if (triangles.empty()) return Sign::Zero;
  // Measured from a vertex: keeps the terms as small as the body.
  const auto& o = approximate_[triangles.front()[0]];
  double sum = 0;
  double largest = 0;
  for (const auto& t : triangles) {
    std::array<std::array<double, 3>, 3> m;
    for (std::size_t r = 0; r < 3; ++r) {
      m[r] = differences(o, approximate_[t[r]]).entries;
      for (const double entry : m[r]) largest = std::max(largest, std::abs(entry));
    }
    sum += (m[0][1] * m[1][2] - m[0][2] * m[1][1]) * m[2][0] +
           (m[0][2] * m[1][0] - m[0][0] * m[1][2]) * m[2][1] +
           (m[0][0] * m[1][1] - m[0][1] * m[1][0]) * m[2][2];
  }
  // As in orientation(), a term; n partial sums of at most 6 n D^3 round once each.
  const double e = 2 * coordinate_error_ + ulp * largest;
  const double count = static_cast<double>(triangles.size());
  if (largest > smallest_difference && largest < largest_difference && e <= largest / 128) {
    const double bound = count * largest * largest * (20 * e + (32 + 8 * count) * ulp * largest);
    if (sum > bound) return Sign::Positive;
    if (sum < -bound) return Sign::Negative;
  }
  Rational exact = 0;
  Integer integral = 0;
  for (const auto& t : triangles) {
    std::array<Exact, 3> m;
    for (std::size_t r = 0; r < 3; ++r) {
      for (CoordinateIndex i = 0; i < 3; ++i) m[r][i] = numerator<Integer>(t[r], i);
    }
    const auto& [x, y, z] = m;
    const Integer determinant = (x[1] * y[2] - x[2] * y[1]) * z[0] +
                                (x[2] * y[0] - x[0] * y[2]) * z[1] +
                                (x[0] * y[1] - x[1] * y[0]) * z[2];
    if (unit_weights_) {
      integral += determinant;
    } else {
      Rational term(determinant,
                    weight<Integer>(t[0]) * weight<Integer>(t[1]) * weight<Integer>(t[2]));
      term.canonicalize();
      exact += term;
    }
  }
  return unit_weights_ ? sign_of(integral) : sign_of(exact);
}

}  // namespace exactcsg
