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
      // Pappus: 2 pi times the major radius times the area of the profile.
      {"torus", surface(1, "z-torus", "0 0 0 5 2 2"), "-1", 8, 40 * pi * pi, 0.03},
      {"elliptic torus along y", surface(1, "y-torus", "1 0 0 4 1 2"), "-1", 8, 16 * pi * pi, 0.03},
      {"outside of a torus along x", surface(1, "x-torus", "0 1 0 4 2 1"), "1", 8,
       4096 - 16 * pi * pi, 0.003},
      // The circular segment from 1 to 2 of a disc of radius 2, round an axis 5 away.
      {"torus above a plane", surface(1, "z-torus", "0 0 0 5 2 2") + surface(2, "z-plane", "1"),
       "-1 2", 8, 10 * pi * (4 * pi / 3 - std::sqrt(3.0)), 0.09},
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

// Tori without a hole, and one with a hole that is narrower than rounding leaves it.
TEST(NefVolume, ToriWithoutAHoleAreNamed) {
  for (const char* coefficients : {"0 0 0 1 2 2", "0 0 0 2 2 2", "0 0 0 2 2 1.9999999"}) {
    const NefVolume volume = volume_of(model_of(surface(7, "z-torus", coefficients), "-7"), 5);
    EXPECT_FALSE(volume.bounds) << coefficients;
    EXPECT_NE(volume.reason.find("surface 7, a z-torus"), std::string::npos) << volume.reason;
  }
}

// A ring so thin that no polygon of this many sides lies within.
TEST(NefVolume, AThinTorusHasAnEmptyPolyhedronWithin) {
  const NefVolume volume =
      volume_of(model_of(surface(1, "z-torus", "0 0 0 2 0.001 0.001"), "-1"), 5, 12);
  ASSERT_TRUE(volume.bounds) << volume.reason;
  EXPECT_EQ(volume.bounds->lower, 0);
  EXPECT_GT(nearest_double(volume.bounds->upper), 4 * pi * pi * 1e-6);
}

// The window is what is seen of the region: half of a cylinder through a slanted plane.
TEST(NefVolume, AWindowCutsTheRegion) {
  const io::openmc::Model model = model_of(
      surface(1, "z-cylinder", "0 0 1") + surface(2, "z-plane", "0") + surface(3, "z-plane", "1") +
          surface(4, "plane", "3 4 0 0") + surface(5, "z-torus", "0 0 0 5 2 2"),
      "-1 2 -3");
  const auto seen_through = [&](std::size_t surface) {
    return nef_volume(model, model.cells[0].region, cube(2), 24, NefLimits{},
                      io::openmc::HalfSpaceRegion::primitive(model.surfaces[surface].negative));
  };
  const NefVolume half = seen_through(3);
  ASSERT_TRUE(half.bounds) << half.reason;
  EXPECT_LT(nearest_double(half.bounds->lower), pi / 2);
  EXPECT_GT(nearest_double(half.bounds->upper), pi / 2);
  EXPECT_LT(width_of(*half.bounds), 0.01);
  EXPECT_FALSE(seen_through(4).bounds);
  EXPECT_NE(seen_through(4).reason.find("a surface above"), std::string::npos);
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

const Check& check_of(const Report& report, const std::string& name) {
  for (const Check& check : report.checks) {
    if (check.name == name) return check;
  }
  throw std::out_of_range(name);
}

VerifyGeometryOptions nef_only() {
  VerifyGeometryOptions options;
  options.relative_width = 1e-3;
  options.nef_seconds = 600;
  options.nef_segments = 16;
  options.disabled = {"sampling"};
  return options;
}

// Cells of universes in a lattice: what is wrong with a surface of theirs is found there.
TEST(VerifyGeometry, NefPolyhedraFindFaultsBelowTheRoot) {
  io::openmc::Model model = io::openmc::read_geometry_file(std::string(EXACTCSG_SOURCE_DIR) +
                                                           "/data/openmc/assembly_17x17.xml");
  EXPECT_EQ(verify_geometry(model, nef_only()).count(Verdict::Passed), 8U);
  model.surfaces[3].coefficients[2] = Rational(55, 100);  // the inside of the tubes, for 0.561
  const Report wrong = verify_geometry(model, nef_only());
  EXPECT_EQ(check_of(wrong, "nef: cell 5").verdict, Verdict::Failed) << render_text(wrong);
  EXPECT_EQ(check_of(wrong, "nef: cell 1").verdict, Verdict::Passed);
}

// Balls of radius 0.6 in elements of side 1, so that each is cut; a lattice turned by 30 degrees in
// a box that cuts it: the elements differ. Volumes: the sum of all is the box's.
TEST(VerifyGeometry, ElementsThatAreCutDifferentlyAreAddedUp) {
  const io::openmc::Model model = io::openmc::read_geometry(
      "<geometry><surface id='1' type='sphere' coeffs='0 0 0 0.6'/>"
      "<surface id='2' type='x-plane' coeffs='-1' boundary='vacuum'/>"
      "<surface id='3' type='x-plane' coeffs='1' boundary='vacuum'/>"
      "<surface id='4' type='y-plane' coeffs='-1' boundary='vacuum'/>"
      "<surface id='5' type='y-plane' coeffs='1' boundary='vacuum'/>"
      "<surface id='6' type='z-plane' coeffs='-0.5' boundary='vacuum'/>"
      "<surface id='7' type='z-plane' coeffs='0.5' boundary='vacuum'/>"
      "<cell id='1' universe='1' material='1' region='-1'/>"
      "<cell id='2' universe='1' material='2' region='1'/>"
      "<lattice id='9'><dimension>2 2</dimension><lower_left>-1 -1</lower_left><pitch>1 1</pitch>"
      "<outer>1</outer><universes>1 1 1 1</universes></lattice>"
      "<cell id='5' fill='9' region='2 -3 4 -5 6 -7' rotation='0 0 30'/></geometry>",
      "text");
  const Report report = verify_geometry(model, nef_only());
  EXPECT_EQ(report.count(Verdict::Passed), 3U) << render_text(report);
  EXPECT_NE(check_of(report, "nef: cell 1").explanation.find("different instances"),
            std::string::npos);
}

TEST(VerifyGeometry, InstancesBeyondTheBudgetAreSkippedWithTheReason) {
  const io::openmc::Model model = io::openmc::read_geometry_file(std::string(EXACTCSG_SOURCE_DIR) +
                                                                 "/data/openmc/assembly_17x17.xml");
  VerifyGeometryOptions options = nef_only();
  options.nef_seconds = 1e-9;
  const Report report = verify_geometry(model, options);
  EXPECT_EQ(report.count(Verdict::Skipped), 8U);
  EXPECT_NE(check_of(report, "nef: cell 1").explanation.find("over the budget"), std::string::npos);
}

}  // namespace
}  // namespace exactcsg::verify
