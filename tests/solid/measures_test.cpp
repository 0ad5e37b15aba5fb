// SPDX-License-Identifier: GPL-3.0-or-later
// Volume, area, centre of mass: against closed forms, in both ways of computing.
#include "exactcsg/solid/measures.hpp"

#include <gtest/gtest.h>

#include <chrono>

#include "exactcsg/solid/figures.hpp"
#include "exactcsg/support/error.hpp"
#include "solid/boundary_builder.hpp"
#include "solid/polyhedra.hpp"

namespace exactcsg {
namespace {

using namespace test;

Rational power(const Rational& base, int n) {
  Rational p = 1;
  for (int i = 0; i < n; ++i) p *= base;
  return p;
}

// 1 + 1/(2^n - 1): with n = 127, 521, 607 (Mersenne primes) the denominators have no common factor,
// and together more bits than the integer path takes.
Rational long_number(unsigned n) {
  Integer p = 1;
  p <<= n;
  p -= 1;
  return 1 + Rational(Integer(1), p);
}

bool holds(const Enclosure& e, const Rational& value) {
  return e.lower <= value && value <= e.upper;
}

TEST(Measures, BoxInClosedForm) {
  // 2 x 3 x 5/7: V = 30/7, A = 2 (6 + 10/7 + 15/7) = 134/7.
  const Boundary box = boundary_of(to_polyhedron(*make_box({0, 0, 0}, {2, 3, {5, 7}}).polyhedron));
  EXPECT_EQ(exact_volume(box), Rational(30, 7));
  EXPECT_EQ(exact_area(box), Rational(134, 7));
  EXPECT_EQ(exact_centroid(box), (Point3{1, {3, 2}, {5, 14}}));
  // LAW measures.2
  EXPECT_EQ(enclose_volume(box, 64).lower, Rational(30, 7));
  EXPECT_EQ(enclose_volume(box, 64).upper, Rational(30, 7));
  EXPECT_EQ(enclose_area(box, 64).lower, Rational(134, 7));
  EXPECT_EQ(enclose_area(box, 64).upper, Rational(134, 7));
  const auto bounds = bounding_box(box);
  ASSERT_TRUE(bounds);
  EXPECT_EQ(bounds->lower, (Point3{0, 0, 0}));
  EXPECT_EQ(bounds->upper, (Point3{2, 3, {5, 7}}));
}

TEST(Measures, LShapeAndHoleAndCavity) {
  // Volume: the number of cubes; area: of exposed unit faces.
  const Boundary l = boundary_of_cells({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  EXPECT_EQ(exact_volume(l), 3);
  EXPECT_EQ(exact_area(l), 14);
  // Mean of the cubes' centres (1/2, 1/2), (3/2, 1/2), (1/2, 3/2).
  EXPECT_EQ(exact_centroid(l), (Point3{{5, 6}, {5, 6}, {1, 2}}));
  const Boundary ring = boundary_of_cells(without(block({0, 0, 0}, {3, 3, 1}), {{1, 1, 0}}));
  EXPECT_EQ(exact_volume(ring), 8);
  EXPECT_EQ(exact_area(ring), 8 + 8 + 12 + 4);
  const Boundary hollow = boundary_of_cells(without(block({0, 0, 0}, {3, 3, 3}), {{1, 1, 1}}));
  EXPECT_EQ(exact_volume(hollow), 26);
  EXPECT_EQ(exact_area(hollow), 54 + 6);
  EXPECT_EQ(exact_centroid(hollow), (Point3{{3, 2}, {3, 2}, {3, 2}}));
}

TEST(Measures, MengerSponges) {
  // V = (20/27)^n, A = 2 (20/9)^n + 4 (8/9)^n (Wikipedia, "Menger sponge"; level 0 gives 1 and 6,
  // level 1 gives 20/27 and 8: 72 exposed faces of 1/9).
  for (int n = 0; n <= 2; ++n) {
    const Boundary sponge = boundary_of_cells(menger_cells(n), power({1, 3}, n));
    EXPECT_EQ(exact_volume(sponge), power({20, 27}, n));
    EXPECT_EQ(exact_area(sponge), 2 * power({20, 9}, n) + 4 * power({8, 9}, n));
    EXPECT_EQ(exact_centroid(sponge), (Point3{{1, 2}, {1, 2}, {1, 2}}));
  }
}

TEST(Measures, InscribedTetrahedron) {
  // In the unit cube: 1/3, edges of length sqrt 2, so the area is sqrt 3 2 = 3.46410161513775458...
  const Polyhedron t{{{0, 0, 0}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1}},
                     {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}};
  const bool turned = enclose_volume(boundary_of(t), 64).upper == 0;
  const Boundary b = boundary_of(turned ? reversed(t) : t);
  EXPECT_EQ(exact_volume(b), Rational(1, 3));
  EXPECT_EQ(exact_area(b), std::nullopt);  // irrational
  for (const int bits : {16, 64, 200}) {
    const Enclosure area = enclose_area(b, bits);
    EXPECT_LE(area.lower * area.lower, 12);
    EXPECT_GE(area.upper * area.upper, 12);
    EXPECT_LT((area.upper - area.lower) * power(2, bits - 8), 1);  // LAW measures.1
  }
  EXPECT_EQ(measure(b, 20).area_decimal, "3.4641016151377545871");
}

TEST(Measures, LongDenominatorsAgreeWithClosedForms) {
  const Rational a = long_number(127);
  const Rational b = long_number(521);
  const Rational c = long_number(607);
  const Boundary t = boundary_of(tetrahedron(a, b, c));
  // A corner of a box: abc/6, centre at a quarter of each leg.
  EXPECT_EQ(exact_volume(t), a * b * c / 6);
  EXPECT_EQ(exact_centroid(t), (Point3{a / 4, b / 4, c / 4}));
  const std::array<Rational, 3> centre{a / 4, b / 4, c / 4};
  for (const int bits : {8, 32, 100, 1000}) {
    const MeasureEnclosures m = enclose_measures(t, bits);
    EXPECT_TRUE(holds(m.volume, a * b * c / 6)) << bits;
    EXPECT_LT((m.volume.upper - m.volume.lower) * power(2, bits - 8), 8) << bits;
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_TRUE(holds((*m.centroid)[i], centre[i])) << bits;
      if (bits >= 100) {
        EXPECT_LT(((*m.centroid)[i].upper - (*m.centroid)[i].lower) * power(2, bits - 20), 1);
      }
    }
    // (A - (ab + bc + ca)/2)^2 = ((ab)^2 + (bc)^2 + (ca)^2)/4, the slanted face's.
    const Rational legs = (a * b + b * c + c * a) / 2;
    const Rational slanted = (a * a * b * b + b * b * c * c + c * c * a * a) / 4;
    const Rational low = std::max<Rational>(0, m.area.lower - legs);
    EXPECT_LE(low * low, slanted);
    EXPECT_GE((m.area.upper - legs) * (m.area.upper - legs), slanted);
  }
  EXPECT_EQ(exact_volume(t, 100), std::nullopt);
  EXPECT_EQ(exact_centroid(t, 100), std::nullopt);
  // A box of such sides has a rational area.
  const Boundary box = boundary_of(to_polyhedron(*make_box({0, 0, 0}, {a, b, c}).polyhedron));
  EXPECT_EQ(exact_area(box), 2 * (a * b + b * c + c * a));
  EXPECT_EQ(exact_area(box, 100), std::nullopt);
  EXPECT_EQ(exact_volume(box), a * b * c);
}

TEST(Measures, VeryLargeAndVerySmallSolids) {
  const Rational tiny = parse_rational("1e-300").value() * long_number(127) * long_number(521);
  const Rational huge = parse_rational("1e300").value() * long_number(127) * long_number(521);
  for (const Rational& s : {tiny, huge}) {
    const Boundary t = boundary_of(tetrahedron(s, s, s));
    EXPECT_TRUE(holds(enclose_volume(t, 80), s * s * s / 6));
    EXPECT_EQ(measure(t).volume_decimal, to_decimal(s * s * s / 6, 17));
  }
}

TEST(Measures, TheEmptySolid) {
  const Boundary nothing;
  EXPECT_EQ(exact_volume(nothing), 0);
  EXPECT_EQ(exact_area(nothing), 0);
  EXPECT_EQ(enclose_area(nothing, 64).upper, 0);
  EXPECT_EQ(bounding_box(nothing), std::nullopt);
  EXPECT_THROW(
      try { enclose_centroid(nothing, 64); } catch (const Error& e) {
        EXPECT_EQ(e.id(), ErrorId::EmptySolid);
        throw;
      },
      Error);
  EXPECT_THROW(
      try { exact_centroid(nothing); } catch (const Error& e) {
        EXPECT_EQ(e.id(), ErrorId::EmptySolid);
        throw;
      },
      Error);
  const MeasuredFigures figures = measure(nothing);
  EXPECT_EQ(figures.volume_decimal, "0");
  EXPECT_EQ(figures.area_decimal, "0");
  EXPECT_FALSE(figures.centroid_decimals);
}

// LAW figures.1 on ties, which no enclosure of positive width decides: to even.
TEST(Figures, TiesAreRoundedToEven) {
  // 1 x 1 x 5/4: V = 1.25, A = 2 + 5 = 7.
  const MeasuredFigures m =
      measure(boundary_of(to_polyhedron(*make_box({0, 0, 0}, {1, 1, {5, 4}}).polyhedron)), 2);
  EXPECT_EQ(m.volume_decimal, "1.2");
  EXPECT_EQ(m.exact_volume, Rational(5, 4));
  EXPECT_EQ(m.area_decimal, "7");
  EXPECT_EQ((*m.centroid_decimals)[2], "0.62");  // 0.625
  // 0.1 x 0.1 x 0.575: A = 0.02 + 0.4 * 0.575 = 0.25, not a sum of powers of two.
  const Rational tenth(1, 10);
  EXPECT_EQ(
      measure(
          boundary_of(to_polyhedron(*make_box({0, 0, 0}, {tenth, tenth, {575, 1000}}).polyhedron)),
          1)
          .area_decimal,
      "0.2");
}

TEST(Figures, ZeroCentroidBySymmetryAndByExactSums) {
  const Rational a = long_number(127);
  const Rational b = long_number(521);
  const Rational c = long_number(607);
  const MeasuredFigures even = measure(boundary_of(octahedron(a, b, c)));
  EXPECT_EQ(*even.centroid_decimals, (std::array<std::string, 3>{"0", "0", "0"}));
  EXPECT_EQ(even.exact_volume, 4 * a * b * c / 3);  // two pyramids of base 2ab, height c
  EXPECT_TRUE(even.unproved.empty());
  // A tetrahedron moved so that its centre is at the origin has no such symmetry.
  const MeasuredFigures odd =
      measure(boundary_of(tetrahedron(a, b, c), test::translation(-a / 4, -b / 4, -c / 4)));
  EXPECT_EQ(*odd.centroid_decimals, (std::array<std::string, 3>{"0", "0", "0"}));
  EXPECT_TRUE(odd.unproved.empty());
  // Moved by 10^-40 more, the figure is that.
  const MeasuredFigures off = measure(boundary_of(
      tetrahedron(a, b, c), test::translation(parse_rational("1e-40").value() - a / 4, 0, -c / 4)));
  EXPECT_EQ((*off.centroid_decimals)[0], "1e-40");
}

// Leaving out the centre of mass changes nothing else; by grid and by exact integers.
TEST(Figures, VolumeAndAreaAlone) {
  for (const Rational& side : {Rational(2, 3), long_number(40009)}) {
    const Boundary boundary = boundary_of(octahedron(side, 1, 2));
    const MeasuredFigures all = measure(boundary);
    const MeasuredFigures some = measure(boundary, 17, 4096, Wanted::VolumeAndArea);
    EXPECT_EQ(some.volume_decimal, all.volume_decimal);
    EXPECT_EQ(some.exact_volume, all.exact_volume);
    EXPECT_EQ(some.area_decimal, all.area_decimal);
    EXPECT_FALSE(some.centroid_decimals);
  }
}

// A figure that is a decimal is where enclosures never agree. Here exact sums are beyond all
// limits, so that only the symmetry about the middle of the bounding box can prove it.
TEST(Figures, CentroidBySymmetryAboutAnyPoint) {
  const Rational a = long_number(40009);
  const Rational b = long_number(50021);
  const Boundary moved = boundary_of(octahedron(a, a, b), test::translation({1, 2}, 20, {-5, 4}));
  const MeasuredFigures m = measure(moved);
  EXPECT_EQ(*m.centroid_decimals, (std::array<std::string, 3>{"0.5", "20", "-1.25"}));
  EXPECT_TRUE(m.unproved.empty());
}

TEST(Figures, AllDigitsAskedFor) {
  const Boundary third =
      boundary_of(to_polyhedron(*make_box({0, 0, 0}, {1, 1, {1, 3}}).polyhedron));
  EXPECT_EQ(measure(third, 5).volume_decimal, "0.33333");
  EXPECT_EQ(measure(third, 100).volume_decimal, "0." + std::string(100, '3'));
}

// 200 000 vertices, with a grid and with exact integers.
TEST(Measures, LargeBoundariesAreFast) {
  for (const Rational& side : {Rational(1, 3), Rational(long_number(127) * long_number(521) / 3)}) {
    std::vector<Loops> unused;
    Boundary b;
    const Polyhedron cube = octahedron(side, side, side);
    const int n = 33000;
    b.plane_count = 8 * n;
    for (int i = 0; i < n; ++i) {
      const auto first = static_cast<std::uint32_t>(b.vertices.size());
      for (const Point3& p : cube.vertices) b.vertices.push_back({p.x + 3 * i, p.y, p.z});
      for (const Facet& f : cube.facets) {
        b.faces.push_back({0, {{first + f[0], first + f[1], first + f[2]}}});
      }
    }
    b.edges.resize(12 * n);
    const auto start = std::chrono::steady_clock::now();
    const Enclosure volume = enclose_volume(b, 128);
    const double first =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const Enclosure area = enclose_area(b, 128);
    const MeasureEnclosures all = enclose_measures(b, 128);
    const double total =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    RecordProperty("seconds_volume", std::to_string(first));
    RecordProperty("seconds_all", std::to_string(total));
    std::cout << "volume " << first << " s, three passes " << total << " s\n";
    EXPECT_TRUE(holds(volume, n * 4 * side * side * side / 3));
    EXPECT_TRUE(holds((*all.centroid)[0], Rational(3 * (n - 1), 2)));
    // 8 equilateral triangles with sides sqrt 2 s: 4 sqrt 3 s^2.
    const Rational square = Rational(48) * n * n * side * side * side * side;
    EXPECT_TRUE(area.lower * area.lower <= square && square <= area.upper * area.upper);
    EXPECT_LT(first, 10.0);  // loose: other work may run on the machine
  }
}

}  // namespace
}  // namespace exactcsg
