// SPDX-License-Identifier: GPL-3.0-or-later
// Sizes at which recursion, or anything quadratic, would show.

#include <gtest/gtest.h>

#include "planar/chain.hpp"
#include "planar/normal_outline.hpp"

namespace exactcsg::test {
namespace {

using io::test::figure;

// A comb of n teeth: a back of height 1, and n triangles of base 2 and height 1000 on it.
TEST(PlanarOutline, AMillionEdgesInOnePath) {
  const int n = 500'000;
  std::vector<Point2> path{{2 * n, -1}, {0, -1}};
  path.reserve(2 * n + 3);
  for (int i = 0; i < n; ++i) {
    path.push_back({2 * i, 0});
    path.push_back({2 * i + 1, 1000});
  }
  path.push_back({2 * n, 0});
  const Outline outline = outline_of(figure({path}));
  ASSERT_EQ(outline.components.size(), 1U);
  EXPECT_EQ(outline.points.size(), path.size());
  EXPECT_EQ(area(outline), Rational(2 * n) + Rational(1000) * n);
}

TEST(PlanarOutline, AChainOfAMillionNodes) {
  EXPECT_EQ(area(outline_of(chain_of_rectangles(500'000))), Rational(250'000));
}

}  // namespace
}  // namespace exactcsg::test
