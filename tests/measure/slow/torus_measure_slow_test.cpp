// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes of tori to narrow widths. Expected values: closed forms (curved_tori.hpp).

#include <gtest/gtest.h>

#include <cmath>

#include "measure/curved_tori.hpp"

namespace exactcsg::measure::test {
namespace {

TEST(TorusVolume, TheWidthFallsAtLeastAsTheInverseSquareOfTheCells) {
  for (const KnownTorus& known : known_tori()) {
    const auto cells = [&](double width) {
      return static_cast<double>(volume(known.set, known.box, to_width(width)).cells);
    };
    EXPECT_LE(cells(1e-5) / cells(1e-3), std::sqrt(1e2)) << known.name;
  }
}

TEST(TorusVolume, ClosedFormsLieInNarrowBounds) {
  for (const KnownTorus& known : known_tori()) {
    for (const double width : {1e-6, 1e-9}) {
      const CertifiedMeasure measure = volume(known.set, known.box, to_width(width));
      EXPECT_TRUE(encloses(measure.value, known.volume)) << known.name << " at " << width;
      EXPECT_EQ(measure.stop, StopReason::Width) << known.name << " at " << width;
    }
  }
}

}  // namespace
}  // namespace exactcsg::measure::test
