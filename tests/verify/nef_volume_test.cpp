// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes of polyhedra within and round curved regions. Expected values: closed forms, which lie
// between the two; wrong volumes, which are refused.

#include "exactcsg/verify/nef_volume.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "exactcsg/verify/verify_geometry.hpp"

namespace exactcsg::verify {
namespace {

using std::numbers::pi;

io::openmc::Model model_of(const std::string& surfaces, const std::string& region) {
  return io::openmc::read_geometry("<geometry>" + surfaces +
                                       R"(<cell id="1" material="1" region=")" + region +
                                       R"("/></geometry>)",
                                   "test.xml");
}

std::string surface(int id, const std::string& type, const std::string& coefficients) {
  return "<surface id=\"" + std::to_string(id) + "\" type=\"" + type + "\" coeffs=\"" +
         coefficients + "\"/>";
}

domain::Box<3> cube(int half) {
  return {domain::Point<3>(-half, -half, -half), domain::Point<3>(half, half, half)};
}

NefVolume volume_of(const io::openmc::Model& model, int half, std::uint32_t segments = 24) {
  return nef_volume(model, model.cells[0].region, cube(half), segments, NefLimits{});
}

double width_of(const Enclosure& value) {
  return nearest_double(Rational(value.upper - value.lower));
}

struct ClosedForm {
  std::string name;
  std::string surfaces;
  std::string region;
  int half;
  double volume;
  double relative_width;  // of the bounds with 24 segments
};

// A regular 48-gon has 0.9971 of its circle's area, and the one round the circle 1.0014: a
// cylinder's bounds are 0.43 % apart. A ball's have half as many corners.
std::vector<ClosedForm> closed_forms() {
  const std::string turned_ellipsoid =
      // (3x + 4y)^2 / 100 + (4x - 3y)^2 / 25 + z^2 / 4 <= 1: semi-axes 2, 1 and 2
      "0.73 0.52 0.25 -0.72 0 0 0 0 0 -1";
  const std::string slanted_cylinder =
      // About (3, 0, 4), radius 1: (4x - 3z)^2 / 25 + y^2 <= 1
      "0.64 1 0.36 0 0 -0.96 0 0 0 -1";
  return {
      {"ball", surface(1, "sphere", "0 0 0 1"), "-1", 2, 4 * pi / 3, 0.06},
      {"outside of a ball", surface(1, "sphere", "0 0 0 1"), "1", 2, 64 - 4 * pi / 3, 0.006},
      {"outside of a ball, from a quadric", surface(1, "quadric", "-1 -1 -1 0 0 0 0 0 0 1"), "-1",
       2, 64 - 4 * pi / 3, 0.006},
      // A hole of radius 3 in a ball of radius 5 is 8 long: pi 8^3 / 6.
      {"ball less coaxial hole",
       surface(1, "sphere", "0 0 0 5") + surface(2, "z-cylinder", "0 0 3"), "-1 2", 6, 256 * pi / 3,
       0.12},
      {"crossing cylinders", surface(1, "z-cylinder", "0 0 1") + surface(2, "x-cylinder", "0 0 1"),
       "-1 -2", 2, 16.0 / 3, 0.01},
      {"cylinder and its complement within parentheses",
       surface(1, "y-cylinder", "0 0 1") + surface(2, "y-plane", "-1") + surface(3, "y-plane", "1"),
       "~(1 | -2 | 3)", 2, 2 * pi, 0.005},
      {"cone",
       surface(1, "x-cone", "-1 0 0 0.25") + surface(2, "x-plane", "1") +
           surface(3, "x-plane", "-1"),
       "-1 -2 3", 2, 2 * pi / 3, 0.005},
      {"two nappes",
       surface(1, "z-cone", "0 0 0 1") + surface(2, "z-plane", "1") + surface(3, "z-plane", "-1"),
       "-1 -2 3", 2, 2 * pi / 3, 0.005},
      {"turned ellipsoid", surface(1, "quadric", turned_ellipsoid), "-1", 4, 16 * pi / 3, 0.06},
      {"slanted cylinder",
       surface(1, "quadric", slanted_cylinder) + surface(2, "plane", "3 0 4 5") +
           surface(3, "plane", "3 0 4 -5"),
       "-1 -2 3", 3, 2 * pi, 0.005},
      // x y = z^2: about (1, 1, 0), 2 x y = u^2 - v^2: v^2 + 2 z^2 <= u^2, of height h an ellipse
      // with semi-axes h and h / sqrt 2; both nappes to u = sqrt 2.
      {"cone across the axes",
       surface(1, "quadric", "0 0 1 -1 0 0 0 0 0 0") + surface(2, "plane", "1 1 0 2") +
           surface(3, "plane", "1 1 0 -2"),
       "-1 -2 3", 4, 2 * pi * 2 / 3, 0.005},
  };
}

TEST(NefVolume, ClosedFormsLieBetweenThePolyhedra) {
  for (const ClosedForm& form : closed_forms()) {
    const NefVolume volume = volume_of(model_of(form.surfaces, form.region), form.half);
    ASSERT_TRUE(volume.bounds) << form.name << ": " << volume.reason;
    EXPECT_LT(nearest_double(volume.bounds->lower), form.volume) << form.name;
    EXPECT_GT(nearest_double(volume.bounds->upper), form.volume) << form.name;
    EXPECT_LT(width_of(*volume.bounds), form.relative_width * form.volume) << form.name;
  }
}

// Sides of length e are e^2 away from the circle.
TEST(NefVolume, TheWidthFallsAsTheInverseSquareOfTheSegments) {
  const io::openmc::Model model = model_of(
      surface(1, "z-cylinder", "0 0 1") + surface(2, "z-plane", "0") + surface(3, "z-plane", "1"),
      "-1 2 -3");
  const double of_twelve = width_of(*volume_of(model, 2, 12).bounds);
  const double of_48 = width_of(*volume_of(model, 2, 48).bounds);
  EXPECT_NEAR(of_twelve / of_48, 16, 1);
}

TEST(NefVolume, PlanesAreExact) {
  const NefVolume volume =
      volume_of(model_of(surface(1, "plane", "1 1 1 1") + surface(2, "x-plane", "0") +
                             surface(3, "y-plane", "0") + surface(4, "z-plane", "0"),
                         "-1 2 3 4"),
                2);
  ASSERT_TRUE(volume.bounds);
  EXPECT_EQ(volume.bounds->lower, Rational(1, 6));
  EXPECT_EQ(volume.bounds->upper, Rational(1, 6));
}

TEST(NefVolume, SurfacesThatAreNotFacetedAreNamed) {
  for (const char* coefficients : {
           "1 1 -1 0 0 0 0 0 0 -1",  // a hyperboloid of one sheet
           "1 1 -1 0 0 0 0 0 0 1",   // of two
           "1 1 0 0 0 0 0 0 -1 0",   // a paraboloid
           "1 0 0 0 0 0 0 1 0 0",    // a parabolic cylinder
           "1 -1 0 0 0 0 0 0 0 -1",  // a hyperbolic one
           "1 0 0 0 0 0 0 0 0 -1",   // two planes
           "1 -1 0 0 0 0 0 0 0 0",   // two that cross
       }) {
    const io::openmc::Model model =
        model_of(surface(1, "sphere", "0 0 0 1") + surface(7, "quadric", coefficients), "-1 -7");
    const NefVolume volume = volume_of(model, 2);
    EXPECT_FALSE(volume.bounds) << coefficients;
    EXPECT_NE(volume.reason.find("surface 7, a quadric"), std::string::npos) << volume.reason;
    const Check check = compare_with_nef("nef", {0, 1}, volume);
    EXPECT_EQ(check.verdict, Verdict::Skipped);
    EXPECT_EQ(check.explanation, volume.reason);
  }
}

TEST(NefVolume, AWrongVolumeIsRefused) {
  const io::openmc::Model model =
      model_of(surface(1, "z-cylinder", "0 0 1") + surface(2, "x-cylinder", "0 0 1"), "-1 -2");
  const NefVolume volume = volume_of(model, 2);
  const Rational right(16, 3);
  const auto verdict = [&](const Rational& lower, const Rational& upper) {
    return compare_with_nef("nef", {lower, upper}, volume).verdict;
  };
  EXPECT_EQ(verdict(right, right), Verdict::Passed);
  EXPECT_EQ(verdict(0, 100), Verdict::Passed);
  EXPECT_EQ(verdict(Rational(right * 104 / 100), Rational(right * 105 / 100)), Verdict::Failed);
  EXPECT_EQ(verdict(Rational(right * 95 / 100), Rational(right * 96 / 100)), Verdict::Failed);
}

TEST(NefVolume, WithoutTimeThereIsNone) {
  NefLimits limits;
  limits.seconds = 0;
  const io::openmc::Model model = model_of(surface(1, "sphere", "0 0 0 1"), "-1");
  const NefVolume volume = nef_volume(model, model.cells[0].region, cube(2), 24, limits);
  EXPECT_FALSE(volume.bounds);
  EXPECT_NE(volume.reason.find("over the budget"), std::string::npos) << volume.reason;
}

// The polyhedra's side of a surface is not the measures': a radius of 0.42 for 0.4096, of which the
// area is 5 % more.
TEST(VerifyGeometry, NefPolyhedraFindAFaultOfFivePercent) {
  io::openmc::Model model = io::openmc::read_geometry_file(std::string(EXACTCSG_SOURCE_DIR) +
                                                           "/data/openmc/pin_cell.xml");
  VerifyGeometryOptions options;
  options.relative_width = 1e-4;
  options.points = 1000;
  const Report right = verify_geometry(model, options);
  EXPECT_EQ(right.count(Verdict::Passed), 8U) << render_text(right);
  options.disabled = {"nef"};
  EXPECT_EQ(verify_geometry(model, options).checks.size(), 4U);
  options.disabled = {"sampling"};
  model.surfaces[0].coefficients[2] = Rational(42, 100);
  const Report wrong = verify_geometry(model, options);
  ASSERT_EQ(wrong.checks.size(), 4U);
  EXPECT_EQ(wrong.checks[0].name, "nef: cell 1");
  EXPECT_EQ(wrong.checks[0].verdict, Verdict::Failed) << render_text(wrong);
  EXPECT_EQ(wrong.checks[2].verdict, Verdict::Passed) << render_text(wrong);
}

}  // namespace
}  // namespace exactcsg::verify
