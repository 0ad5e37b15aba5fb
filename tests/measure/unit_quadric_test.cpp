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
// error falls by 2^8, as LAW graph.2 says.
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
      EXPECT_LT(integral.error, before / 200);
    }
    before = integral.error;
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
