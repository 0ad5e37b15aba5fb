// SPDX-License-Identifier: GPL-3.0-or-later
// Every deck of data/mcnp, checked: what must be found is what was planted (data/mcnp/README.md).
// Each witness is classified again by io::openmc::locate, which asks every cell.

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
using io::openmc::Model;

struct Planted {
  DefectKind kind;
  std::vector<Id> cells;  // that overlap
};

struct Case {
  const char* deck;
  std::vector<Planted> planted;
};
void PrintTo(const Case& c, std::ostream* stream) { *stream << c.deck; }

using enum DefectKind;
const Case cases[] = {
    {"pin_cell.mcnp", {}},
    {"pin_cell_gap.mcnp", {{Gap, {}}}},
    {"assembly_17x17.mcnp", {}},
    {"hexagonal_core.mcnp", {}},
    {"turned_units.mcnp", {}},
    {"turned_capsule.mcnp", {}},
    {"bodies.mcnp", {}},
    {"room_with_window.mcnp", {}},
    {"room_with_window_overlap.mcnp", {{Overlap, {2, 3}}}},
    {"missing_corner.mcnp", {{Gap, {}}}},
    {"nozzle.inp", {}},
};

std::filesystem::path folder() {
  return std::filesystem::path(EXACTCSG_SOURCE_DIR) / "data" / "mcnp";
}

class CheckedDecks : public testing::TestWithParam<Case> {};

TEST_P(CheckedDecks, HaveTheDefectsThatWerePlantedAndNoOthers) {
  const Case& c = GetParam();
  const Model model = io::openmc::read_geometry_file(folder() / c.deck);
  EXPECT_TRUE(model.warnings.empty());
  const GeometryCheck check = check_geometry(model);
  ASSERT_EQ(check.defects.size(), c.planted.size()) << render_text(model, check, 0);
  for (std::size_t i = 0; i < c.planted.size(); ++i) {
    const Defect& defect = check.defects[i];
    EXPECT_EQ(defect.kind, c.planted[i].kind);
    std::vector<Id> cells;
    for (const io::openmc::Index cell : defect.cells) cells.push_back(model.cells[cell].id);
    EXPECT_EQ(cells, c.planted[i].cells);
    const io::openmc::Location location = io::openmc::locate(model, defect.point);
    EXPECT_EQ(location.verdict, defect.kind == Overlap ? io::openmc::PointVerdict::InOverlap
                                                       : io::openmc::PointVerdict::InGap);
    EXPECT_EQ(location.cells, defect.cells);
  }
  EXPECT_LE(check.undecided_volume(),
            measure::detail::volume_of(check.box) / Rational("1000000000"));
  EXPECT_EQ(check.is_clean(), c.planted.empty()) << render_text(model, check, 0);
  EXPECT_TRUE(check.unused_surfaces.empty());
}

INSTANTIATE_TEST_SUITE_P(Table, CheckedDecks, testing::ValuesIn(cases));

// Facets are named as their users name them, also where programs read it.
TEST(CheckedDecks, NameFacetsInTheirReports) {
  const Model model = io::openmc::read_geometry_file(folder() / "room_with_window.mcnp");
  const GeometryCheck check = check_geometry(model);
  std::string json = render_json(model, check, 0);
  json.erase(std::remove_if(json.begin(), json.end(), [](char c) { return c == ' ' || c == '\n'; }),
             json.end());
  EXPECT_NE(json.find("[\"2.1\",\"3.1\"]"), std::string::npos) << json;
  EXPECT_NE(render_text(model, check, 0).find("surfaces 2.1, 3.1 are the same"), std::string::npos);
}

TEST(CheckedDecks, AreAllInTheTable) {
  std::set<std::string> named;
  for (const Case& c : cases) named.insert(c.deck);
  std::set<std::string> there;
  for (const auto& entry : std::filesystem::directory_iterator(folder())) {
    if (io::openmc::is_geometry_file(entry.path())) there.insert(entry.path().filename().string());
  }
  EXPECT_EQ(named, there);
}

}  // namespace
}  // namespace exactcsg::verify
