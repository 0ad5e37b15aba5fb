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

TEST(GoldenCurvedSolids, AreasLieInTheBounds) {
  const nlohmann::json entries = golden("solids");
  for (const KnownSolid& known : known_solids()) {
    const nlohmann::json& entry = entries.at(known.name);
    ASSERT_EQ(entry.contains("area"), known.area.has_value()) << known.name;
    if (!known.area) continue;
    EXPECT_TRUE(has_golden_value(area(known.set, known.box, to_width(1e-3)), entry.at("area")))
        << known.name;
  }
}

}  // namespace
}  // namespace exactcsg::measure::test
