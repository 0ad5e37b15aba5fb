// SPDX-License-Identifier: GPL-3.0-or-later
// The closed forms at narrow widths, where rounding and remainders are of a size. Seconds each.

#include <gtest/gtest.h>

#include "exactcsg/measure/certified_measure.hpp"
#include "measure/curved_solids.hpp"

namespace exactcsg::measure::test {
namespace {

TEST(NarrowWidths, ClosedFormsLieInTheBounds) {
  for (const KnownSolid& known : known_solids()) {
    for (const double width : {1e-6, 1e-8, 1e-9}) {
      const CertifiedMeasure measure = volume(known.set, known.box, to_width(width));
      EXPECT_TRUE(encloses(measure.value, known.volume)) << known.name << " at " << width;
      EXPECT_EQ(measure.stop, StopReason::Width) << known.name << " at " << width;
    }
  }
}

}  // namespace
}  // namespace exactcsg::measure::test
