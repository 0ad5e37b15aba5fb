// SPDX-License-Identifier: GPL-3.0-or-later
// Expected values: data/curved/golden.json. Seconds for each area.

#include "measure/golden_solids.hpp"

namespace exactcsg::measure::test {
namespace {

TEST(GoldenCurvedSolids, LieInNarrowBounds) {
  const nlohmann::json golden = golden_solids();
  for (const KnownSolid& known : known_solids()) {
    const nlohmann::json& entry = golden.at(known.name);
    for (const double width : {1e-6, 1e-9}) {
      EXPECT_TRUE(
          has_golden_value(volume(known.set, known.box, to_width(width)), entry.at("volume")))
          << known.name << " at " << width;
    }
    if (!known.area) continue;
    EXPECT_TRUE(has_golden_value(area(known.set, known.box, to_width(1e-4)), entry.at("area")))
        << known.name;
  }
}

}  // namespace
}  // namespace exactcsg::measure::test
