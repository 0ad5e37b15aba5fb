// SPDX-License-Identifier: GPL-3.0-or-later
// Expected values: data/curved/golden.json. Narrower widths: slow/golden_slow_test.cpp.

#include <set>

#include "measure/golden_solids.hpp"

namespace exactcsg::measure::test {
namespace {

TEST(GoldenCurvedSolids, EachSolidHasItsEntry) {
  std::set<std::string> there;
  for (const KnownSolid& known : known_solids()) there.insert(known.name);
  std::set<std::string> named;
  const nlohmann::json golden = golden_solids();
  for (const auto& entry : golden.items()) named.insert(entry.key());
  EXPECT_EQ(named, there);
}

TEST(GoldenCurvedSolids, LieInTheBounds) {
  const nlohmann::json golden = golden_solids();
  for (const KnownSolid& known : known_solids()) {
    const nlohmann::json& entry = golden.at(known.name);
    EXPECT_TRUE(has_golden_value(volume(known.set, known.box, to_width(1e-3)), entry.at("volume")))
        << known.name;
    ASSERT_EQ(entry.contains("area"), known.area.has_value()) << known.name;
    if (!known.area) continue;
    EXPECT_TRUE(has_golden_value(area(known.set, known.box, to_width(1e-3)), entry.at("area")))
        << known.name;
  }
}

}  // namespace
}  // namespace exactcsg::measure::test
