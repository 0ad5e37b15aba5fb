// SPDX-License-Identifier: GPL-3.0-or-later
// Each surface card against points whose side follows from the card's equation by hand, bodies
// against their closed forms and corners, and images against the originals.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "exactcsg/io/openmc/cell_volumes.hpp"
#include "io/mcnp_support.hpp"

namespace exactcsg::io::mcnp {
namespace {

using openmc::Model;
using openmc::Point;
using std::numbers::pi;

struct Sides {
  const char* card;
  Point negative, on, positive;
};
void PrintTo(const Sides& s, std::ostream* stream) { *stream << s.card; }

// The senses of the manual: the sign of the equation; what is beside each point says why.
const Sides sides[] = {
    {"px 2", {1, 9, 9}, {2, 5, 5}, {3, -9, -9}},
    {"py -3", {0, -4, 0}, {7, -3, 8}, {0, 0, 0}},
    {"pz 0.5", {0, 0, 0}, {1, 1, Rational(1, 2)}, {0, 0, 1}},
    {"p 1 2 3 6", {0, 0, 0}, {1, 1, 1}, {2, 2, 2}},     // x + 2y + 3z - 6
    {"p 0 -2 0 4", {0, 0, 0}, {5, -2, 5}, {0, -3, 0}},  // -2y - 4
    {"p 1 0 0  0 1 0  0 0 1", {0, 0, 0}, {1, 0, 0}, {1, 1, 1}},
    {"p 0 1 0  1 0 0  0 0 1", {0, 0, 0}, {0, 0, 1}, {1, 1, 1}},   // turned round: the same
    {"p 0 0 0  1 0 1  0 1 1", {1, 1, 0}, {1, 1, 2}, {0, 0, 1}},   // (0, 0, oo) is positive
    {"p 0 0 0  0 0 1  1 1 0", {1, 0, 0}, {1, 1, 5}, {0, 1, 0}},   // C = 0: (0, oo, 0) is
    {"p 0 0 0  0 0 1  0 1 0", {-1, 0, 0}, {0, 3, 5}, {1, 0, 0}},  // B = 0: (oo, 0, 0) is
    {"so 5", {1, 2, 3}, {3, 4, 0}, {5, 1, 0}},
    {"s 1 2 3 2", {1, 2, 3}, {1, 2, 5}, {1, 2, 6}},
    {"sx 3 1", {3, 0, 0}, {4, 0, 0}, {0, 0, 0}},
    {"sy 3 1", {0, 3, 0}, {0, 4, 0}, {0, 0, 0}},
    {"sz 3 1", {0, 0, 3}, {0, 0, 4}, {0, 0, 0}},
    {"sph 1 2 3 2", {1, 2, 3}, {1, 2, 5}, {1, 2, 6}},
    {"cx 5", {99, 3, 3}, {7, 3, 4}, {0, 5, 5}},
    {"cy 5", {3, 99, 3}, {3, 7, 4}, {5, 0, 5}},
    {"cz 5", {3, 3, 99}, {3, 4, 7}, {5, 5, 0}},
    {"c/x 1 2 1", {9, 1, 2}, {9, 1, 3}, {9, 2, 1}},  // y, z
    {"c/y 1 2 1", {1, 9, 2}, {1, 9, 3}, {2, 9, 1}},  // x, z
    {"c/z 1 2 1", {1, 2, 9}, {1, 3, 9}, {2, 1, 9}},  // x, y
    {"kx 1 0.25", {5, 1, 1}, {5, 2, 0}, {5, 3, 0}},  // y^2 + z^2 = (x - 1)^2 / 4
    {"ky 1 0.25", {1, -3, 1}, {2, -3, 0}, {3, 5, 0}},
    {"kz 1 4", {3, 0, -1}, {4, 0, 3}, {0, 5, 3}},
    {"kx 1 0.25 1", {5, 1, 1}, {5, 2, 0}, {-3, 0, 0}},  // the sheet towards +x alone
    {"kx 1 0.25 -1", {-3, 1, 1}, {-3, 2, 0}, {5, 0, 0}},
    {"ky 1 0.25 -1", {0, -3, 0}, {2, -3, 0}, {0, 5, 0}},
    {"kz 1 4 1", {0, 0, 2}, {4, 0, 3}, {0, 0, 0}},
    {"k/x 1 2 3 0.25", {5, 2, 3}, {5, 4, 3}, {5, 5, 3}},
    {"k/y 1 2 3 0.25 1", {1, 6, 3}, {3, 6, 3}, {1, -6, 3}},
    {"k/z 1 2 3 0.25 -1", {1, 2, 0}, {1, 4, -1}, {1, 2, 6}},
    // 1 (x-1)^2 + 4 (y-2)^2 - 16 + 2 * 3 (z-3)
    {"sq 1 4 0 0 0 3 -16 1 2 3", {1, 2, 3}, {5, 2, 3}, {1, 2, 9}},
    // x^2 + y^2 - 2 z
    {"gq 1 1 0 0 0 0 0 0 -2 0", {0, 0, 1}, {1, 1, 1}, {1, 1, 0}},
    // xy + 2 yz + 3 zx - 6: the order of the mixed terms
    {"gq 0 0 0 1 2 3 0 0 0 -6", {5, 1, 0}, {1, 1, 1}, {7, 1, 0}},
    {"gq 0 0 0 1 2 3 0 0 0 -6", {0, 1, 2}, {0, 1, 3}, {0, 1, 4}},
    {"gq 0 0 0 0 0 0 0 0 1 -3", {0, 0, 0}, {0, 0, 3}, {0, 0, 4}},  // a plane
    {"tx 1 0 0 5 1 2", {1, 5, 0}, {2, 5, 0}, {3, 5, 0}},           // B along the axis, C across it
    {"ty 0 1 0 5 1 2", {7 - 1, 1, 0}, {7, 1, 0}, {8, 1, 0}},
    {"tz 0 0 1 5 1 2", {0, 5, 1}, {0, 3, 1}, {0, 0, 1}},
    {"tz 0 0 0 0 1 2", {1, 0, 0}, {2, 0, 0}, {0, 0, 2}},  // no hole: an ellipsoid
    {"x 3 7", {0, 9, 9}, {3, 5, 5}, {4, 0, 0}},
    {"z 1 2 3 2", {1, 0, 99}, {0, 2, 9}, {3, 0, 0}},  // a cylinder
    {"y 1 2 1 5", {0, 0, 0}, {5, 1, 5}, {0, 2, 0}},   // a plane
    {"x 1 1 3 2", {1, 0, 0}, {1, 1, 0}, {-3, 0, 0}},  // r = (x + 1) / 2, one sheet
    {"x 3 1 1 2", {1, 0, 0}, {1, 2, 0}, {9, 0, 0}},   // r = (5 - x) / 2
    // The manual's example: -(x + 26.5)^2 / 12 + y^2 + z^2 + 68.52...
    {"x 7 5  3 2  4 3", {7, 4, 0}, {7, 5, 0}, {7, 6, 0}},
    {"x 7 5  3 2  4 3", {4, 0, 0}, {4, 0, 3}, {0, 0, 0}},
    {"z -1 0  0 1  1 0", {0, 0, 0}, {1, 0, 0}, {1, 1, 0}},  // the unit ball
    {"y 0 1  1 1  2 1", {0, 9, 0}, {1, 9, 0}, {2, 9, 0}},   // a cylinder by three
    {"box 0 0 0  3 4 0  -4 3 0  0 0 2", {0, 1, 1}, {0, 0, 1}, {0, 0, 3}},
    {"box 0 0 0  2 0 0  0 2 0", {1, 1, 99}, {2, 1, -99}, {3, 1, 1}},  // no end along z
    {"rpp -1 1 -2 2 -3 3", {0, 0, 0}, {1, 2, 3}, {0, 0, 4}},
    {"rcc 0 0 1  0 0 3  2", {1, 1, 2}, {0, 0, 4}, {0, 0, 5}},
    {"rcc 0 0 1  0 0 3  2", {1, 1, 2}, {2, 0, 2}, {0, 0, 0}},
    {"rhp 0 0 0  0 0 4  2 0 0", {2 - 1, 1, 1}, {2, 0, 1}, {2, 2, 1}},
    {"hex 0 0 0  0 0 4  2 0 0  0 2 0  -1 1 0", {0, 1, 1}, {0, 0, 0}, {-1, 2, 1}},
    {"rec 0 0 0  0 0 3  3 0 0  0 2 0", {2, 1, 1}, {3, 0, 1}, {0, 3, 1}},
    {"rec 0 0 0  0 0 3  3 0 0  2", {2, 1, 1}, {0, 2, 1}, {0, 3, 1}},
    {"trc 0 0 0  0 0 4  3 1", {2, 0, 1}, {2, 0, 2}, {2, 0, 3}},
    {"trc 0 0 0  0 0 4  1 3", {0, 2, 3}, {0, 2, 2}, {0, 2, 1}},
    {"ell 0 0 0  4 0 0  -2", {3, 0, 0}, {0, 2, 0}, {3, 2, 0}},
    {"wed 0 0 0  3 0 0  0 4 0  0 0 2", {1, 1, 1}, {3, 0, 1}, {3, 4, 1}},
    {"arb 0 0 0 2 0 0 2 2 0 0 2 0 1 1 3 0 0 0 0 0 0 0 0 0 1234 1250 2350 3450 4150 0",
     {1, 1, 1},
     {1, 1, 3},
     {0, 0, 1}},
};

class SurfaceCards : public testing::TestWithParam<Sides> {};

TEST_P(SurfaceCards, HaveTheSenseOfTheirEquation) {
  const Sides& s = GetParam();
  const Model inside = model_of("-1", std::string("1 ") + s.card);
  EXPECT_EQ(class_at(inside, s.negative), PointClass::In);
  EXPECT_EQ(class_at(inside, s.on), PointClass::On);
  EXPECT_EQ(class_at(inside, s.positive), PointClass::Out);
  const Model outside = model_of("1", std::string("1 ") + s.card);
  EXPECT_EQ(class_at(outside, s.negative), PointClass::Out);
  EXPECT_EQ(class_at(outside, s.on), PointClass::On);
  EXPECT_EQ(class_at(outside, s.positive), PointClass::In);
}

// LAW surface_card.3: a point is where its image is in the image, for every card, for an exact
// rotation and for a quarter turn that mirrors as well.
TEST_P(SurfaceCards, AreMovedByTransformations) {
  const Sides& s = GetParam();
  // Rows are the axes of the auxiliary system: x' = (0.6, 0.8, 0), ...
  const std::string turned = "tr5 1 2 3  0.6 0.8 0  -0.8 0.6 0  0 0 1\n";
  const std::string mirrored = "*tr5 1 2 3  90 0 90  90 90 180  0 90 90\n";
  const auto image = [](const Point& p, bool is_turned) {
    if (!is_turned) return Point(1 + p[2], 2 + p[0], 3 - p[1]);
    return Point(1 + Rational(3, 5) * p[0] - Rational(4, 5) * p[1],
                 2 + Rational(4, 5) * p[0] + Rational(3, 5) * p[1], 3 + p[2]);
  };
  const std::string card = s.card;
  for (const bool is_turned : {true, false}) {
    if (is_turned && (card.starts_with("tx") || card.starts_with("ty"))) continue;
    const std::string& transformation = is_turned ? turned : mirrored;
    const Model by_surface = model_of("-1", "1 5 " + card, transformation);
    const Model by_cell =
        read_geometry(deck_of("1 0 -1 trcl=5\n", "1 " + card + "\n", transformation), "text");
    for (const Model& model : {by_surface, by_cell}) {
      EXPECT_EQ(class_at(model, image(s.negative, is_turned)), PointClass::In);
      EXPECT_EQ(class_at(model, image(s.on, is_turned)), PointClass::On);
      EXPECT_EQ(class_at(model, image(s.positive, is_turned)), PointClass::Out);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Table, SurfaceCards, testing::ValuesIn(sides));

// The manual: "17 4 PX 5" with "TR4 7 .9 1.3 0 -1 0 0 0 1 -1 0 0" is "17 P 0 -1 0 4.1".
TEST(SurfaceCards, AreTheManualsExampleOfATransformation) {
  const Model model = model_of("-17", "17 4 px 5", "tr4 7 .9 1.3  0 -1 0  0 0 1  -1 0 0\n");
  EXPECT_EQ(class_at(model, {0, 0, 0}), PointClass::In);
  EXPECT_EQ(class_at(model, {0, Rational(-41, 10), 0}), PointClass::On);
  EXPECT_EQ(class_at(model, {0, -5, 0}), PointClass::Out);
}

// With M = -1 the displacement is that of the main origin in the auxiliary system: x' = B x + O.
TEST(SurfaceCards, AreMovedTheOtherWayRoundByMinusOne) {
  const Model model = model_of("-1", "1 5 sx 0 1", "tr5 10 0 0  0 1 0  -1 0 0  0 0 1  -1\n");
  // x' = y + 10: the centre x' = 0 is at y = -10.
  EXPECT_EQ(class_at(model, {0, -10, 0}), PointClass::In);
  EXPECT_EQ(class_at(model, {0, 10, 0}), PointClass::Out);
}

// Two rows give the third: x' along y, y' along z, so z' along x.
TEST(SurfaceCards, AreTurnedByTwoRows) {
  const Model model = model_of("-1", "1 5 pz 1", "tr5 0 0 0  0 1 0  0 0 1\n");
  EXPECT_EQ(class_at(model, {0, 9, 9}), PointClass::In);
  EXPECT_EQ(class_at(model, {2, 0, 0}), PointClass::Out);
}

// A rotation that is only nearly one is made an exact one: the image of a cylinder has its volume,
// and the images of planes at right angles are that exactly.
TEST(SurfaceCards, StayRigidUnderRoundedRotations) {
  const Model model = model_of("-1 -2 -3", "1 5 px 0\n2 5 py 0\n3 5 pz 0",
                               "tr5 0 0 0  0.866025 0.5 0  -0.5 0.866025 0  0 0 1\n");
  ASSERT_EQ(model.surfaces.size(), 3U);
  const auto normal = [&](std::size_t i) {
    return model.surfaces[i].negative.quadric()->polynomial().linear().normal;
  };
  for (std::size_t i = 0; i < 3; ++i) {
    const auto a = normal(i);
    const auto b = normal((i + 1) % 3);
    EXPECT_EQ(a[0] * b[0] + a[1] * b[1] + a[2] * b[2], 0);
  }
  const Rational x = normal(0)[0] / normal(0)[1];
  EXPECT_NEAR(nearest_double(x), std::sqrt(3.0), 1e-5);
}

struct Closed {
  openmc::Id cell;
  double volume;
};

// data/mcnp/bodies.mcnp: the closed forms of elementary geometry.
TEST(Bodies, HaveTheirVolumes) {
  const Model model = read_deck_file("bodies.mcnp");
  openmc::VolumeLimits limits;
  limits.relative_width = 1e-6;
  const openmc::GeometryVolumes volumes = openmc::measure_volumes(model, limits);
  const Closed expected[] = {{1, 5 * 5 * 2},
                             {2, 2 * 3 * 4},
                             {3, 4 * pi / 3 * 3.375},
                             {4, pi * 4 * 5},
                             {5, 2 * std::sqrt(3.0) * 4 * 4},
                             {6, pi * 3 * 2 * 3},
                             {7, pi * 4 / 3 * (9 + 3 + 1)},
                             {8, 4 * pi / 3 * 4 * 2 * 2},
                             {9, 3 * 4 / 2.0 * 2},
                             {10, 2 * 2 * 3 / 3.0}};
  double sum = 0;
  for (const Closed& e : expected) {
    const auto& volume = volumes.cells[static_cast<std::size_t>(e.cell - 1)].volume;
    ASSERT_EQ(model.cells[static_cast<std::size_t>(e.cell - 1)].id, e.cell);
    ASSERT_TRUE(volume) << e.cell;
    const double slack = 1e-13 * e.volume;
    EXPECT_LE(nearest_double(volume->lower), e.volume + slack) << e.cell;
    EXPECT_GE(nearest_double(volume->upper), e.volume - slack) << e.cell;
    EXPECT_LE(nearest_double(Rational(volume->upper - volume->lower)), 1.1e-6 * e.volume) << e.cell;
    sum += e.volume;
  }
  const auto& rest = volumes.cells[10].volume;
  ASSERT_TRUE(rest);
  const double room = 130.0 * 40 * 40 - sum;
  EXPECT_LE(nearest_double(rest->lower), room * (1 + 1e-13));
  EXPECT_GE(nearest_double(rest->upper), room * (1 - 1e-13));
}

// Bodies that lie across the axes, of the same closed forms.
TEST(Bodies, HaveTheirVolumesAcrossTheAxes) {
  const struct {
    const char* card;
    double volume;
  } cases[] = {
      {"rcc 1 2 3  2 4 4  1.5", pi * 2.25 * 6},
      {"trc 1 2 3  2 4 4  2 1", pi * 6 / 3 * (4 + 2 + 1)},
      {"trc 1 2 3  2 4 4  2 0", pi * 6 / 3 * 4},
      {"rec 1 2 3  2 4 4  2 1 -2  1.5", pi * 3 * 1.5 * 6},
      {"rec 1 2 3  2 4 4  2 1 -2  2 -2 1", pi * 3 * 3 * 6},
      {"ell 1 2 3  2 4 4  -1", 4 * pi / 3 * 6},
      {"wed 1 2 3  2 4 4  2 1 -2  2 -2 1", 6 * 3 * 3 / 2.0},
      {"box 1 2 3  2 4 4  2 1 -2  2 -2 1", 6 * 3 * 3},
      {"rhp 1 2 3  2 4 4  2 1 -2", 2 * std::sqrt(3.0) * 9 * 6},
  };
  for (const auto& c : cases) {
    const Model model = model_of("-1", std::string("1 ") + c.card);
    openmc::VolumeLimits limits;
    limits.relative_width = 1e-3;
    const auto volume = openmc::measure_volumes(model, limits).cells.front().volume;
    ASSERT_TRUE(volume) << c.card;
    const double slack = 1e-13 * c.volume;
    EXPECT_LE(nearest_double(volume->lower), c.volume + slack) << c.card;
    EXPECT_GE(nearest_double(volume->upper), c.volume - slack) << c.card;
    EXPECT_LE(nearest_double(Rational(volume->upper - volume->lower)), 1.1e-3 * c.volume);
  }
}

// LAW surface_card.2. A point beyond one facet alone is at its positive side and at the negative
// side of all others.
TEST(Bodies, NumberTheirFacetsAsTheManualSays) {
  const struct {
    const char* card;
    std::vector<Point> beyond;
  } cases[] = {
      {"box 0 0 0  2 0 0  0 2 0  0 0 2",
       {{3, 1, 1}, {-1, 1, 1}, {1, 3, 1}, {1, -1, 1}, {1, 1, 3}, {1, 1, -1}}},
      {"rpp 0 2 0 2 0 2", {{3, 1, 1}, {-1, 1, 1}, {1, 3, 1}, {1, -1, 1}, {1, 1, 3}, {1, 1, -1}}},
      {"rcc 0 0 0  0 0 4  2", {{3, 0, 1}, {0, 0, 5}, {0, 0, -1}}},
      // Its vectors to the sides are at 0, 60 and 120 degrees.
      {"rhp 0 0 0  0 0 4  2 0 0",
       {{Rational(21, 10), 0, 1},
        {Rational(-21, 10), 0, 1},
        {Rational(21, 20), Rational(182, 100), 1},
        {Rational(-21, 20), Rational(-182, 100), 1},
        {Rational(-21, 20), Rational(182, 100), 1},
        {Rational(21, 20), Rational(-182, 100), 1},
        {0, 0, 5},
        {0, 0, -1}}},
      {"rec 0 0 0  0 0 3  3 0 0  0 2 0", {{0, 3, 1}, {0, 0, 4}, {0, 0, -1}}},
      {"wed 0 0 0  3 0 0  0 4 0  0 0 2",
       {{3, 4, 1}, {-1, 1, 1}, {1, -1, 1}, {1, 1, 3}, {1, 1, -1}}},
      {"arb 0 0 0 2 0 0 2 2 0 0 2 0 1 1 3 0 0 0 0 0 0 0 0 0 1234 1250 2350 3450 4150 0",
       {{1, 1, -1}, {1, -1, 1}, {3, 1, 1}, {1, 3, 1}, {-1, 1, 1}}},
  };
  for (const auto& c : cases) {
    for (std::size_t facet = 1; facet <= c.beyond.size(); ++facet) {
      const Model model = model_of("-1." + std::to_string(facet), std::string("1 ") + c.card);
      ASSERT_EQ(model.surfaces.size(), 1U);
      EXPECT_EQ(openmc::label_of(model.surfaces.front()), "1." + std::to_string(facet));
      for (std::size_t other = 1; other <= c.beyond.size(); ++other) {
        EXPECT_EQ(class_at(model, c.beyond[other - 1]),
                  other == facet ? PointClass::Out : PointClass::In)
            << c.card << ", facet " << facet << " at the point beyond " << other;
      }
    }
  }
}

TEST(Bodies, PassTheirBoundaryOnToTheirFacets) {
  const Model model = model_of("-1 -2 3", "*1 rpp 0 1 0 1 0 1\n+2 kz 0 1 1\n3 -4 px 0\n4 -3 px 1");
  ASSERT_EQ(model.surfaces.size(), 10U);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(model.surfaces[i].boundary, openmc::Boundary::Reflective);
  }
  EXPECT_EQ(model.surfaces[6].boundary, openmc::Boundary::White);
  EXPECT_EQ(model.surfaces[7].boundary, openmc::Boundary::Transmission);  // cuts the other sheet
  EXPECT_EQ(model.surfaces[8].boundary, openmc::Boundary::Periodic);
  EXPECT_EQ(model.surfaces[9].boundary, openmc::Boundary::Periodic);
}

}  // namespace
}  // namespace exactcsg::io::mcnp
