// SPDX-License-Identifier: GPL-3.0-or-later
// Expected values: data/curved/golden.json. Narrower widths: slow/golden_slow_test.cpp.

#include <set>

#include "measure/golden_solids.hpp"

namespace exactcsg::measure::test {
namespace {

template <class Known>
void expect_one_entry_each(const std::vector<Known>& all, const std::string& kind) {
  std::set<std::string> there;
  for (const Known& known : all) there.insert(known.name);
  std::set<std::string> named;
  const nlohmann::json entries = golden(kind);
  for (const auto& entry : entries.items()) named.insert(entry.key());
  EXPECT_EQ(named, there);
}

TEST(GoldenCurvedSolids, EachSolidHasItsEntry) {
  expect_one_entry_each(known_solids(), "solids");
  expect_one_entry_each(known_tori(), "tori");
}

TEST(GoldenCurvedSolids, LieInTheBounds) {
  expect_golden_volumes(known_solids(), "solids", 1e-3);
  expect_golden_volumes(known_tori(), "tori", 1e-3);
}

template <class Known>
void expect_areas_where_known(const std::vector<Known>& all, const std::string& kind) {
  const nlohmann::json entries = golden(kind);
  for (const Known& known : all) {
    EXPECT_EQ(entries.at(known.name).contains("area"), known.area.has_value()) << known.name;
  }
}

TEST(GoldenCurvedSolids, AreasLieInTheBounds) {
  expect_areas_where_known(known_solids(), "solids");
  expect_areas_where_known(known_tori(), "tori");
  expect_golden_areas(known_solids(), "solids", 1e-3);
  expect_golden_areas(known_tori(), "tori", 1e-3);
}

}  // namespace
}  // namespace exactcsg::measure::test
