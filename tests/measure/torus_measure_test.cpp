// SPDX-License-Identifier: GPL-3.0-or-later
// Certified volumes of tori and proofs about them. Expected values: closed forms derived where they
// stand, and the surface's equation in long double.

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cmath>
#include <variant>

#include "exactcsg/measure/bounding_box.hpp"
#include "exactcsg/measure/moments.hpp"
#include "measure/curved_tori.hpp"
#include "measure/random_solids.hpp"

namespace exactcsg::measure::test {
namespace {

using detail::Graph;
using detail::Rectangle;
using detail::UnitSurface;

TEST(TorusVolume, ClosedFormsLieInTheBoundsAtEveryWidth) {
  for (const KnownTorus& known : known_tori()) {
    for (const double width : {1e-1, 1e-3}) {
      const CertifiedMeasure measure = volume(known.set, known.box, to_width(width));
      EXPECT_TRUE(encloses(measure.value, known.volume)) << known.name << " at " << width;
      EXPECT_EQ(measure.stop, StopReason::Width) << known.name << " at " << width;
    }
  }
}

// The length of the circles of radius rho above y = 3 is 2 rho acos(3 / rho), and the chord of the
// tube there 4 cos t at rho = 5 + 2 sin t: Simpson's rule on a function without kinks.
TEST(TorusVolume, TheGoldenValueOfTheFigureOfEight) {
  const auto integrand = [](double t) {
    const double rho = 5 + 2 * std::sin(t);
    return 2 * rho * std::acos(std::min(1.0, 3 / rho)) * 8 * std::cos(t) * std::cos(t);
  };
  constexpr int n = 20000;
  const double step = std::numbers::pi / n;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double t = -std::numbers::pi / 2 + i * step;
    sum += step / 6 * (integrand(t) + 4 * integrand(t + step / 2) + integrand(t + step));
  }
  EXPECT_NEAR(sum, beyond_saddle, 1e-9);
}

// --- the surface in a cell

// (rho - 1)^2 + z^2 - q, the same as base - 2 rho, of a torus round the z axis
long double equation(const std::array<long double, 3>& x, long double q) {
  const long double rho = std::sqrt(x[0] * x[0] + x[1] * x[1]);
  return (rho - 1) * (rho - 1) + x[2] * x[2] - q;
}

RC_GTEST_PROP(UnitSurface, ValuesAndDerivativesAreThoseOfTheTorus, ()) {
  const domain::Torus torus = unit_torus();
  const Rational half(1, 8);
  const Coordinates<3> centre{Rational(*rc::gen::inRange(4, 9), 8),
                              Rational(*rc::gen::inRange(-9, 9), 8),
                              Rational(*rc::gen::inRange(-4, 5), 8)};
  const Box<3> box(point(centre[0] - half, centre[1] - half, centre[2] - half),
                   point(centre[0] + half, centre[1] + half, centre[2] + half));
  const auto f = detail::local_polynomial(torus, box);
  RC_ASSERT(f.has_value());
  const auto random = [] { return *rc::gen::inRange(-8, 9) / 8.0; };
  const std::array<double, 3> u{random(), random(), random()};
  const auto value = [&](const std::array<double, 3>& at) {
    std::array<long double, 3> x{};
    for (std::size_t i = 0; i < 3; ++i) {
      x[i] = centre[i].get_d() + 0.125L * static_cast<long double>(at[i]);
    }
    return equation(x, 0.25L);
  };
  const auto holds = [](const CertifiedDouble& x, long double expected, double slack) {
    return std::abs(static_cast<double>(x.value - expected)) <= x.error + slack;
  };
  const auto vector = [](const std::array<double, 3>& at, double error) {
    return UnitSurface::Vector{CertifiedDouble{at[0], error}, CertifiedDouble{at[1], error},
                               CertifiedDouble{at[2], error}};
  };
  const auto moved = [](std::array<double, 3> at, std::size_t i, double by) {
    at[i] += by;
    return at;
  };
  RC_ASSERT(holds((*f)(vector(u, 0)), value(u), 1e-15));
  RC_ASSERT((*f)(vector(u, 0)).error < 1e-13);
  constexpr double e = 0x1p-12;
  for (std::size_t i = 0; i < 3; ++i) {
    // Central differences are off by e^2 and third derivatives.
    const long double slope = (value(moved(u, i, e)) - value(moved(u, i, -e))) / (2 * e);
    RC_ASSERT(holds(f->derivative(i, vector(u, 0)), slope, 1e-8));
    RC_ASSERT(holds(f->derivative(i, vector({0, 0, 0}, 1)), slope, 1e-8));
    RC_ASSERT(holds(f->derivative_in_cell(i), slope, 1e-8));
    for (std::size_t j = 0; j < 3; ++j) {
      const long double both =
          (value(moved(moved(u, i, e), j, e)) - value(moved(moved(u, i, e), j, -e)) -
           value(moved(moved(u, i, -e), j, e)) + value(moved(moved(u, i, -e), j, -e))) /
          (4 * e * e);
      RC_ASSERT(holds(f->half_second_derivative(i, j, vector(u, 0)), both / 2, 1e-7));
      RC_ASSERT(holds(f->half_second_derivative(i, j, vector({0, 0, 0}, 1)), both / 2, 1e-7));
    }
    const UnitSurface turned = f->with_height(i);
    RC_ASSERT(holds(turned({detail::exactly(u[(i + 1) % 3]), detail::exactly(u[(i + 2) % 3]),
                            detail::exactly(u[i])}),
                    value(u), 1e-15));
  }
  RC_ASSERT(holds((-*f)(vector(u, 0)), -value(u), 1e-15));
  const Rectangle r{0.25, -0.5, 0.75, 0.5};
  const std::array<double, 3> inside{r.s + r.a * u[0], r.t + r.b * u[1], u[2]};
  RC_ASSERT(holds(f->range_at(r, u[2]), value(inside), 1e-15));
}

// The top of the tube, over rectangles that halve: the error falls as LAW graph.2 says.
TEST(TorusGraph, IntegralOfTheTop) {
  const auto found = detail::local_polynomial(
      unit_torus(), Box<3>(point(Rational(3, 4), 0, Rational(1, 4)),
                           point(Rational(5, 4), Rational(1, 2), Rational(3, 4))));
  ASSERT_TRUE(found);
  double before = 0;
  for (const double size : {0.25, 0.125, 0.0625}) {
    const Rectangle r{0, 0, size, size};
    const auto graph = Graph::find(*found, r);
    ASSERT_TRUE(graph);
    const CertifiedDouble integral = graph->integral();
    // z = sqrt(1/4 - (rho - 1)^2) by Gauss's rule of three points on a grid of 64 x 64 squares.
    double reference = 0;
    const double node = std::sqrt(0.6);
    const double half = size / 64;
    for (int i = 0; i < 64 * 64; ++i) {
      const double s = -size + (2 * (i % 64) + 1) * half;
      const double t = -size + (2 * (i / 64) + 1) * half;
      for (int k = -1; k <= 1; ++k) {
        for (int l = -1; l <= 1; ++l) {
          const double x = 1 + 0.25 * (s + k * node * half);
          const double y = 0.25 + 0.25 * (t + l * node * half);
          const double rho = std::sqrt(x * x + y * y);
          const double weight = (k == 0 ? 8.0 : 5.0) * (l == 0 ? 8.0 : 5.0) / 81;
          const double height = (std::sqrt(0.25 - (rho - 1) * (rho - 1)) - 0.5) / 0.25;
          reference += weight * half * half * height;
        }
      }
    }
    EXPECT_LE(std::abs(integral.value - reference), integral.error + 1e-13);
    // Nearly 2^11, down to what rounding leaves.
    EXPECT_LT(integral.error, before == 0 ? 1e-2 : before / 1000 + 1e-14);
    before = integral.error;
  }
}

// LAW surface_table.2
TEST(TorusSurfaces, EqualOnesAreOne) {
  SurfaceTable<SurfaceHalfSpace> table;
  const Literal first = table.add(ring_of(5, 2));
  const domain::Torus again = domain::make_torus({{0, 0, 0}, {0, 0, -7}}, 5, 2, 2);
  EXPECT_EQ(table.add(again), first);
  EXPECT_EQ(table.add(complement(again)), (Literal{first.surface, true}));
  EXPECT_NE(table.add(ring_of(5, 1)).surface, first.surface);
  EXPECT_EQ(table.size(), 2U);
}

// --- extents and moments

// LAW bounding_box.1. As of other solids (bounding_box_test.cpp), the box is not much larger.
TEST(TorusExtent, ABoxHoldsIt) {
  for (const KnownTorus& known : known_tori()) {
    const Extent extent = bounding_box(known.set);
    ASSERT_EQ(extent.kind, ExtentKind::Bounded) << known.name;
    EXPECT_TRUE(encloses(volume(known.set, *extent.box, to_width(1e-2)).value, known.volume))
        << known.name;
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_LE(extent.box->upper()[i] - extent.box->lower()[i],
                4 * (known.box.upper()[i] - known.box.lower()[i]))
          << known.name;
    }
  }
}

TEST(TorusExtent, OfComplementsAndBesideOtherSurfaces) {
  const TorusSet ring = set(ring_of(5, 2));
  EXPECT_EQ(bounding_box(csg::complement(ring)).kind, ExtentKind::NotBounded);
  EXPECT_EQ(bounding_box(csg::unite(ring, half_space({1, 0, 0}, 0))).kind, ExtentKind::NotBounded);
  const Extent hole =
      bounding_box(csg::intersect(csg::complement(ring), set(domain::make_sphere({0, 0, 0}, 9))));
  ASSERT_EQ(hole.kind, ExtentKind::Bounded);
  EXPECT_LE(hole.box->lower()[0], -3);
  EXPECT_GE(hole.box->upper()[2], 3);
  // Far from the origin: the box does not end before 1005 + 2.
  const TorusSet far = set(domain::make_torus({{1000, 0, 0}, {0, 1, 0}}, 5, 2, 2));
  const Extent there = bounding_box(far);
  ASSERT_EQ(there.kind, ExtentKind::Bounded);
  EXPECT_GE(there.box->upper()[0], 1007);
  EXPECT_LE(there.box->lower()[0], 993);
}

// By Pappus with rho symmetric about 5, the integral of z^2 is 10 pi times that over the disc,
// pi 2^4 / 4; the centroid is the centre.
TEST(TorusMoments, AboutThePlaneOfTheRing) {
  const TorusSet ring = set(ring_of(5, 2));
  const Box<3> box(point(-8, -8, -4), point(8, 8, 4));
  const CertifiedMeasure second = moment(ring, box, {0, 0, 2}, to_width(1e-4));
  EXPECT_EQ(second.stop, StopReason::Width);
  EXPECT_TRUE(encloses(second.value, 40 * std::numbers::pi * std::numbers::pi));
}

// --- proofs

Proof disjoint(const TorusSet& a, const TorusSet& b) {
  return prove_disjoint(a, b, Box<3>(point(-12, -12, -5), point(12, 12, 5)));
}
bool is_proved(const Proof& proof) { return std::holds_alternative<Proved>(proof); }

TEST(TorusProofs, WhatTouchesIsDisjoint) {
  const TorusSet ring = set(ring_of(5, 2));
  EXPECT_TRUE(is_proved(disjoint(ring, half_space({0, 0, -1}, -2))));    // z >= 2, along a circle
  EXPECT_TRUE(is_proved(disjoint(ring, half_space({-1, 0, 0}, -7))));    // x >= 7, in a point
  EXPECT_TRUE(is_proved(disjoint(ring, half_space({-3, 0, -4}, -25))));  // 15 + 10, slanted
  const domain::Axis axis{{0, 0, 0}, {0, 0, 1}};
  EXPECT_TRUE(is_proved(disjoint(ring, set(domain::make_cylinder(axis, 9)))));
  EXPECT_TRUE(is_proved(disjoint(ring, set(complement(domain::make_cylinder(axis, 49))))));
  EXPECT_TRUE(is_proved(disjoint(ring, set(domain::make_sphere({9, 0, 0}, 4)))));
  EXPECT_TRUE(is_proved(disjoint(ring, set(domain::make_torus({{0, 0, 3}, {0, 0, 1}}, 5, 1, 1)))));
}

TEST(TorusProofs, NestedToriContainEachOther) {
  const Box<3> box(point(-12, -12, -5), point(12, 12, 5));
  const TorusSet ring = set(ring_of(5, 2));
  EXPECT_TRUE(is_proved(prove_contains(ring, set(ring_of(5, 1)), box)));
  EXPECT_TRUE(is_proved(prove_contains(ring, set(ring_of(6, 1)), box)));  // touches at rho = 7
  EXPECT_FALSE(is_proved(prove_contains(set(ring_of(5, 1)), ring, box)));
}

TEST(TorusProofs, ThinOverlapsHaveWitnesses) {
  const TorusSet ring = set(ring_of(5, 2));
  const Rational almost = 2 - Rational(1, 10000);
  const TorusSet above = half_space({0, 0, -1}, Rational(-almost));
  const Proof proof = disjoint(ring, above);
  ASSERT_TRUE(std::holds_alternative<Refuted>(proof));
  const Point<3>& witness = std::get<Refuted>(proof).witnesses.front().point;
  EXPECT_EQ(classify(ring, witness), PointClass::In);
  EXPECT_EQ(classify(above, witness), PointClass::In);
}

// A ring that is sunk into a plate: by so little that no cell's centre is in both, the overlap is
// found, and nothing is left undecided.
TEST(TorusProofs, ARingSunkIntoAPlate) {
  const Box<3> box(point(-10, -10, -10), point(10, 10, 10));
  const TorusSet plate = half_space({0, 0, 1}, 0);
  for (const Rational& depth : {Rational(1, 1000), Rational(1, 1000000), Rational(1, 100000000)}) {
    const TorusSet ring =
        set(domain::make_torus({{0, 0, Rational(2 - depth)}, {0, 0, 1}}, 5, 2, 2));
    const std::array regions{ring, plate, csg::complement(csg::unite(ring, plate))};
    ProofLimits limits;
    limits.witnesses = 100;
    limits.cells = 2000;
    const Proof proof =
        prove_partition(std::span<const TorusSet>(regions), TorusSet::full(), box, limits);
    ASSERT_TRUE(std::holds_alternative<Refuted>(proof)) << to_text(depth);
    const auto& refuted = std::get<Refuted>(proof);
    EXPECT_TRUE(refuted.is_complete) << to_text(depth);
    ASSERT_EQ(refuted.witnesses.size(), 1U);
    EXPECT_EQ(refuted.witnesses.front().regions, (std::vector<std::size_t>{0, 1}));
  }
}

// The same beside a slanted plane, which is no wall of a cell: the lens is seen from the axis.
TEST(TorusProofs, AThinLensBesideASlantedPlane) {
  const TorusSet ring = set(ring_of(5, 2));
  // 3 x + 4 z >= 25 touches: 15 + 10.
  const Rational almost = 25 - Rational(1, 10000000);
  const Proof proof = disjoint(ring, half_space({-3, 0, -4}, Rational(-almost)));
  ASSERT_TRUE(std::holds_alternative<Refuted>(proof));
}

}  // namespace
}  // namespace exactcsg::measure::test
