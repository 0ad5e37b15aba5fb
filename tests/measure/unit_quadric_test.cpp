// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of certified measures: polynomials in a cell's coordinates, graphs, the mean of a
// positive part, tables of surfaces. Expected values: the definitions in rational arithmetic,
// integrals in closed form, and sums over fine grids.

#include "exactcsg/measure/unit_quadric.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "exactcsg/domain/classify.hpp"
#include "exactcsg/measure/column.hpp"
#include "exactcsg/measure/surface_table.hpp"
#include "measure/random_solids.hpp"

namespace exactcsg::measure::test {
namespace {

using detail::Graph;
using detail::Rectangle;
using detail::UnitQuadric;

bool contains(const CertifiedDouble& x, const Rational& value) {
  return abs(Rational(value - rational_of(x.value))) <= rational_of(x.error);
}

domain::Quadric<3> random_quadric() {
  domain::Quadric<3>::Matrix square;
  domain::LinearForm<3> linear{random_point().coordinates(), random_rational(-1, 1)};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = i; j < 3; ++j) square[i][j] = square[j][i] = random_rational(-1, 1);
  }
  return {square, linear};
}

// LAW unit_quadric.1
RC_GTEST_PROP(UnitQuadric, IsThePolynomialInTheCellsCoordinates, ()) {
  const domain::Quadric<3> f = random_quadric();
  const Point<3> centre = random_point();
  const Rational half = Rational(1, 7);
  domain::Coordinates<3> low;
  domain::Coordinates<3> high;
  for (std::size_t i = 0; i < 3; ++i) {
    low[i] = centre[i] - half;
    high[i] = centre[i] + half;
  }
  const UnitQuadric local = detail::unit_quadric(f, Box<3>(low, high));
  const double u[] = {0.25, -0.625, 1};
  domain::Coordinates<3> x;
  UnitQuadric::Vector at;
  for (std::size_t i = 0; i < 3; ++i) {
    x[i] = centre[i] + half * rational_of(u[i]);
    at[i] = detail::exactly(u[i]);
  }
  RC_ASSERT(contains(local(at), f(x)));
  for (std::size_t i = 0; i < 3; ++i) {
    RC_ASSERT(contains(local.derivative(i, at), Rational(f.gradient(x)[i] * half)));
    // another axis up
    const UnitQuadric turned = local.with_height(i);
    RC_ASSERT(contains(turned({at[(i + 1) % 3], at[(i + 2) % 3], at[i]}), f(x)));
  }
  RC_ASSERT(contains((-local)(at), Rational(-f(x))));
  // all values at a height lie in the range
  const Rectangle r{0.25, -0.5, 0.5, 0.25};
  const CertifiedDouble range = local.range_at(r, 1);
  for (const double s : {-1.0, 0.0, 0.5, 1.0}) {
    for (const double t : {-1.0, -0.25, 1.0}) {
      const domain::Coordinates<3> y{Rational(centre[0] + half * rational_of(r.s + s * r.a)),
                                     Rational(centre[1] + half * rational_of(r.t + t * r.b)),
                                     Rational(centre[2] + half)};
      RC_ASSERT(contains(range, f(y)));
    }
  }
}

// The paraboloid z = s^2 / 4 + s t / 8 - t^2 / 16 + s / 2 - 1/8: its integral is that of its even
// terms. The derivatives of its implicit polynomial by the height are constant.
TEST(Graph, IntegralOfAParaboloid) {
  UnitQuadric f;
  f.constant = detail::exactly(0.125);
  f.linear = {detail::exactly(-0.5), {}, detail::exactly(1)};
  f.square[0][0] = detail::exactly(-0.25);
  f.square[1][1] = detail::exactly(0.0625);
  f.square[0][1] = f.square[1][0] = detail::exactly(-0.0625);
  const detail::UnitSurface surface(f);
  const auto graph = Graph::find(surface, Rectangle());
  ASSERT_TRUE(graph);
  const CertifiedDouble integral = graph->integral();
  EXPECT_TRUE(
      contains(integral, Rational(4) * (Rational(1, 12) - Rational(1, 48) - Rational(1, 8))));
  EXPECT_LT(integral.error, 1e-13);
}

// z = sqrt(4 - s^2 - t^2) - 1 over rectangles that halve: the integral lies in the bounds, and the
// error falls by nearly 2^11, as LAW graph.2 says.
TEST(Graph, IntegralOfASphere) {
  UnitQuadric f;
  f.constant = detail::exactly(-3);  // s^2 + t^2 + (z + 1)^2 = 4
  f.linear = {CertifiedDouble{}, CertifiedDouble{}, detail::exactly(2)};
  for (std::size_t i = 0; i < 3; ++i) f.square[i][i] = detail::exactly(1);
  const detail::UnitSurface surface(f);
  double before = 0;
  for (const double size : {0.5, 0.25, 0.125}) {
    const auto graph = Graph::find(surface, Rectangle{0, 0, size, size});
    ASSERT_TRUE(graph);
    EXPECT_LT(graph->upper() - graph->lower(), 4 * size * size + size);
    const CertifiedDouble integral = graph->integral();
    // Gauss's rule of three points on a grid of 64 x 64 squares: off by far less than 1e-13.
    double reference = 0;
    const double node = std::sqrt(0.6);
    const double half = size / 64;
    for (int i = 0; i < 64 * 64; ++i) {
      const double s = -size + (2 * (i % 64) + 1) * half;
      const double t = -size + (2 * (i / 64) + 1) * half;
      for (int k = -1; k <= 1; ++k) {
        for (int l = -1; l <= 1; ++l) {
          const double x = s + k * node * half;
          const double y = t + l * node * half;
          const double weight = (k == 0 ? 8.0 : 5.0) * (l == 0 ? 8.0 : 5.0) / 81;
          reference += weight * half * half * (std::sqrt(4 - x * x - y * y) - 1);
        }
      }
    }
    EXPECT_LE(std::abs(integral.value - reference), integral.error + 1e-13);
    if (before != 0) {
      EXPECT_LT(integral.error, before / 1000 + 1e-14);
    }
    before = integral.error;
  }
}

// 2^-8 times an integer, of at most this magnitude.
double random_coefficient(double most) {
  const int steps = static_cast<int>(256 * most);
  return *rc::gen::inRange(-steps, steps + 1) / 256.0;
}
Rational value_of(const detail::PartedPolynomial<8>& p, const Rational& u, const Rational& v) {
  Rational sum;
  for (std::size_t n = 1; n <= 8; ++n) {
    for (std::size_t i = 0; i <= n; ++i) {
      Rational term = rational_of(p[n][i]);
      for (std::size_t k = 0; k < i; ++k) term *= u;
      for (std::size_t k = i; k < n; ++k) term *= v;
      sum += term;
    }
  }
  return sum;
}

// LAW implicit_polynomial.1, in rational arithmetic: f at the polynomial.
RC_GTEST_PROP(ImplicitPolynomial, TheResidualIsInTheBound, ()) {
  UnitQuadric f;
  f.constant = detail::exactly(random_coefficient(0.125));
  f.linear = {detail::exactly(random_coefficient(0.5)), detail::exactly(random_coefficient(0.5)),
              detail::exactly(2)};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = i; j < 3; ++j) {
      f.square[i][j] = f.square[j][i] = detail::exactly(random_coefficient(0.25));
    }
  }
  const double height = random_coefficient(0.125);
  const Rectangle r{0.25, -0.125, 0.5, 0.25};
  const detail::ImplicitPolynomial<8> implicit{detail::LocalQuadric(f, r, height)};
  const double residual = implicit.residual(implicit.norm() * (1 + 0x1p-40));
  const auto exact = [&](const std::array<Rational, 3>& x) {
    Rational value = rational_of(f.constant.value);
    for (std::size_t i = 0; i < 3; ++i) {
      value += rational_of(f.linear[i].value) * x[i];
      for (std::size_t j = 0; j < 3; ++j) {
        value += rational_of(f.square[i][j].value) * x[i] * x[j];
      }
    }
    return value;
  };
  for (const double u : {-1.0, -0.375, 0.0, 1.0}) {
    for (const double v : {-1.0, 0.125, 1.0}) {
      const Rational z =
          rational_of(height) + value_of(implicit.polynomial(), rational_of(u), rational_of(v));
      const Rational value = exact({rational_of(r.s + r.a * u), rational_of(r.t + r.b * v), z});
      RC_ASSERT(abs(value) <= rational_of(residual));
    }
  }
}

// The same with a root: f = b - sqrt(r), in doubles, where r = 4 + a square.
RC_GTEST_PROP(ImplicitPolynomial, TheResidualWithARootIsInTheBound, ()) {
  UnitQuadric b;
  b.constant = detail::exactly(2 + random_coefficient(0.125));
  b.linear = {detail::exactly(random_coefficient(0.5)), detail::exactly(random_coefficient(0.5)),
              detail::exactly(2)};
  UnitQuadric root_square;
  root_square.constant = detail::exactly(4);
  for (std::size_t i = 0; i < 3; ++i) {
    b.square[i][i] = detail::exactly(random_coefficient(0.25));
    root_square.square[i][i] = detail::exactly(std::abs(random_coefficient(0.5)));
  }
  const Rectangle r{0.25, -0.125, 0.5, 0.25};
  const detail::ImplicitPolynomial<8> implicit(detail::LocalQuadric(b, r, 0),
                                               detail::LocalQuadric(root_square, r, 0), -1);
  const double residual = implicit.residual(implicit.norm() * (1 + 0x1p-40));
  RC_ASSERT(residual < 1);
  for (const double u : {-1.0, -0.375, 0.0, 1.0}) {
    for (const double v : {-1.0, 0.125, 1.0}) {
      const double z =
          nearest_double(value_of(implicit.polynomial(), rational_of(u), rational_of(v)));
      const UnitQuadric::Vector x{detail::exactly(r.s + r.a * u), detail::exactly(r.t + r.b * v),
                                  detail::exactly(z)};
      RC_ASSERT(std::abs(b(x).value - std::sqrt(root_square(x).value)) <= residual + 1e-14);
    }
  }
}

// No graph where the surface is upright, or has no point.
TEST(Graph, IsNotFoundWhereThereIsNone) {
  UnitQuadric f;
  f.constant = detail::exactly(-1);
  for (std::size_t i = 0; i < 3; ++i) f.square[i][i] = detail::exactly(1);
  const detail::UnitSurface surface(f);
  EXPECT_FALSE(Graph::find(surface, Rectangle{0.75, 0, 0.25, 0.25}));
  EXPECT_FALSE(Graph::find(surface, Rectangle{2, 2, 0.25, 0.25}));
  EXPECT_TRUE(Graph::find(surface, Rectangle{0.5, 0, 0.125, 0.125}));
}

// max(0, u - c v^2 - d) where |d| + |c| <= 1: the mean of (1 - d - c v^2)^2 / 4 over v.
RC_GTEST_PROP(MeanOfPositivePart, BeyondAParabola, ()) {
  const double c = random_coefficient(0.5);
  const double d = random_coefficient(0.5);
  const bool is_along_v = *rc::gen::arbitrary<bool>();
  const double sign = *rc::gen::element(-1.0, 1.0);
  detail::PartedPolynomial<8> t;
  t.set(1, is_along_v ? detail::HomogeneousPart<8>{sign, 0} : detail::HomogeneousPart<8>{0, sign});
  t.set(2, is_along_v ? detail::HomogeneousPart<8>{0, 0, -c} : detail::HomogeneousPart<8>{-c});
  const CertifiedDouble mean = detail::mean_of_positive_part(-d, t, 0);
  const Rational e = 1 - rational_of(d);
  const Rational exact =
      (e * e - 2 * e * rational_of(c) / 3 + rational_of(c) * rational_of(c) / 5) / 4;
  RC_ASSERT(contains(mean, exact));
  RC_ASSERT(mean.error < 1e-11);
}

// LAW positive_part.1: sums over a grid of 400 x 400 points are off by less than the square of what
// the function varies by in one of its cells, in the cells that the curve crosses.
RC_GTEST_PROP(MeanOfPositivePart, OfAPolynomial, ()) {
  detail::PartedPolynomial<8> t;
  double most = 0.5;
  for (std::size_t n = 1; n <= 8; ++n, most /= 3) {
    detail::HomogeneousPart<8> part{};
    for (std::size_t i = 0; i <= n; ++i) part[i] = random_coefficient(most);
    t.set(n, part);
  }
  const double d = random_coefficient(0.5);
  const double error = *rc::gen::element(0.0, 0x1p-10);
  constexpr int n = 400;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double u = (2 * i + 1) / double{n} - 1;
      const double v = (2 * j + 1) / double{n} - 1;
      double value = d;
      for (std::size_t k = 1; k <= 8; ++k) {
        double part = 0;  // in u, v homogeneous
        double power_of_v = 1;
        for (std::size_t l = k + 1; l-- > 0; power_of_v *= v) {
          part += t[k][l] * power_of_v * std::pow(u, static_cast<double>(l));
        }
        value += part;
      }
      sum += std::max(0.0, value + error);
    }
  }
  const CertifiedDouble mean = detail::mean_of_positive_part(d, t, error);
  RC_ASSERT(std::abs(sum / (n * n) - mean.value) <= mean.error + 3e-5);
}

// Where a paraboloid's graph crosses a plane: the error falls by 2^5 at least, rectangle by half.
TEST(MeanOfPositivePart, TheErrorFallsAsTheFifthPower) {
  double before = 0;
  for (const double size : {0.5, 0.25, 0.125, 0.0625}) {
    detail::PartedPolynomial<8> t;
    t.set(1, {0.25 * size, size});
    t.set(2, {0.25 * size * size, 0.5 * size * size, 0.125 * size * size});
    const CertifiedDouble mean = detail::mean_of_positive_part(0.125 * size, t, 0);
    if (before != 0) {
      EXPECT_LT(mean.error, before / 30);
    }
    before = mean.error;
  }
  EXPECT_LT(before, 1e-8);
}

// Sums over a grid of 400 x 400 points are off by less than (p + q)^2 / 400^2 of the mean.
RC_GTEST_PROP(MeanOfPositivePart, IsTheMean, ()) {
  const double d = *rc::gen::inRange(-30, 31) / 16.0;
  const double p = *rc::gen::inRange(0, 17) / 16.0;
  const double q = *rc::gen::inRange(0, 17) / 16.0;
  constexpr int n = 400;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      sum += std::max(0.0, d + p * ((2.0 * i + 1) / n - 1) + q * ((2.0 * j + 1) / n - 1));
    }
  }
  const double mean = detail::mean_of_positive_part(d, p, q);
  RC_ASSERT(std::abs(mean - sum / (n * n)) <= 1e-5 * (p + q) + 1e-12);
  RC_ASSERT(mean == detail::mean_of_positive_part(d, q, p));
}

// LAW surface_table.1 and 2
RC_GTEST_PROP(SurfaceTable, LiteralsHaveThePointsOfTheirPrimitives, ()) {
  SurfaceTable<HalfSpace<3>> table;
  const HalfSpace<3> original = random_primitive().primitive();
  for (const int factor : {1, 3, -2}) {
    if (factor < 0 && original.nappe()) continue;
    const domain::Quadric<3> f = Rational(factor) * original.polynomial();
    const HalfSpace<3> scaled =
        original.nappe() ? HalfSpace<3>(f, original.nappe()->linear()) : HalfSpace<3>(f);
    for (const HalfSpace<3>& half_space : {scaled, complement(scaled)}) {
      const Literal literal = table.add(half_space);
      const HalfSpace<3>& surface = table[literal.surface];
      const HalfSpace<3> meant = literal.is_complemented ? complement(surface) : surface;
      for (int i = 0; i < 8; ++i) {
        const Point<3> p = random_point();
        RC_ASSERT(classify(meant, p) == classify(half_space, p));
      }
    }
  }
  RC_ASSERT(table.size() == 1U);
}

}  // namespace
}  // namespace exactcsg::measure::test
