// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes of cells and materials with all instances. Expected values: closed forms, each derived
// where it stands, the elements of a lattice measured one by one, and sums that fill a box.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "exactcsg/io/openmc/cell_volumes.hpp"

namespace exactcsg::io::openmc {
namespace {

using std::numbers::pi;

Model read(const std::string& name) {
  return read_geometry_file(std::string(EXACTCSG_SOURCE_DIR) + "/data/openmc/" + name + ".xml");
}
Model parse(const std::string& text) {
  return read_geometry("<geometry>" + text + "</geometry>", "text");
}
VolumeLimits to_width(double width) {
  VolumeLimits limits;
  limits.relative_width = width;
  return limits;
}

const VisibleVolume& volume_of(const Model& model, const GeometryVolumes& volumes, Id cell) {
  for (std::size_t i = 0; i < model.cells.size(); ++i) {
    if (model.cells[i].id == cell) return volumes.cells[i];
  }
  throw std::out_of_range("no such cell");
}

// A value of which 14 digits are known.
testing::AssertionResult encloses(const VisibleVolume& visible, double expected, double width) {
  if (!visible.volume) return testing::AssertionFailure() << "not bounded";
  const double lower = nearest_double(visible.volume->lower);
  const double upper = nearest_double(visible.volume->upper);
  const double slack = 1e-14 * expected;
  if (lower <= expected + slack && upper >= expected - slack &&
      upper - lower <= 1.000001 * width * lower + slack) {
    return testing::AssertionSuccess();
  }
  return testing::AssertionFailure() << lower << " to " << upper << ", not " << expected;
}

// Height 20, radii 0.4096, 0.418 and 0.475, a square of side 1.26.
TEST(CellVolumes, APinCellHasTheVolumesOfItsRings) {
  const Model model = read("pin_cell");
  for (const double width : {1e-3, 1e-6}) {
    const GeometryVolumes volumes = measure_volumes(model, to_width(width));
    const double fuel = 20 * pi * 0.4096 * 0.4096;
    const double gap = 20 * pi * 0.418 * 0.418 - fuel;
    const double clad = 20 * pi * 0.475 * 0.475 - gap - fuel;
    const double water = 20 * 1.26 * 1.26 - 20 * pi * 0.475 * 0.475;
    EXPECT_TRUE(encloses(volume_of(model, volumes, 1), fuel, width));
    EXPECT_TRUE(encloses(volume_of(model, volumes, 2), gap, width));
    EXPECT_TRUE(encloses(volume_of(model, volumes, 3), clad, width));
    EXPECT_TRUE(encloses(volume_of(model, volumes, 4), water, width));
    ASSERT_EQ(volumes.materials.size(), 4U);
    EXPECT_EQ(volumes.materials[0].materials, Materials{std::nullopt});
    EXPECT_TRUE(encloses(volumes.materials[0].visible, gap, width));
    EXPECT_TRUE(encloses(volumes.materials[1].visible, fuel, width));
  }
}

// 264 pins and 25 tubes of height 366 in squares of side 1.26, which end where the box does: each
// universe is seen in one way.
TEST(CellVolumes, AnAssemblyCountsEveryElement) {
  const Model model = read("assembly_17x17");
  const double width = 1e-6;
  const GeometryVolumes volumes = measure_volumes(model, to_width(width));
  const auto ring = [](double outer, double inner) {
    return 366 * pi * (outer * outer - inner * inner);
  };
  const double square = 366 * 1.26 * 1.26;
  EXPECT_EQ(volume_of(model, volumes, 1).instances, 264);
  EXPECT_EQ(volume_of(model, volumes, 5).instances, 25);
  EXPECT_EQ(volume_of(model, volumes, 10).instances, 1);
  EXPECT_TRUE(encloses(volume_of(model, volumes, 1), 264 * ring(0.4096, 0), width));
  EXPECT_TRUE(encloses(volume_of(model, volumes, 2), 264 * ring(0.418, 0.4096), width));
  EXPECT_TRUE(encloses(volume_of(model, volumes, 3), 264 * ring(0.475, 0.418), width));
  EXPECT_TRUE(encloses(volume_of(model, volumes, 4), 264 * (square - ring(0.475, 0)), width));
  EXPECT_TRUE(encloses(volume_of(model, volumes, 5), 25 * ring(0.561, 0), width));
  EXPECT_TRUE(encloses(volume_of(model, volumes, 7), 25 * (square - ring(0.602, 0)), width));
  EXPECT_TRUE(encloses(volume_of(model, volumes, 10), 289 * square, 1e-15));
  EXPECT_EQ(volumes.distinct_instances, 8U);  // 4 + 3 cells, and the one with the lattice
}

// The same pins as cells of one universe.
TEST(CellVolumes, TheWaterOfAFlatAssemblyIsWhatThePinsLeave) {
  const Model model = read("assembly_17x17_flat");
  const GeometryVolumes volumes = measure_volumes(model, to_width(1e-4));
  double pins = 0;
  for (std::size_t i = 0; i < model.cells.size(); ++i) {
    ASSERT_TRUE(volumes.cells[i].volume) << model.cells[i].id;
    if (model.cells[i].id != 1000) {
      pins += nearest_double(
                  Rational(volumes.cells[i].volume->lower + volumes.cells[i].volume->upper)) /
              2;
    }
  }
  EXPECT_TRUE(encloses(volume_of(model, volumes, 1000), 366 * 21.42 * 21.42 - pins, 1e-2));
}

double middle(const VisibleVolume& visible) {
  return nearest_double(Rational(visible.volume->lower + visible.volume->upper)) / 2;
}

// The materials of a clean model without what is unbounded fill the cells of the root.
TEST(CellVolumes, OfCleanModelsMaterialsFillTheRootUniverse) {
  for (const char* name : {"hexagonal_core", "turned_units", "sphere_shells", "assembly_17x17"}) {
    const Model model = read(name);
    const GeometryVolumes volumes = measure_volumes(model, to_width(1e-4));
    double of_root = 0;
    double of_materials = 0;
    for (std::size_t i = 0; i < model.cells.size(); ++i) {
      const VisibleVolume& visible = volumes.cells[i];
      if (!visible.volume) continue;
      if (model.cells[i].universe == model.root) of_root += middle(visible);
      if (model.cells[i].fill == FillKind::Material) of_materials += middle(visible);
    }
    EXPECT_GT(of_root, 0) << name;
    EXPECT_NEAR(of_materials / of_root, 1, 1e-4) << name;
  }
}

TEST(CellVolumes, WhatIsOutsideTheVacuumBoundaryIsUnbounded) {
  const Model model = parse(
      "<surface id='1' type='sphere' coeffs='0 0 0 2' boundary='vacuum'/>"
      "<surface id='2' type='plane' coeffs='1 1 0 1'/>"
      "<cell id='1' material='1' region='-1'/><cell id='2' material='2' region='1'/>"
      "<cell id='3' material='2' region='1 -2'/>");
  const GeometryVolumes volumes = measure_volumes(model, to_width(1e-6));
  EXPECT_TRUE(encloses(volume_of(model, volumes, 1), 32 * pi / 3, 1e-6));
  EXPECT_FALSE(volume_of(model, volumes, 2).volume);
  EXPECT_FALSE(volume_of(model, volumes, 3).volume);
  EXPECT_EQ(volume_of(model, volumes, 2).instances, 1);
  EXPECT_FALSE(volumes.materials[1].visible.volume);
}

// The outer universe goes on in the lattice's grid, within the cell: 3 x 3 elements of side 2 in a
// cube of side 6, of which the middle one alone is the lattice's. Each has a ball of radius 1/2.
TEST(CellVolumes, TheOuterUniverseRepeats) {
  const Model model = parse(
      "<surface id='1' type='sphere' coeffs='0 0 0 0.5'/>"
      "<surface id='2' type='x-plane' coeffs='-3'/><surface id='3' type='x-plane' coeffs='3'/>"
      "<surface id='4' type='y-plane' coeffs='-3'/><surface id='5' type='y-plane' coeffs='3'/>"
      "<surface id='6' type='z-plane' coeffs='-1'/><surface id='7' type='z-plane' coeffs='1'/>"
      "<cell id='1' universe='1' material='1' region='-1'/>"
      "<cell id='2' universe='1' material='2' region='1'/>"
      "<cell id='3' universe='2' material='3' region='-1'/>"
      "<cell id='4' universe='2' material='4' region='1'/>"
      "<lattice id='9'><dimension>1 1</dimension><lower_left>-1 -1</lower_left><pitch>2 2</pitch>"
      "<outer>2</outer><universes>1</universes></lattice>"
      "<cell id='5' fill='9' region='2 -3 4 -5 6 -7'/>");
  const GeometryVolumes volumes = measure_volumes(model, to_width(1e-6));
  EXPECT_EQ(volume_of(model, volumes, 1).instances, 1);
  EXPECT_EQ(volume_of(model, volumes, 3).instances, 8);
  EXPECT_TRUE(encloses(volume_of(model, volumes, 1), pi / 6, 1e-6));
  EXPECT_TRUE(encloses(volume_of(model, volumes, 3), 8 * pi / 6, 1e-6));
  EXPECT_TRUE(encloses(volume_of(model, volumes, 4), 8 * (8 - pi / 6), 1e-6));
}

// A cell without sides: the outer universe is there without end.
TEST(CellVolumes, AnOuterUniverseWithoutEndIsUnbounded) {
  const Model model = parse(
      "<surface id='1' type='sphere' coeffs='0 0 0 0.5'/>"
      "<cell id='1' universe='1' material='1' region='-1'/>"
      "<cell id='3' universe='2' material='3' region='-1'/>"
      "<lattice id='9'><dimension>2 1 1</dimension><lower_left>-1 -1 -1</lower_left>"
      "<pitch>2 2 2</pitch><outer>2</outer><universes>1 1</universes></lattice>"
      "<cell id='5' fill='9'/>");
  const GeometryVolumes volumes = measure_volumes(model, to_width(1e-6));
  EXPECT_EQ(volume_of(model, volumes, 1).instances, 2);
  EXPECT_TRUE(encloses(volume_of(model, volumes, 1), 2 * pi / 6, 1e-6));
  EXPECT_FALSE(volume_of(model, volumes, 3).volume);
  EXPECT_FALSE(volume_of(model, volumes, 5).volume);
}

// Cylinders that are wider than the hexagons they are clipped to.
TEST(CellVolumes, HexagonsClipWhatTheyShow) {
  const std::string text =
      "<surface id='1' type='z-cylinder' coeffs='0 0 0.7'/>"
      "<surface id='6' type='z-plane' coeffs='0'/><surface id='7' type='z-plane' coeffs='1'/>"
      "<cell id='1' universe='1' material='1' region='-1'/>"
      "<cell id='2' universe='1' material='2' region='1'/>"
      "<hex_lattice id='9' n_rings='2' ORIENTATION><center>0 0</center><pitch>1</pitch>"
      "<universes>1 1 1 1 1 1 1</universes></hex_lattice>"
      "<cell id='5' fill='9' region='6 -7'/>";
  for (const char* orientation : {"orientation='x'", "orientation='y'"}) {
    std::string of_one = text;
    of_one.replace(of_one.find("ORIENTATION"), 11, orientation);
    const Model model = parse(of_one);
    const GeometryVolumes volumes = measure_volumes(model, to_width(1e-6));
    EXPECT_EQ(volume_of(model, volumes, 1).instances, 7);
    // The hexagon of width 1 has the area sqrt(3)/2; the disc of radius 0.7 holds all of it, since
    // its corners are at 1/sqrt(3).
    EXPECT_TRUE(encloses(volume_of(model, volumes, 1), 7 * std::sqrt(3.0) / 2, 1e-6))
        << orientation;
    EXPECT_LE(volume_of(model, volumes, 2).volume->upper, rational_of(1e-11));
  }
}

// Absolute widths are of the sum over instances.
TEST(CellVolumes, AbsoluteWidthsAreOfTheSum) {
  const Model model = read("assembly_17x17");
  VolumeLimits limits;
  limits.relative_width = 0;
  limits.absolute_width = 1e-2;
  const GeometryVolumes volumes = measure_volumes(model, limits);
  for (const VisibleVolume& visible : volumes.cells) {
    EXPECT_LE(visible.volume->upper - visible.volume->lower, rational_of(1e-2));
    EXPECT_EQ(visible.stop, measure::StopReason::Width);
  }
}

TEST(CellVolumes, LimitsGiveTheBoundsReached) {
  const Model model = read("pin_cell");
  VolumeLimits limits = to_width(1e-9);
  limits.deadline = std::chrono::steady_clock::now();
  const GeometryVolumes volumes = measure_volumes(model, limits);
  EXPECT_EQ(volume_of(model, volumes, 1).stop, measure::StopReason::Deadline);
  const double fuel = 20 * pi * 0.4096 * 0.4096;
  EXPECT_LE(volume_of(model, volumes, 1).volume->lower, rational_of(fuel));
  EXPECT_GE(volume_of(model, volumes, 1).volume->upper, rational_of(fuel));
}

}  // namespace
}  // namespace exactcsg::io::openmc
