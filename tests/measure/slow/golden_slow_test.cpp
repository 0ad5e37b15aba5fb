// SPDX-License-Identifier: GPL-3.0-or-later
// Expected values: data/curved/golden.json. Up to four seconds for each area, up to 40 for those of
// tori.

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
  for (const double width : {1e-6, 1e-9}) {
    expect_golden_areas(known_solids(), "solids", width);
    expect_golden_areas(known_tori(), "tori", width);
  }
}

}  // namespace
}  // namespace exactcsg::measure::test
