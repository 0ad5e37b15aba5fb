// SPDX-License-Identifier: GPL-3.0-or-later
// The models of data/openmc: the place of points that follows from what was planted
// (data/openmc/README.md), and that random points of the clean ones are in one cell.

#include <gtest/gtest.h>

#include <filesystem>
#include <numbers>
#include <ostream>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "exactcsg/io/openmc/point_location.hpp"

namespace exactcsg::io::openmc {
namespace {

struct Case {
  const char* model;
  std::array<const char*, 3> point;
  PointVerdict verdict;
  std::vector<Id> cells;  // of the last universe
};

void PrintTo(const Case& c, std::ostream* stream) { *stream << c.model; }

using enum PointVerdict;
const Case cases[] = {
    {"pin_cell", {"0", "0", "0"}, InCell, {1}},
    {"pin_cell", {"0.41", "0", "0"}, InCell, {2}},
    {"pin_cell", {"0", "-0.475", "3"}, OnBoundary, {3, 4}},
    {"pin_cell", {"0.62", "0.62", "9"}, InCell, {4}},
    {"pin_cell_missing_cell", {"0.41", "0", "0"}, InGap, {}},
    // The centre pin is an instrument tube; its right neighbour a pin.
    {"assembly_17x17", {"0", "0", "0"}, InCell, {5}},
    {"assembly_17x17", {"1.26", "0", "100"}, InCell, {1}},
    {"assembly_17x17", {"0.63", "0.1", "0"}, OnBoundary, {}},
    {"assembly_17x17", {"10.7", "10.7", "0"}, InCell, {4}},
    // 17 * 1.25 / 2 = 10.625 and 17 * 1.26 / 2 = 10.71.
    {"assembly_17x17_wrong_pitch", {"10.624", "0", "0"}, InCell, {4}},
    {"assembly_17x17_wrong_pitch", {"10.63", "0", "0"}, InGap, {}},
    // Pin 143 (row 8, column 6) has its centre at -2.52, its neighbour's at -1.26.
    {"assembly_17x17_flat", {"-1.735", "0", "0"}, OnBoundary, {144, 1000}},
    {"assembly_17x17_flat", {"-1.7350005", "0", "0"}, InCell, {1000}},
    // The moved pin reaches from its centre -2.209999 to -1.734999; the neighbour begins at -1.735.
    {"assembly_17x17_overlap", {"-1.7349995", "0", "0"}, InOverlap, {143, 144}},
    {"assembly_17x17_overlap", {"-1.7350005", "0", "0"}, InCell, {143}},
    // The middle of the core, a pin at (1.2, 0) of an assembly, the water beyond its last pin.
    {"hexagonal_core", {"0", "0", "0"}, InCell, {1}},
    {"hexagonal_core", {"1.2", "0.3", "0"}, InCell, {1}},
    {"hexagonal_core", {"0.6", "0.1", "0"}, OnBoundary, {}},
    {"hexagonal_core", {"0.1", "4.2", "0"}, InCell, {3}},
    {"hexagonal_core", {"0", "8.5", "0"}, InCell, {1}},
    {"hexagonal_core", {"0", "24", "0"}, InCell, {3}},
    {"sphere_shells", {"2.5", "0", "0"}, InCell, {3}},
    {"sphere_shells", {"2", "1", "2"}, OnBoundary, {3, 4}},
    {"room_with_window", {"265", "0", "0"}, InCell, {3}},
    {"room_with_window", {"264", "0", "0"}, InCell, {4}},
    {"room_with_window", {"265", "60", "0"}, InCell, {2}},
    {"room_with_window", {"250", "0", "0"}, OnBoundary, {1, 4}},
    // The capsule reaches to 3 along its axis and to 1 across; turned by 90 degrees about z.
    {"turned_units", {"-7.5", "0", "0"}, InCell, {1}},
    {"turned_units", {"0", "2.5", "0"}, InCell, {1}},
    {"turned_units", {"2.5", "0", "0"}, InCell, {2}},
    // By 30 degrees about y: x goes to (cos 30, 0, -sin 30).
    {"turned_units", {"12.1", "0", "-1.2"}, InCell, {1}},
    {"turned_units", {"12.1", "0", "1.2"}, InCell, {2}},
    {"funnel", {"0", "0", "6"}, InCell, {1}},
    {"funnel", {"1", "0", "4"}, InCell, {2}},
    {"funnel", {"1", "0", "-4"}, InCell, {3}},
    {"funnel", {"0", "0", "11"}, InCell, {3}},
    // At 45 degrees, 1.99995 from the axis at (8, 8): 8 + 1.99995 / sqrt(2) = 9.4141781...
    {"rounded_corner", {"9.41417", "9.41417", "0"}, InCell, {1}},
    {"rounded_corner_gap", {"9.41417", "9.41417", "0"}, InGap, {}},
    {"rounded_corner_gap", {"9.41", "9.41", "0"}, InCell, {1}},
    {"coincident_surfaces", {"0.5", "0", "0"}, OnBoundary, {1, 2}},
    {"coincident_surfaces", {"0.6", "0", "0"}, InCell, {2}},
    {"touching_ball", {"0.3", "0", "0"}, OnBoundary, {1, 2, 3}},
    {"touching_ball", {"0.3", "0.1", "0"}, OnBoundary, {2, 3}},
    {"pin_cell_leak", {"0", "0", "10.1"}, InGap, {}},
    {"two_dimensional_pin", {"0.2", "0", "1000"}, InCell, {1}},
    {"hexagonal_cell", {"6.7", "2.5", "0"}, InCell, {2}},  // 4 * 6.7 + 3 * 2.5 = 34.3 < 35
    {"hexagonal_cell", {"8.75", "0", "0"}, OnBoundary, {2}},
    {"hexagonal_without_outer", {"0", "1", "0"}, InCell, {1}},
    {"hexagonal_without_outer", {"0", "1.6", "0"}, InGap, {}},  // the upper hexagon ends at 1.5
    {"graveyard", {"0", "0", "4"}, InCell, {3}},
    {"vessel", {"21", "0", "0"}, InCell, {2}},  // on the plane between its two parts
    {"vessel", {"22", "0", "0"}, OnBoundary, {2, 3}},
    {"vessel", {"0", "0", "-21"}, InCell, {2}},
    {"tee", {"3.5", "0", "3.5"}, InCell, {2}},
    {"tee", {"3.5", "0", "2.5"}, InCell, {1}},
    // At z = 4: x2 < 36 + 4 = 40 inside, and > 49 + 4 = 53 outside.
    {"cooling_tower", {"7", "0", "4"}, InCell, {2}},
    {"cooling_tower_gap", {"6.9999999", "0", "0.00004"}, InCell, {2}},
    {"wedges", {"-1", "0", "0"}, InCell, {3}},
    {"wedges", {"0", "0", "0"}, OnBoundary, {1, 2, 3, 4}},
    // 5 x + y is -0.0000005 there, above -0.000001.
    {"wedges_gap", {"-0.0000001", "0", "0"}, InGap, {}},
    // Its rows are 1 2 above 2 1; the middle of an element is that of universe 1's ball.
    {"layered_lattice", {"-1.75", "-1.75", "0.5"}, InCell, {3}},
    {"layered_lattice", {"-1.25", "-1.75", "0.5"}, InCell, {1}},
    {"layered_lattice", {"-1.25", "-1.75", "0"}, OnBoundary, {}},
    {"layered_lattice", {"0.5", "0.5", "1.5"}, InCell, {3}},
    {"layered_lattice_gap", {"0.5", "0.5", "2.0000005"}, InGap, {}},
    {"clipped_overlap", {"0.62", "0.62", "0"}, InCell, {2}},
    {"visible_overlap", {"0.62", "0.62", "0"}, InOverlap, {2, 3}},
    {"hidden_gap", {"6.89", "0", "0"}, InCell, {2}},
    {"visible_gap", {"7.05", "0", "0"}, InGap, {}},
    {"turned_box_gap", {"1.9", "1.9", "0"}, InGap, {}},
    {"touching_balls", {"0.6", "0.8", "0"}, OnBoundary, {1, 2, 3}},
    {"overlapping_balls", {"0.5999985", "0.799998", "0"}, InOverlap, {1, 2}},
    {"cone_on_slope", {"1", "1", "3"}, InCell, {1}},
    {"cone_on_slope", {"1", "1", "1"}, InCell, {2}},
    {"cone_on_slope", {"2", "1", "2"}, InCell, {3}},
    {"second_nappe", {"0", "0", "-2"}, InOverlap, {1, 2}},
    {"sphere_shells_overlap", {"2.5", "0", "0"}, InOverlap, {3, 4}},
    {"room_with_window_overlap", {"265", "50.5", "0"}, InOverlap, {2, 3}},
    {"unused", {"0", "0", "0"}, InCell, {1}},
    // 5 = |(3, 4)| from the axis: on the circle where the torus touches the plate.
    {"torus_on_plate", {"3", "4", "0"}, OnBoundary, {1, 2, 3}},
    {"torus_on_plate", {"3", "4", "0.000001"}, InCell, {1}},
    {"torus_on_plate", {"0", "0", "1"}, InCell, {3}},
    {"torus_in_plate", {"3", "4", "-0.0000005"}, InOverlap, {1, 2}},
    // Between y = 0 and 3 x = 4 y. At z = 0 the first torus ends at 8 from the axis, the second at
    // 8.3; (8.16, 0.88) is 8.207... away, (6.4, 4.8) just 8.
    {"tokamak_sector", {"5.9", "1", "0"}, InCell, {1}},
    {"tokamak_sector", {"8.16", "0.88", "0"}, InCell, {2}},
    {"tokamak_sector", {"0.8", "0.1", "0"}, InCell, {4}},
    {"tokamak_sector", {"5.9", "1", "5"}, InCell, {5}},
    {"tokamak_sector", {"6.4", "4.8", "0"}, OnBoundary, {1, 2}},
    // 8.30005 away; the blanket begins at 8.3001.
    {"tokamak_sector_gap", {"7.968048", "2.324014", "0"}, InGap, {}},
};

std::filesystem::path folder() {
  return std::filesystem::path(EXACTCSG_SOURCE_DIR) / "data" / "openmc";
}
Model read(const std::string& name) { return read_geometry_file(folder() / (name + ".xml")); }

class PlacesInOpenMcModels : public testing::TestWithParam<Case> {};

TEST_P(PlacesInOpenMcModels, AreThoseOfTheDescription) {
  const Case& c = GetParam();
  const Model model = read(c.model);
  EXPECT_TRUE(model.warnings.empty());
  const Point point(*parse_rational(c.point[0]), *parse_rational(c.point[1]),
                    *parse_rational(c.point[2]));
  const Location location = locate(model, point);
  EXPECT_EQ(location.verdict, c.verdict);
  std::vector<Id> cells;
  for (const Index cell : location.cells) cells.push_back(model.cells[cell].id);
  EXPECT_EQ(cells, c.cells);
  EXPECT_EQ(PointLocator(model)(point), location);
}

INSTANTIATE_TEST_SUITE_P(Table, PlacesInOpenMcModels, testing::ValuesIn(cases));

TEST(OpenMcModels, AreAllInTheTable) {
  std::set<std::string> named;
  for (const Case& c : cases) named.insert(c.model);
  std::set<std::string> there;
  for (const auto& entry : std::filesystem::directory_iterator(folder())) {
    if (entry.path().extension() == ".xml") there.insert(entry.path().stem().string());
  }
  EXPECT_EQ(named, there);
  EXPECT_GE(there.size(), 10U);
}

struct Clean {
  const char* model;
  std::array<int, 3> reach;  // a box within the model
};
// Random points of a model without a defect are in one cell, or, rarely, on a boundary. (A defect
// of small volume would hardly be found so: that is what witnesses and proofs are for.)
TEST(OpenMcModels, CleanOnesHaveNoGapAndNoOverlapAtRandomPoints) {
  const Clean clean[] = {{"pin_cell", {6, 6, 100}},
                         {"assembly_17x17", {107, 107, 1800}},
                         {"assembly_17x17_flat", {107, 107, 1800}},
                         {"hexagonal_core", {170, 170, 500}},
                         {"sphere_shells", {34, 34, 34}},
                         {"room_with_window", {2799, 2799, 2799}},
                         {"turned_units", {110, 110, 110}},
                         {"funnel", {170, 170, 170}},
                         {"rounded_corner", {119, 119, 99}},
                         {"coincident_surfaces", {49, 49, 49}},
                         {"touching_ball", {9, 9, 9}},
                         {"two_dimensional_pin", {6, 6, 100}},
                         {"hexagonal_cell", {42, 59, 89}},
                         {"graveyard", {50, 50, 50}},
                         {"vessel", {570, 570, 570}},
                         {"tee", {170, 170, 170}},
                         {"cooling_tower", {280, 280, 99}},
                         {"wedges", {70, 70, 49}},
                         {"layered_lattice", {19, 19, 19}},
                         {"clipped_overlap", {18, 18, 9}},
                         {"hidden_gap", {110, 110, 110}},
                         {"touching_balls", {28, 28, 28}},
                         {"cone_on_slope", {25, 25, 15}},
                         {"torus_on_plate", {99, 99, 99}}};
  std::mt19937 random(20261122);
  for (const auto& [name, reach] : clean) {
    const Model model = read(name);
    const PointLocator locator(model);
    for (int k = 0; k < 400; ++k) {
      domain::Coordinates<3> x;
      for (std::size_t i = 0; i < 3; ++i) {
        std::uniform_int_distribution<int> tenths(-reach[i] * 1000, reach[i] * 1000);
        x[i] = Rational(tenths(random), 10'000);
        x[i].canonicalize();
      }
      const PointVerdict verdict = locator(Point(x)).verdict;
      EXPECT_TRUE(verdict == InCell || verdict == OnBoundary) << name << " " << k;
    }
  }
}

// LAW location.5 where doubles do not decide: points on walls and at corners and centres of
// elements, on surfaces and on planes of symmetry, beside points that they decide.
TEST(OpenMcModels, LocatorAgreesWithLocateAtDegeneratePoints) {
  struct Steps {
    const char* model;
    std::array<Rational, 3> step;
    int reach;
  };
  // A quarter of a hexagon's side and height, of lattices whose pitch is 1.2.
  const Rational across = rational_of(std::numbers::sqrt3 / 2) * Rational(1, 5);
  const Steps models[] = {
      {"assembly_17x17", {Rational(63, 200), Rational(63, 200), 60}, 40},
      {"assembly_17x17_wrong_pitch", {Rational(5, 16), Rational(5, 16), 60}, 36},
      {"layered_lattice", {Rational(1, 8), Rational(1, 8), Rational(1, 8)}, 18},
      {"hexagonal_core", {across, Rational(3, 10), 25}, 80},
      {"hexagonal_core", {Rational(3, 10), across, 25}, 80},
      {"turned_units", {1, 1, 1}, 20}};
  std::mt19937 random(20261122);
  for (const Steps& steps : models) {
    const Model model = read(steps.model);
    const PointLocator locator(model);
    std::uniform_int_distribution<int> count(-steps.reach, steps.reach);
    for (int k = 0; k < 300; ++k) {
      domain::Coordinates<3> x;
      for (std::size_t i = 0; i < 3; ++i) x[i] = count(random) * steps.step[i];
      const Point point(x);
      EXPECT_EQ(locator(point), locate(model, point)) << steps.model << " " << k;
    }
  }
}

}  // namespace
}  // namespace exactcsg::io::openmc
