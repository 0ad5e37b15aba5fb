// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/support/give_up.hpp"

#include <gtest/gtest.h>

namespace exactcsg {
namespace {

TEST(GiveUp, LeavesNoMemory) {
  std::vector<int> items(1000, 7);
  give_up(items);
  EXPECT_TRUE(items.empty());
  EXPECT_EQ(items.capacity(), 0U);
  items.push_back(1);
  EXPECT_EQ(items, std::vector{1});
}

}  // namespace
}  // namespace exactcsg
