// SPDX-License-Identifier: Apache-2.0
#pragma once

// A polynomial in two variables near the zero of a quadric, or of a quadric plus or minus the root
// of another, and a bound of how far it is off. [Certified]
//
// The variables are those of a rectangle, -1 <= u, v <= 1; the height z is counted from a guess.
// There f = b, or f = b + sign sqrt(r), b and r of degree two. The zero's power series is computed
// in plain doubles, degree by degree; nothing is claimed of it. What is proved is the residual: for
// the truncated series P, f(u, v, P) is a polynomial, whose coefficients up to the degree of P
// vanish but for rounding, and whose others are at most products of the norms of P's homogeneous
// parts. Where df/dz >= m > 0, the zero is within |f(u, v, P)| / m of P. With a root, its truncated
// series W goes along: |sqrt(r) - W| = |r - W^2| / (sqrt(r) + W).
//
// LAW implicit_polynomial.1  |f(u, v, P(u, v))| <= residual(reach) if |P| <= reach. The norm is not
//                            finite where there is no series: df/dz = 0 at the guess, or r <= 0.
//
// Norms are sums of the coefficients' magnitudes: no |u|, |v| <= 1 gives more.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "exactcsg/measure/certified_arithmetic.hpp"

namespace exactcsg::measure::detail {

// A polynomial of degree at most two in u, v and z: doubles, and how far off they are in all.
struct LocalQuadric {
  double constant = 0;
  double u = 0;
  double v = 0;
  double z = 0;
  double uu = 0;
  double uv = 0;
  double vv = 0;
  double uz = 0;
  double vz = 0;
  double zz = 0;
  std::array<double, 3> error{};  // of what has z not, once and squared as a factor

  // Of a function offered as UnitQuadric is.
  template <class Quadric>
  LocalQuadric(const Quadric& f, const Rectangle& r, double height) {
    const typename Quadric::Vector centre{exactly(r.s), exactly(r.t), exactly(height)};
    const CertifiedDouble a = exactly(r.a);
    const CertifiedDouble b = exactly(r.b);
    take(constant, f(centre), 0);
    take(u, f.derivative(0, centre) * a, 0);
    take(v, f.derivative(1, centre) * b, 0);
    take(z, f.derivative(2, centre), 1);
    take(uu, f.square[0][0] * a * a, 0);
    take(vv, f.square[1][1] * b * b, 0);
    take(zz, f.square[2][2], 2);
    take_mixed(uv, f.square[0][1], a * b, 0);
    take_mixed(uz, f.square[0][2], a, 1);
    take_mixed(vz, f.square[1][2], b, 1);
  }

  double error_within(double reach) const {
    return error[0] + reach * (error[1] + reach * error[2]);
  }
  // Of all but the constant, where z is a polynomial of this norm.
  double norm(double norm_of_z) const {
    return std::abs(u) + std::abs(v) + std::abs(uu) + std::abs(uv) + std::abs(vv) +
           norm_of_z * (std::abs(z) + std::abs(uz) + std::abs(vz) + norm_of_z * std::abs(zz));
  }
  // df/dz in |z| <= reach
  CertifiedDouble slope(double reach) const {
    const double spread = std::abs(uz) + std::abs(vz) + 2 * reach * std::abs(zz);
    return {z, (spread + error[1] + 2 * reach * error[2]) * (1 + 0x1p-48) + 0x1p-52 * std::abs(z)};
  }

 private:
  void take(double& coefficient, const CertifiedDouble& enclosure, std::size_t power_of_z) {
    coefficient = enclosure.value;
    error[power_of_z] += enclosure.error * (1 + 0x1p-48);
  }
  void take_mixed(double& coefficient, const CertifiedDouble& half, const CertifiedDouble& scale,
                  std::size_t power_of_z) {
    if (!is_zero(half)) take(coefficient, exactly(2) * half * scale, power_of_z);
  }
};

// Of degree n in u and v: at[i] belongs to u^i v^(n - i).
template <std::size_t Degree>
using HomogeneousPart = std::array<double, Degree + 1>;

// A polynomial without constant by its homogeneous parts.
template <std::size_t Degree>
class PartedPolynomial {
 public:
  using Part = HomogeneousPart<Degree>;

  const Part& operator[](std::size_t n) const { return parts_[n]; }
  double norm_of_part(std::size_t n) const { return norms_[n]; }
  double norm() const { return norm_; }

  // REQUIRES the parts below n are there.
  void set(std::size_t n, const Part& part) {
    parts_[n] = part;
    double sum = 0;
    for (std::size_t i = 0; i <= n; ++i) sum += std::abs(part[i]);
    norms_[n] = sum;
    norm_ += sum;
  }
  // Rounded.
  void subtract(const PartedPolynomial& other) {
    norm_ = 0;
    for (std::size_t n = 1; n <= Degree; ++n) {
      Part part = parts_[n];
      for (std::size_t i = 0; i <= n; ++i) part[i] -= other.parts_[n][i];
      set(n, part);
    }
  }
  // result += factor * (the part of degree n of the square). REQUIRES the parts below n are there.
  void add_square(std::size_t n, double factor, Part& result) const {
    for (std::size_t m = 1; 2 * m <= n; ++m) {
      const double twice = 2 * m == n ? factor : 2 * factor;
      const Part& p = parts_[m];
      const Part& q = parts_[n - m];
      for (std::size_t i = 0; i <= m; ++i) {
        const double scaled = twice * p[i];
        for (std::size_t j = 0; j <= n - m; ++j) result[i + j] += scaled * q[j];
      }
    }
  }
  // Of the parts of the square above the degree.
  double norm_of_square_beyond() const {
    double sum = 0;
    double upper = 0;  // of the parts from Degree + 1 - m on
    for (std::size_t m = 1; m <= Degree; ++m) {
      upper += norms_[Degree + 1 - m];
      sum += norms_[m] * upper;
    }
    return sum;
  }

 private:
  std::array<Part, Degree + 1> parts_{};
  std::array<double, Degree + 1> norms_{};
  double norm_ = 0;
};

template <std::size_t Degree>
class ImplicitPolynomial {
 public:
  using Polynomial = PartedPolynomial<Degree>;
  using Part = HomogeneousPart<Degree>;

  // Of f = b.
  explicit ImplicitPolynomial(const LocalQuadric& b) : base_(b) {
    const double factor = -1 / b.z;
    for (std::size_t n = 1; n <= Degree; ++n) {
      Part part = known_part(b, n);
      for (std::size_t i = 0; i <= n; ++i) part[i] *= factor;
      polynomial_.set(n, part);
    }
    rounded_ = b.norm(norm());
    rest_ = std::abs(b.constant) + beyond(b);
  }

  // Of f = b + sign sqrt(r).
  ImplicitPolynomial(const LocalQuadric& b, const LocalQuadric& r, double sign)
      : base_(b), radicand_(r) {
    const double root = std::sqrt(r.constant);
    const double twice = 2 * sign * root;
    const double factor = -1 / (r.z + twice * b.z);
    Polynomial w;  // the root without its constant
    for (std::size_t n = 1; n <= Degree; ++n) {
      Part of_root = known_part(b, n);
      Part part = known_part(r, n);
      w.add_square(n, -1, part);
      for (std::size_t i = 0; i <= n; ++i) {
        part[i] = factor * (part[i] + twice * of_root[i]);
        of_root[i] = -sign * (of_root[i] + b.z * part[i]);
      }
      polynomial_.set(n, part);
      w.set(n, of_root);
    }
    rounded_ = b.norm(norm()) + root + w.norm();
    rest_ = std::abs(b.constant + sign * root) + beyond(b);
    rounded_of_square_ =
        r.constant + r.norm(norm()) + 2 * root * rounded_ + (root + w.norm()) * (root + w.norm());
    rest_of_square_ = beyond(r) + w.norm_of_square_beyond();
    least_root_ = (root - w.norm()) * (1 - 0x1p-48);
  }

  const Polynomial& polynomial() const { return polynomial_; }
  double norm() const { return polynomial_.norm(); }

  double residual(double reach) const {
    // Less than sixty operations lead to each coefficient.
    static_assert(Degree >= 2 && Degree <= 8);
    constexpr double rounding = 0x1p-47;
    const double of_base = base_.error_within(reach) + rest_ + rounding * rounded_;
    double result = of_base;
    if (radicand_) {
      if (!(least_root_ > 0)) return HUGE_VAL;
      const double of_square =
          radicand_->error_within(reach) + rest_of_square_ + rounding * rounded_of_square_;
      const double least_square = least_root_ * least_root_ - of_square;
      result += of_square / (least_root_ + std::sqrt(std::max(0.0, least_square)));
    }
    return result * (1 + 0x1p-40) + 0x1p-1000;
  }

 private:
  // The part of degree n of q(u, v, P) without what P's own part of that degree brings.
  Part known_part(const LocalQuadric& q, std::size_t n) const {
    Part result{};
    if (n == 1) {
      result[1] = q.u;
      result[0] = q.v;
      return result;
    }
    if (n == 2) {
      result[2] = q.uu;
      result[1] = q.uv;
      result[0] = q.vv;
    }
    const Part& before = polynomial_[n - 1];
    if (q.uz != 0) {
      for (std::size_t i = 0; i < n; ++i) result[i + 1] += q.uz * before[i];
    }
    if (q.vz != 0) {
      for (std::size_t i = 0; i < n; ++i) result[i] += q.vz * before[i];
    }
    if (q.zz != 0) polynomial_.add_square(n, q.zz, result);
    return result;
  }
  // Of what q(u, v, P) has above the degree of P.
  double beyond(const LocalQuadric& q) const {
    return (std::abs(q.uz) + std::abs(q.vz)) * polynomial_.norm_of_part(Degree) +
           std::abs(q.zz) * polynomial_.norm_of_square_beyond();
  }

  LocalQuadric base_;
  std::optional<LocalQuadric> radicand_;
  Polynomial polynomial_;
  double rest_ = 0;     // of f, or of b + sign W: what is no rounding
  double rounded_ = 0;  // the sum of all terms' magnitudes
  double rest_of_square_ = 0;
  double rounded_of_square_ = 0;
  double least_root_ = 0;
};

}  // namespace exactcsg::measure::detail
