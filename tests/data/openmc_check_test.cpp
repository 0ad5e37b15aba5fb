// SPDX-License-Identifier: GPL-3.0-or-later
// Every model of data/openmc, checked: what must be found is what was planted
// (data/openmc/README.md). Each witness is classified again by io::openmc::locate, which asks every
// cell and shares no code with the search.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <ostream>
#include <set>
#include <string>
#include <vector>

#include "exactcsg/io/openmc/point_location.hpp"
#include "exactcsg/measure/local_region.hpp"
#include "exactcsg/verify/geometry_check.hpp"

namespace exactcsg::verify {
namespace {

using io::openmc::Id;
using io::openmc::Index;
using io::openmc::Model;

struct Planted {
  DefectKind kind;
  std::vector<Id> cells;  // that overlap
  const char* path;       // to the universe or lattice
};

struct Case {
  const char* model;
  std::vector<Planted> planted;
  std::vector<std::vector<Id>> coincident = {};
};

void PrintTo(const Case& c, std::ostream* stream) { *stream << c.model; }

using enum DefectKind;
const Case cases[] = {
    {"pin_cell", {}},
    {"pin_cell_missing_cell", {{Gap, {}, "universe 0"}}},
    {"pin_cell_leak", {{Gap, {}, "universe 0"}}},
    {"two_dimensional_pin", {}},
    {"assembly_17x17", {}},
    {"assembly_17x17_wrong_pitch", {{Gap, {}, "universe 0 > cell 10 > lattice 50"}}},
    {"assembly_17x17_flat", {}},
    {"assembly_17x17_overlap", {{Overlap, {143, 144}, "universe 0"}}},
    {"hexagonal_cell", {}},
    {"hexagonal_core", {}},
    {"hexagonal_without_outer", {{Gap, {}, "universe 0 > cell 10 > lattice 60"}}},
    {"layered_lattice", {}},
    {"layered_lattice_gap", {{Gap, {}, "universe 0 > cell 10 > lattice 60"}}},
    {"clipped_overlap", {}},
    {"visible_overlap",
     {{Overlap, {2, 3}, "universe 0 > cell 10 > lattice 60 (0, 0) > universe 1"}}},
    {"hidden_gap", {}},
    {"visible_gap", {{Gap, {}, "universe 0 > cell 10 > universe 1"}}},
    {"turned_units", {}},
    {"turned_box_gap", {{Gap, {}, "universe 0 > cell 10 > universe 1"}}},
    {"sphere_shells", {}},
    {"sphere_shells_overlap", {{Overlap, {3, 4}, "universe 0"}}},
    {"room_with_window", {}},
    {"room_with_window_overlap", {{Overlap, {2, 3}, "universe 0"}}},
    {"rounded_corner", {}, {{7, 8}}},
    {"rounded_corner_gap", {{Gap, {}, "universe 0"}}},
    {"coincident_surfaces", {}, {{1, 2}}},
    {"graveyard", {}},
    {"vessel", {}},
    {"tee", {}},
    {"funnel", {}},
    {"cone_on_slope", {}},
    {"second_nappe", {{Overlap, {1, 2}, "universe 0"}}},
    {"cooling_tower", {}, {{2, 3}}},
    {"cooling_tower_gap", {{Gap, {}, "universe 0"}}},
    {"wedges", {}},
    {"wedges_gap", {{Gap, {}, "universe 0"}}},
    {"touching_ball", {}},
    {"touching_balls", {}},
    {"overlapping_balls", {{Overlap, {1, 2}, "universe 0"}}},
    {"unused", {}},
    {"torus_on_plate", {}},
    {"torus_in_plate", {{Overlap, {1, 2}, "universe 0"}}},
    {"tokamak_sector", {}},
    {"tokamak_sector_gap", {{Gap, {}, "universe 0"}}},
};

std::filesystem::path folder() {
  return std::filesystem::path(EXACTCSG_SOURCE_DIR) / "data" / "openmc";
}
Model read(const std::string& name) {
  return io::openmc::read_geometry_file(folder() / (name + ".xml"));
}

std::vector<Id> cell_ids(const Model& model, const std::vector<Index>& cells) {
  std::vector<Id> ids;
  for (const Index cell : cells) ids.push_back(model.cells[cell].id);
  return ids;
}

// LAW geometry_check.2
void expect_located(const Model& model, const Defect& defect) {
  const io::openmc::Location location = io::openmc::locate(model, defect.point);
  EXPECT_EQ(location.verdict, defect.kind == Overlap ? io::openmc::PointVerdict::InOverlap
                                                     : io::openmc::PointVerdict::InGap);
  EXPECT_EQ(location.path, defect.path);
  EXPECT_EQ(location.cells, defect.cells);
}

class CheckedOpenMcModels : public testing::TestWithParam<Case> {};

TEST_P(CheckedOpenMcModels, HaveTheDefectsThatWerePlantedAndNoOthers) {
  const Case& c = GetParam();
  const Model model = read(c.model);
  const GeometryCheck check = check_geometry(model);
  ASSERT_EQ(check.defects.size(), c.planted.size());
  for (std::size_t i = 0; i < c.planted.size(); ++i) {
    const Defect& defect = check.defects[i];
    EXPECT_EQ(defect.kind, c.planted[i].kind);
    EXPECT_EQ(cell_ids(model, defect.cells), c.planted[i].cells);
    EXPECT_EQ(io::openmc::path_text(model, defect.path), c.planted[i].path);
    expect_located(model, defect);
  }
  EXPECT_LE(check.undecided_volume(),
            measure::detail::volume_of(check.box) / Rational("1000000000"));
  EXPECT_EQ(check.is_clean(), c.planted.empty());
  std::vector<std::vector<Id>> coincident;
  for (const CoincidentSurfaces& group : check.coincident_surfaces) {
    coincident.emplace_back();
    for (const Index surface : group.surfaces) {
      coincident.back().push_back(model.surfaces[surface].id);
    }
  }
  EXPECT_EQ(coincident, c.coincident);
  EXPECT_LT(check.seconds, 60);
}

INSTANTIATE_TEST_SUITE_P(Table, CheckedOpenMcModels, testing::ValuesIn(cases));

TEST(CheckedOpenMcModels, AreAllInTheTable) {
  std::set<std::string> named;
  for (const Case& c : cases) named.insert(c.model);
  std::set<std::string> there;
  for (const auto& entry : std::filesystem::directory_iterator(folder())) {
    if (entry.path().extension() == ".xml") there.insert(entry.path().stem().string());
  }
  EXPECT_EQ(named, there);
  EXPECT_GE(there.size(), 25U);
}

// 264 pins, 25 tubes: two universes, each in one shape.
TEST(GeometryCheck, LooksOnceAtAllElementsOfALatticeThatAreAlike) {
  const Model model = read("assembly_17x17");
  const GeometryCheck check = check_geometry(model);
  ASSERT_EQ(check.parts.size(), 3U);
  EXPECT_EQ(check.parts[1].views, 1U);
  EXPECT_EQ(check.parts[1].instances, 264);
  EXPECT_EQ(check.parts[2].views, 1U);
  EXPECT_EQ(check.parts[2].instances, 25);
}

TEST(GeometryCheck, WhatNothingUsesIsNamed) {
  const Model model = read("unused");
  const GeometryCheck check = check_geometry(model);
  ASSERT_EQ(check.unused_surfaces.size(), 1U);
  EXPECT_EQ(model.surfaces[check.unused_surfaces[0]].id, 2);
  ASSERT_EQ(check.unseen_universes.size(), 1U);
  EXPECT_EQ(model.universes[check.unseen_universes[0]].id, 7);
}

// The plane of the window's far side is at 265.5; the box ends before the pane that overlaps.
TEST(GeometryCheck, LooksOnlyIntoTheBoxThatIsGiven) {
  const Model model = read("room_with_window_overlap");
  GeometryCheckOptions options;
  options.box =
      domain::Box<3>(io::openmc::Point(-300, -300, -300), io::openmc::Point(264, 300, 300));
  EXPECT_TRUE(check_geometry(model, options).is_clean());
}

TEST(GeometryCheck, ABoxIsNeededWhereNothingSaysWhereTheGeometryEnds) {
  const Model model = io::openmc::read_geometry(
      R"(<geometry><surface id="1" type="sphere" coeffs="0 0 0 1"/>
         <cell id="1" material="1" region="-1"/><cell id="2" material="1" region="1"/></geometry>)",
      "ball.xml");
  EXPECT_THROW(check_geometry(model), Error);
  GeometryCheckOptions options;
  options.box = domain::Box<3>(io::openmc::Point(-2, -2, -2), io::openmc::Point(2, 2, 2));
  EXPECT_TRUE(check_geometry(model, options).is_clean());
}

// LAW geometry_check.3: without time, all of the box is undecided.
TEST(GeometryCheck, WithoutBudgetNothingIsProved) {
  const Model model = read("assembly_17x17_flat");
  GeometryCheckOptions options;
  options.cells = 1;
  const GeometryCheck check = check_geometry(model, options);
  EXPECT_TRUE(check.defects.empty());
  EXPECT_FALSE(check.is_clean());
  EXPECT_TRUE(check.is_clean(check.undecided_volume()));
  EXPECT_GE(check.undecided_volume(), measure::detail::volume_of(check.box));
  EXPECT_FALSE(check.undecided.empty());
}

TEST(GeometryCheck, IsCancelled) {
  Progress progress;
  progress.cancel();
  GeometryCheckOptions options;
  options.progress = &progress;
  EXPECT_THROW(check_geometry(read("assembly_17x17_flat"), options), Error);
}

TEST(GeometryCheck, ReportsNameWhatIsFound) {
  const Model model = read("assembly_17x17_overlap");
  const GeometryCheck check = check_geometry(model);
  const std::string text = render_text(model, check, 0);
  EXPECT_NE(text.find("\noverlap of cells 143, 144\n"), std::string::npos) << text;
  const std::string json = render_json(model, check, 0);
  EXPECT_NE(json.find("\"schema\": \"exactcsg.check/1\""), std::string::npos);
  EXPECT_NE(json.find("\"clean\": false"), std::string::npos);
  const Report report = as_report(model, check, 0);
  EXPECT_EQ(report.overall(), Verdict::Failed);
  EXPECT_EQ(report.count(Verdict::Failed), 1U);
  EXPECT_NE(render_junit(report).find("failures=\"1\""), std::string::npos);
}

}  // namespace
}  // namespace exactcsg::verify
