// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes from random points, and reports that hold certified volumes against them. Expected
// values: closed forms within six deviations; faults that are planted.

#include "exactcsg/verify/monte_carlo.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "exactcsg/verify/verify_geometry.hpp"

namespace exactcsg::verify {
namespace {

using std::numbers::pi;

io::openmc::Model read(const std::string& name) {
  return io::openmc::read_geometry_file(std::string(EXACTCSG_SOURCE_DIR) + "/data/openmc/" + name +
                                        ".xml");
}

// Radii 0.4096, 0.418 and 0.475, height 20, in a square of 1.26; the box is twice as high.
TEST(MonteCarlo, EstimatesAPinCell) {
  const io::openmc::Model model = read("pin_cell");
  const SamplingBox box{{-0.63, -0.63, -20}, {0.63, 0.63, 20}};
  const auto sampled = sample_volumes(model, box, 200'000, 1);
  const double fuel = 20 * pi * 0.4096 * 0.4096;
  const double all = 20 * 1.26 * 1.26;
  EXPECT_LT(std::abs(sampled[0].estimate - fuel), 6 * sampled[0].deviation);
  EXPECT_LT(std::abs(sampled[3].estimate - (all - 20 * pi * 0.475 * 0.475)),
            6 * sampled[3].deviation);
  // A binomial deviation, sqrt(p (1 - p) / n) of the box, where p is estimated by some 33 000 hits:
  // to one in 180, and the root to half of that; six deviations of it are 2 %.
  const double p = fuel / (2 * all);
  const double expected = 2 * all * std::sqrt(p * (1 - p) / 200'000);
  EXPECT_NEAR(sampled[0].deviation, expected, 0.02 * expected);
  EXPECT_EQ(sample_volumes(model, box, 1000, 7)[0].hits,
            sample_volumes(model, box, 1000, 7)[0].hits);
  EXPECT_NE(sample_volumes(model, box, 100'000, 7)[0].hits,
            sample_volumes(model, box, 100'000, 8)[0].hits);
}

// Every kind of fill: lattices of both shapes, turned and moved universes, quadrics and cones.
TEST(VerifyGeometry, CleanModelsPass) {
  VerifyGeometryOptions options;
  options.relative_width = 1e-4;
  options.points = 100'000;
  options.nef_seconds = 1;
  for (const char* name : {"pin_cell", "assembly_17x17", "hexagonal_core", "turned_units", "funnel",
                           "rounded_corner", "sphere_shells", "room_with_window"}) {
    const Report report = verify_geometry(read(name), options);
    EXPECT_EQ(report.overall(), Verdict::Passed) << name << render_text(report);
    EXPECT_GT(report.count(Verdict::Passed), 1U) << name;
  }
}

// The points' side of a surface is not the measures': a radius of 0.42 for 0.4096.
TEST(VerifyGeometry, AFaultOfFivePercentIsFound) {
  io::openmc::Model model = read("pin_cell");
  model.surfaces[0].coefficients[2] = Rational(42, 100);
  VerifyGeometryOptions options;
  options.relative_width = 1e-4;
  options.points = 100'000;
  options.disabled = {"nef"};
  const Report report = verify_geometry(model, options);
  EXPECT_EQ(report.overall(), Verdict::Failed);
  EXPECT_EQ(report.checks[0].verdict, Verdict::Failed);
  EXPECT_EQ(report.checks[3].verdict, Verdict::Passed);
}

}  // namespace
}  // namespace exactcsg::verify
