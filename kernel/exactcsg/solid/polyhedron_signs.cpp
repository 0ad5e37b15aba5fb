// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/polyhedron_signs.hpp"

#include <algorithm>
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
  bool exactly_doubles = true;
  double largest = 0;
  for (const Point3& p : points) {
    std::array<double, 3> rounded{};
    for (CoordinateIndex i = 0; i < 3; ++i) {
      const Rational& value = coordinate(p, i);
      rounded[i] = nearest_double(value);
      largest = std::max(largest, std::abs(rounded[i]));
      exactly_doubles = exactly_doubles && std::isfinite(rounded[i]) && rounded[i] == value;
    }
    approximate_.push_back(rounded);
  }
  coordinate_error_ = exactly_doubles ? 0 : ulp * largest + std::numeric_limits<double>::min();

  point_error_ = coordinate_error_;

  const std::optional<Integer> common = short_common_denominator(points);
  exact_.reserve(points.size());
  weight_.reserve(points.size());
  bool all_small = common.has_value();
  for (const Point3& p : points) {
    Integer own = 1;
    if (!common) {
      unit_weights_ = false;
      own = lcm(lcm(p.x.get_den(), p.y.get_den()), p.z.get_den());
    }
    const Integer& factor = common ? *common : own;
    Exact scaled;
    for (CoordinateIndex i = 0; i < 3; ++i) {
      set_scaled(scaled[i], coordinate(p, i), factor);
      all_small = all_small && mpz_sizeinbase(scaled[i].get_mpz_t(), 2) <= small_bits;
    }
    append(scaled, own);
  }
  if (!all_small) return;
  small_.reserve(points.size());
  for (const Exact& e : exact_) small_.push_back({e[0].get_si(), e[1].get_si(), e[2].get_si()});
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
    denominator = lcm(denominator, weight_[index]);
    total += k;
  }
  Exact sum{0, 0, 0};
  std::array<double, 3> approximate{};
  for (const auto& [index, k] : weighted) {
    const Integer factor = denominator / weight_[index] * k;
    for (CoordinateIndex i = 0; i < 3; ++i) {
      sum[i] += exact_[index][i] * factor;
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
  return static_cast<Index>(exact_.size() - 1);
}

template <class Integral>
std::array<Integral, 3> PolyhedronSigns::difference(Index from, Index to) const {
  const auto entry = [&](CoordinateIndex i) -> Integral {
    const Integral head = integer_from<Integral>(exact_[to][i]);
    const Integral tail = integer_from<Integral>(exact_[from][i]);
    if (unit_weights_ || weight_[from] == weight_[to]) return head - tail;
    return head * integer_from<Integral>(weight_[from]) -
           tail * integer_from<Integral>(weight_[to]);
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
    const Exact& x = exact_[t[0]];
    const Exact& y = exact_[t[1]];
    const Exact& z = exact_[t[2]];
    const Integer determinant = (x[1] * y[2] - x[2] * y[1]) * z[0] +
                                (x[2] * y[0] - x[0] * y[2]) * z[1] +
                                (x[0] * y[1] - x[1] * y[0]) * z[2];
    if (unit_weights_) {
      integral += determinant;
    } else {
      Rational term(determinant, weight_[t[0]] * weight_[t[1]] * weight_[t[2]]);
      term.canonicalize();
      exact += term;
    }
  }
  return unit_weights_ ? sign_of(integral) : sign_of(exact);
}

}  // namespace exactcsg
