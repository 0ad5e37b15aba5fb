// SPDX-License-Identifier: GPL-3.0-or-later
// Expected values: data/curved/golden.json. Seconds for each area.

#include "measure/golden_solids.hpp"

namespace exactcsg::measure::test {
namespace {

TEST(GoldenCurvedSolids, LieInNarrowBounds) {
  for (const double width : {1e-6, 1e-9}) {
    expect_golden_volumes(known_solids(), "solids", width);
    expect_golden_volumes(known_tori(), "tori", width);
  }
}

TEST(GoldenCurvedSolids, AreasLieInNarrowBounds) {
  const nlohmann::json entries = golden("solids");
  for (const KnownSolid& known : known_solids()) {
    if (!known.area) continue;
    EXPECT_TRUE(has_golden_value(area(known.set, known.box, to_width(1e-4)),
                                 entries.at(known.name).at("area")))
        << known.name;
  }
}

}  // namespace
}  // namespace exactcsg::measure::test
