// SPDX-License-Identifier: Apache-2.0
#pragma once

// A surface in the coordinates of one cell, which run from -1 to 1, and its graph over a rectangle
// of the first two. [Certified]
//
// The surface is the zero of a function f that is a polynomial of degree at most two (a quadric),
// or one such polynomial minus the root of another, which is positive in the cell (a torus).
//
// LAW unit_quadric.1  the coefficients enclose those of f(centre + half_width u).
// LAW unit_surface.1  values, derivatives and ranges enclose those of f, at every point within the
//                     errors of the coordinates.
// LAW graph.1  if a graph is found over a rectangle, f has exactly one zero Z(s, t) with
//              lower < Z < upper over each of its points, df/du > 0 there, and Z is analytic.
// LAW graph.2  integral encloses that of Z; the error falls as the eleventh power of the
// rectangle's
//              size. polynomial encloses Z by a function and a remainder.
// LAW graph.3  the series enclose Z's Taylor coefficients at the rectangle's centre, and at all of
//              its points.
//
// A graph is found by its polynomial (implicit_polynomial.hpp). The series are intervals. Taylor's
// formula: with x0 on the surface, 0 = f(x0 + d) = f'(x0) d + d'Ad is solved for the
// power series of d's last component, coefficient by coefficient. At the centre of the rectangle
// this gives the polynomial; over the whole rectangle, in intervals, Lagrange's remainder. Of a
// torus, f = b - w with w^2 = r, the zeros are those of b^2 - r: with b = w = w0 + e there, e = b'd
// + d'Bd, what is solved is f'd + d'(B - R / (2 w0))d + e^2 / (2 w0) = 0, in which e is a series as
// well.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "exactcsg/domain/quadric.hpp"
#include "exactcsg/measure/implicit_polynomial.hpp"
#include "exactcsg/measure/taylor_series.hpp"
#include "exactcsg/number/certified_root.hpp"

namespace exactcsg::measure::detail {

struct UnitQuadric {
  using Vector = std::array<CertifiedDouble, 3>;

  CertifiedDouble constant;
  Vector linear;
  std::array<Vector, 3> square;

  CertifiedDouble operator()(const Vector& x) const {
    CertifiedDouble value = constant;
    for (std::size_t i = 0; i < 3; ++i) {
      CertifiedDouble factor = linear[i];
      for (std::size_t j = 0; j < 3; ++j) factor = factor + square[i][j] * x[j];
      value = value + factor * x[i];
    }
    return value;
  }
  CertifiedDouble derivative(std::size_t axis, const Vector& x) const {
    CertifiedDouble value = linear[axis];
    for (std::size_t j = 0; j < 3; ++j) value = value + exactly(2) * square[axis][j] * x[j];
    return value;
  }
  // The same as the value at x, but tighter where the errors of x are large.
  CertifiedDouble range_near(const Vector& x) const {
    Vector middle;
    for (std::size_t i = 0; i < 3; ++i) middle[i] = exactly(x[i].value);
    double reach = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      double slope = magnitude(derivative(i, middle));
      for (std::size_t j = 0; j < 3; ++j) slope += magnitude(square[i][j]) * x[j].error;
      reach += slope * x[i].error;
    }
    return widened((*this)(middle), reach * (1 + 0x1p-48));
  }
  // Taylor coefficients of f(s, t, height(s, t)) at the points (s, t) = at.
  Series on_graph(const std::array<CertifiedDouble, 2>& at, const Series& height,
                  std::size_t degree) const {
    const std::array<Series, 3> x{coordinate_series(0, at[0]), coordinate_series(1, at[1]), height};
    Series result = constant_series(constant);
    for (std::size_t i = 0; i < 3; ++i) {
      Series factor = constant_series(linear[i]);
      for (std::size_t j = i; j < 3; ++j) {
        if (is_zero(square[i][j])) continue;
        const CertifiedDouble weight = j == i ? square[i][j] : exactly(2) * square[i][j];
        factor = sum(factor, scaled(weight, x[j], degree), degree);
      }
      result = sum(result, product(x[i], factor, degree), degree);
    }
    return result;
  }
  // On the whole cell.
  CertifiedDouble derivative_in_cell(std::size_t axis) const {
    double reach = 0;
    for (std::size_t j = 0; j < 3; ++j) reach += 2 * magnitude(square[axis][j]);
    return widened(linear[axis], reach * (1 + 0x1p-50));
  }
  // On the points of the rectangle at one height.
  CertifiedDouble range_at(const Rectangle& r, double height) const {
    const Vector centre{exactly(r.s), exactly(r.t), exactly(height)};
    const std::array<double, 2> extent{r.a, r.b};
    double reach = 0;
    for (std::size_t i = 0; i < 2; ++i) {
      double slope = magnitude(derivative(i, centre));
      for (std::size_t j = 0; j < 2; ++j) slope += magnitude(square[i][j]) * extent[j];
      reach += slope * extent[i];
    }
    return widened((*this)(centre), reach * (1 + 0x1p-48));
  }
  UnitQuadric operator-() const {
    UnitQuadric result{-constant, {}, {}};
    for (std::size_t i = 0; i < 3; ++i) {
      result.linear[i] = -linear[i];
      for (std::size_t j = 0; j < 3; ++j) result.square[i][j] = -square[i][j];
    }
    return result;
  }
  // With the axes in another order: the last is `height`.
  UnitQuadric with_height(std::size_t height) const {
    UnitQuadric result{constant, {}, {}};
    for (std::size_t i = 0; i < 3; ++i) {
      result.linear[i] = linear[(height + 1 + i) % 3];
      for (std::size_t j = 0; j < 3; ++j) {
        result.square[i][j] = square[(height + 1 + i) % 3][(height + 1 + j) % 3];
      }
    }
    return result;
  }
};

inline UnitQuadric unit_quadric(const domain::Quadric<3>& f, const domain::Box<3>& box) {
  domain::Coordinates<3> centre;
  domain::Coordinates<3> half;
  for (std::size_t i = 0; i < 3; ++i) {
    centre[i] = (box.lower()[i] + box.upper()[i]) / 2;
    half[i] = box.upper()[i] - centre[i];
  }
  const domain::Coordinates<3> gradient = f.gradient(centre);
  UnitQuadric result{certified_double_of(f(centre)), {}, {}};
  for (std::size_t i = 0; i < 3; ++i) {
    result.linear[i] = certified_double_of(Rational(gradient[i] * half[i]));
    for (std::size_t j = 0; j < 3; ++j) {
      if (f.square()[i][j] == 0) continue;
      result.square[i][j] = certified_double_of(Rational(f.square()[i][j] * half[i] * half[j]));
    }
  }
  return result;
}

// f = base, or base + sign sqrt(radicand), sign 1 or -1.
class UnitSurface {
 public:
  using Vector = UnitQuadric::Vector;

  explicit UnitSurface(UnitQuadric f) : base_(std::move(f)) {}
  // base - sqrt(radicand); nullopt if the radicand is not certainly positive in the cell.
  // REQUIRES the radicand is a sum of squares of linear forms
  static std::optional<UnitSurface> difference(UnitQuadric base, UnitQuadric radicand) {
    if (!is_positive(radicand.range_near(all_of_cell()))) return std::nullopt;
    UnitSurface result(std::move(base));
    result.radicand_ = std::move(radicand);
    return result;
  }

  const UnitQuadric& base() const { return base_; }
  const std::optional<UnitQuadric>& radicand() const { return radicand_; }

  CertifiedDouble operator()(const Vector& x) const {
    return radicand_ ? base_(x) + exactly(sign_) * root(x) : base_(x);
  }
  CertifiedDouble derivative(std::size_t axis, const Vector& x) const {
    if (!radicand_) return base_.derivative(axis, x);
    const Vector middle = middle_of(x);
    const CertifiedDouble in_middle =
        derivative_of_torus(axis, middle, square_root((*radicand_)(middle)));
    return is_exact(x) ? in_middle : spread(in_middle, axis, RootTerms(*radicand_, x), x);
  }
  // Of a torus: the root, its derivatives and those of f.
  struct FirstOrder {
    CertifiedDouble root;
    Vector of_root;
    Vector slope;
  };
  // REQUIRES a radicand
  FirstOrder first_order(const Vector& x) const {
    const RootTerms terms(*radicand_, x);
    const Vector middle = middle_of(x);
    const CertifiedDouble in_middle = square_root((*radicand_)(middle));
    FirstOrder result{terms.root, terms.slope, {}};
    for (std::size_t i = 0; i < 3; ++i) {
      result.slope[i] = spread(derivative_of_torus(i, middle, in_middle), i, terms, x);
    }
    return result;
  }
  // f = base + sign sqrt(radicand)
  double sign() const { return sign_; }
  // Half the second derivative along two axes.
  CertifiedDouble half_second_derivative(std::size_t i, std::size_t j, const Vector& x) const {
    if (!radicand_) return base_.square[i][j];
    return half_second_derivative_of_torus(i, j, RootTerms(*radicand_, x));
  }
  CertifiedDouble derivative_in_cell(std::size_t axis) const {
    return radicand_ ? derivative(axis, all_of_cell()) : base_.derivative_in_cell(axis);
  }
  // On the points of the rectangle at one height.
  CertifiedDouble range_at(const Rectangle& r, double height) const {
    if (!radicand_) return base_.range_at(r, height);
    const Vector centre{exactly(r.s), exactly(r.t), exactly(height)};
    const CertifiedDouble root = square_root((*radicand_)(centre));
    const RootTerms anywhere(
        *radicand_, {CertifiedDouble{r.s, r.a}, CertifiedDouble{r.t, r.b}, exactly(height)});
    const std::array<double, 2> extent{r.a, r.b};
    double reach = 0;
    for (std::size_t i = 0; i < 2; ++i) {
      double slope = magnitude(derivative_of_torus(i, centre, root));
      for (std::size_t j = 0; j < 2; ++j) {
        slope += magnitude(half_second_derivative_of_torus(i, j, anywhere)) * extent[j];
      }
      reach += slope * extent[i];
    }
    return widened(base_(centre) + exactly(sign_) * root, reach * (1 + 0x1p-48));
  }
  // The same as the value at x, but tighter where the errors of x are large.
  CertifiedDouble range_near(const Vector& x) const {
    if (!radicand_) return base_.range_near(x);
    const Vector middle = middle_of(x);
    const RootTerms terms(*radicand_, x);
    const CertifiedDouble root_in_middle = square_root((*radicand_)(middle));
    double reach = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const CertifiedDouble slope = derivative_of_torus(i, middle, root_in_middle);
      reach += magnitude(spread(slope, i, terms, x)) * x[i].error;
    }
    return widened(base_(middle) + exactly(sign_) * root_in_middle, reach * (1 + 0x1p-48));
  }
  // Taylor coefficients of f(s, t, height(s, t)) at the points (s, t) = at. `near`: all of the
  // graph's points there, if that is more than one.
  Series on_graph(const std::array<CertifiedDouble, 2>& at, const Series& height,
                  const Vector* near, std::size_t degree) const {
    Series result = base_.on_graph(at, height, degree);
    if (!radicand_) return result;
    Series radicand = radicand_->on_graph(at, height, degree);
    if (near != nullptr) radicand[0][0] = radicand_->range_near(*near);
    const Series root = detail::root(radicand, square_root(radicand[0][0]), degree);
    return sum(result, scaled(exactly(sign_), root, degree), degree);
  }
  UnitSurface operator-() const {
    UnitSurface result = *this;
    result.base_ = -base_;
    result.sign_ = -sign_;
    return result;
  }
  // With the axes in another order: the last is `height`.
  UnitSurface with_height(std::size_t height) const {
    UnitSurface result = *this;
    result.base_ = base_.with_height(height);
    if (radicand_) result.radicand_ = radicand_->with_height(height);
    return result;
  }

 private:
  static Vector all_of_cell() {
    return {CertifiedDouble{0, 1}, CertifiedDouble{0, 1}, CertifiedDouble{0, 1}};
  }
  CertifiedDouble root(const Vector& x) const { return square_root(radicand_->range_near(x)); }

  // The root of the radicand and its derivatives v_i at a point known up to errors. A root of a sum
  // of squares is convex: its second derivatives, (A_ij - v_i v_j) / root with the radicand's A,
  // are those of a matrix between 0 and A / root. So v_i varies by at most the sum of
  // sqrt(A_ii A_jj) / root times the errors.
  struct RootTerms {
    const UnitQuadric& radicand;
    CertifiedDouble root;
    Vector slope;

    RootTerms(const UnitQuadric& radicand_at, const Vector& x)
        : radicand(radicand_at), root(square_root(radicand.range_near(x))) {
      const Vector middle = middle_of(x);
      const CertifiedDouble twice = exactly(2) * square_root(radicand(middle));
      std::array<double, 3> lengths{};
      double reach = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        lengths[i] = std::sqrt(magnitude(radicand.square[i][i])) * (1 + 0x1p-50);
        reach += lengths[i] * x[i].error;
      }
      reach /= (root.value - root.error) * (1 - 0x1p-50);
      for (std::size_t i = 0; i < 3; ++i) {
        slope[i] =
            widened(radicand.derivative(i, middle) / twice, lengths[i] * reach * (1 + 0x1p-48));
        if (!(root.value > root.error)) slope[i].error = HUGE_VAL;
      }
    }
    CertifiedDouble half_second_derivative(std::size_t i, std::size_t j) const {
      return exactly(0.5) * (radicand.square[i][j] - slope[i] * slope[j]) / root;
    }
  };

  CertifiedDouble half_second_derivative_of_torus(std::size_t i, std::size_t j,
                                                  const RootTerms& at) const {
    return base_.square[i][j] + exactly(sign_) * at.half_second_derivative(i, j);
  }
  CertifiedDouble derivative_of_torus(std::size_t axis, const Vector& x,
                                      const CertifiedDouble& root) const {
    return base_.derivative(axis, x) + exactly(0.5 * sign_) * radicand_->derivative(axis, x) / root;
  }
  // A derivative in the middle, and how it varies by the second derivatives from there.
  CertifiedDouble spread(const CertifiedDouble& in_middle, std::size_t axis, const RootTerms& terms,
                         const Vector& x) const {
    double reach = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      if (x[j].error == 0) continue;
      reach += 2 * magnitude(half_second_derivative_of_torus(axis, j, terms)) * x[j].error;
    }
    return widened(in_middle, reach * (1 + 0x1p-48));
  }
  static Vector middle_of(const Vector& x) {
    return {exactly(x[0].value), exactly(x[1].value), exactly(x[2].value)};
  }
  static bool is_exact(const Vector& x) {
    return x[0].error == 0 && x[1].error == 0 && x[2].error == 0;
  }

  UnitQuadric base_;
  std::optional<UnitQuadric> radicand_;
  double sign_ = -1;
};

constexpr std::size_t graph_degree = 8;

// constant + terms, in the rectangle's own coordinates, and how far off that is.
struct NearbyPolynomial {
  double constant;
  const PartedPolynomial<graph_degree>* terms;  // null: none
  double error;
};

// The height of the surface over a rectangle.
class Graph {
 public:
  using Polynomial = PartedPolynomial<graph_degree>;

  double lower() const { return middle_ - reach_; }
  double upper() const { return middle_ + reach_; }

  // nullopt if no graph is recognised, which need not mean that there is none.
  // REQUIRES the partial derivative by the height is positive where the graph is sought.
  static std::optional<Graph> find(const UnitSurface& f, const Rectangle& r) {
    const double middle = approximate_zero(f, r);
    if (!(std::abs(middle) < 8)) return std::nullopt;
    const LocalQuadric base(f.base(), r, middle);
    const Implicit implicit = f.radicand()
                                  ? Implicit(base, LocalQuadric(*f.radicand(), r, middle), f.sign())
                                  : Implicit(base);
    const double norm = implicit.norm() * (1 + 0x1p-48);
    double reach = 1.0625 * norm + 0x1p-44;
    for (int attempt = 0; attempt < 2 && reach < 8; ++attempt) {
      const CertifiedDouble slope =
          f.radicand() ? f.derivative(2, points_within(r, middle, reach)) : base.slope(reach);
      const double least = slope.value * (1 - 0x1p-50) - slope.error;
      if (!(least > 0)) break;
      const double error = implicit.residual(reach) / least * (1 + 0x1p-50);
      if (norm + error <= reach) return Graph(f, r, middle, implicit.polynomial(), error);
      reach = 1.0625 * (norm + error);
    }
    return std::nullopt;
  }

  CertifiedDouble integral() const {
    double mean = 0;
    for (std::size_t n = 2; n <= graph_degree; n += 2) {
      for (std::size_t i = 0; i <= n; i += 2) {
        mean += terms_[n][i] / static_cast<double>((i + 1) * (n - i + 1));
      }
    }
    return (exactly(middle_) + widened({mean, error_}, 0x1p-47 * terms_.norm())) * exactly(4) *
           exactly(rectangle_.a) * exactly(rectangle_.b);
  }
  // Of the height, in s and t relative to the points.
  Series series_at_centre(std::size_t degree) const { return series(centre_point(), degree); }
  Series series_anywhere(std::size_t degree = order) const { return series(all_points(), degree); }

  NearbyPolynomial polynomial() const { return {middle_, &terms_, error_}; }

 private:
  static constexpr std::size_t order = series_order;
  static constexpr int most_steps = 6;
  using Implicit = ImplicitPolynomial<graph_degree>;

  // The height is within `error` of middle + terms.
  Graph(const UnitSurface& f, const Rectangle& r, double middle, const Polynomial& terms,
        double error)
      : f_(&f), rectangle_(r), middle_(middle), terms_(terms), error_(error) {
    reach_ = (terms.norm() + error) * (1 + 0x1p-47) + 0x1p-48;
  }

  static double approximate_zero(const UnitSurface& f, const Rectangle& r) {
    double height = 0;
    for (int i = 0; i < most_steps; ++i) {
      const UnitSurface::Vector at{exactly(r.s), exactly(r.t), exactly(height)};
      const double a = f.half_second_derivative(2, 2, at).value;
      const double b = f.derivative(2, at).value;
      const double c = f(at).value;
      // Where the derivative is positive, it is the root of the discriminant.
      const double step = -2 * c / (b + std::sqrt(b * b - 4 * a * c));
      height += step;
      // A quadric has no terms of higher order. Of others, the next step would be of the third.
      if (!f.radicand() || !(std::abs(step) > 0x1p-18) || !(std::abs(height) < 8)) break;
    }
    return height;
  }

  static UnitSurface::Vector points_within(const Rectangle& r, double height, double reach) {
    return {CertifiedDouble{r.s, r.a}, CertifiedDouble{r.t, r.b}, CertifiedDouble{height, reach}};
  }
  UnitSurface::Vector all_points() const { return points_within(rectangle_, middle_, reach_); }
  UnitSurface::Vector centre_point() const {
    const UnitSurface::Vector guess{exactly(rectangle_.s), exactly(rectangle_.t), exactly(middle_)};
    // Between the guess and the zero, the derivative is one of those of the whole graph.
    const CertifiedDouble step = (*f_)(guess) / f_->derivative(2, all_points());
    return {guess[0], guess[1], widened(guess[2], magnitude(step))};
  }
  // The terms of degree one and two of a polynomial about a point of the surface.
  struct LocalTerms {
    UnitSurface::Vector linear;
    std::array<UnitSurface::Vector, 3> square;

    LocalTerms(const UnitQuadric& f, const UnitSurface::Vector& at) : square(f.square) {
      for (std::size_t i = 0; i < 3; ++i) linear[i] = f.derivative(i, at);
    }
    // base + factor radicand to second order, with other slopes.
    LocalTerms(const UnitSurface& f, const CertifiedDouble& factor,
               const UnitSurface::Vector& slope)
        : linear(slope), square(f.base().square) {
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
          const CertifiedDouble& other = f.radicand()->square[i][j];
          if (!is_zero(other)) square[i][j] = square[i][j] + factor * other;
        }
      }
    }
    // The coefficient of s^i t^j, of degree two or more, without the height's own of that degree.
    CertifiedDouble known_part(const Series& z, std::size_t i, std::size_t j) const {
      CertifiedDouble sum;
      if (i + j == 2) {
        sum = i == 2 ? square[0][0] : j == 2 ? square[1][1] : exactly(2) * square[0][1];
      }
      if (i > 0 && !is_zero(square[0][2])) sum = sum + exactly(2) * square[0][2] * z[i - 1][j];
      if (j > 0 && !is_zero(square[1][2])) sum = sum + exactly(2) * square[1][2] * z[i][j - 1];
      if (!is_zero(square[2][2])) sum = sum + square[2][2] * square_coefficient(z, i, j);
      return sum;
    }
  };

  // The coefficients of s^i t^j in the height about points of the surface, up to degree `degree`.
  Series series(const UnitSurface::Vector& at, std::size_t degree = order) const {
    const LocalTerms base(f_->base(), at);
    return f_->radicand() ? series_of_torus(base, at, degree)
                          : series_of_quadric(base, at[2], degree);
  }
  static Series series_of_quadric(const LocalTerms& f, const CertifiedDouble& height,
                                  std::size_t degree) {
    const CertifiedDouble& slope = f.linear[2];
    Series z{};
    z[0][0] = height;
    z[1][0] = -f.linear[0] / slope;
    z[0][1] = -f.linear[1] / slope;
    for (std::size_t n = 2; n <= degree; ++n) {
      for (std::size_t i = 0; i <= n; ++i) z[i][n - i] = -f.known_part(z, i, n - i) / slope;
    }
    return z;
  }
  Series series_of_torus(const LocalTerms& base, const UnitSurface::Vector& at,
                         std::size_t degree) const {
    const UnitSurface::FirstOrder first = f_->first_order(at);
    const CertifiedDouble factor = exactly(0.5 * f_->sign()) / first.root;
    const LocalTerms f(*f_, factor, first.slope);
    const CertifiedDouble& slope = f.linear[2];
    Series z{};
    z[0][0] = at[2];
    z[1][0] = -f.linear[0] / slope;
    z[0][1] = -f.linear[1] / slope;
    Series e{};  // the root, or the base, which is the same but for the sign, less its constant
    e[1][0] = first.of_root[0] + first.of_root[2] * z[1][0];
    e[0][1] = first.of_root[1] + first.of_root[2] * z[0][1];
    const CertifiedDouble sign = exactly(-f_->sign());
    for (std::size_t n = 2; n <= degree; ++n) {
      for (std::size_t i = 0; i <= n; ++i) {
        const std::size_t j = n - i;
        z[i][j] = -(f.known_part(z, i, j) - factor * square_coefficient(e, i, j)) / slope;
        if (n == degree) continue;
        e[i][j] = sign * (base.known_part(z, i, j) + base.linear[2] * z[i][j]);
      }
    }
    return z;
  }
  // Of the square of the series without its constant.
  static CertifiedDouble square_coefficient(const Series& z, std::size_t i, std::size_t j) {
    CertifiedDouble sum;
    for (std::size_t k = 0; 2 * k <= i; ++k) {
      for (std::size_t l = 0; l <= j; ++l) {
        if (k + l == 0 || k + l == i + j || (2 * k == i && 2 * l > j)) continue;
        const CertifiedDouble product = z[k][l] * z[i - k][j - l];
        sum =
            sum + (2 * k == i && 2 * l == j ? product : exactly(2) * product);  // twice by symmetry
      }
    }
    return sum;
  }

  const UnitSurface* f_;
  Rectangle rectangle_;
  double middle_;
  double reach_ = 0;
  Polynomial terms_;
  double error_;
};

}  // namespace exactcsg::measure::detail
