// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/solid/oriented_table_plane.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <vector>

namespace exactcsg {
namespace {

// Expected: what the plane was made of.
std::vector<OrientedPlaneRef> some_planes() {
  std::vector<OrientedPlaneRef> result;
  for (const std::uint32_t index :
       {0U, 1U, 2U, 1000U, std::numeric_limits<std::uint32_t>::max() / 2}) {
    for (const int sense : {-1, 1}) {
      result.push_back({PlaneRef::of_table(index), static_cast<signed char>(sense)});
    }
  }
  return result;
}

TEST(OrientedTablePlane, ConvertsToWhatItWasMadeOf) {
  for (const OrientedPlaneRef& oriented : some_planes()) {
    const OrientedTablePlane packed = oriented;
    EXPECT_EQ(static_cast<OrientedPlaneRef>(packed), oriented);
    EXPECT_EQ(packed.plane(), oriented.plane);
    EXPECT_EQ(packed.table_index(), oriented.plane.table_index());
    EXPECT_EQ(packed.sense(), oriented.sense);
  }
}

TEST(OrientedTablePlane, IsOrderedAsTheyAre) {
  const std::vector<OrientedPlaneRef> planes = some_planes();
  for (const OrientedPlaneRef& a : planes) {
    for (const OrientedPlaneRef& b : planes) {
      EXPECT_EQ(OrientedTablePlane(a) <=> OrientedTablePlane(b), a <=> b);
    }
  }
}

}  // namespace
}  // namespace exactcsg
