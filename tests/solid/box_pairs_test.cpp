// SPDX-License-Identifier: GPL-3.0-or-later
// Expected pairs: those that a comparison of every box with every other one finds.
#include "exactcsg/solid/box_pairs.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace exactcsg {
namespace {

using Pair = std::pair<std::uint32_t, std::uint32_t>;

std::vector<DoubleBox> random_boxes(std::size_t count, double size) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(0, 1);
  std::vector<DoubleBox> boxes(count);
  for (DoubleBox& box : boxes) {
    for (std::size_t i = 0; i < 3; ++i) {
      box.lower[i] = place(random);
      box.upper[i] = box.lower[i] + size * place(random);
    }
  }
  return boxes;
}

// Pairs of boxes that meet and whose groups, by number of the box, differ.
std::set<Pair> expected_pairs(const std::vector<DoubleBox>& boxes,
                              const std::vector<std::uint32_t>& group) {
  std::set<Pair> pairs;
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    for (std::uint32_t j = i + 1; j < boxes.size(); ++j) {
      if (group[i] != group[j] && meet(boxes[i], boxes[j])) pairs.emplace(i, j);
    }
  }
  return pairs;
}

// Fails where a pair is found twice.
template <class Boxes>
std::set<Pair> found_pairs(Boxes&& boxes) {
  std::set<Pair> pairs;
  boxes.for_each_pair([&](std::uint32_t i, std::uint32_t j) {
    EXPECT_TRUE(pairs.insert(std::minmax(i, j)).second) << i << ' ' << j;
  });
  return pairs;
}

TEST(BoxPairs, AreThoseThatMeet) {
  for (const double size : {0.1, 0.3}) {
    const std::vector<DoubleBox> boxes = random_boxes(400, size);
    std::vector<std::uint32_t> group(boxes.size());
    std::iota(group.begin(), group.end(), 0U);
    const std::set<Pair> expected = expected_pairs(boxes, group);
    EXPECT_FALSE(expected.empty());
    EXPECT_EQ(found_pairs(BoxHierarchy(boxes)), expected);
  }
}

TEST(BoxPairs, OfGroupsAreThoseOfDifferentGroups) {
  for (const double size : {0.1, 0.3}) {
    const std::vector<DoubleBox> boxes = random_boxes(400, size);
    // Groups of 1, 2, 4, ... 128 boxes, and the rest.
    std::vector<std::uint32_t> begins;
    std::vector<std::uint32_t> group;
    for (std::uint32_t begin = 0, count = 1; begin < boxes.size(); begin += count, count *= 2) {
      if (count > 128) count = 1;
      begins.push_back(begin);
      while (group.size() < std::min<std::size_t>(begin + count, boxes.size())) {
        group.push_back(begin);
      }
    }
    EXPECT_EQ(found_pairs(GroupedBoxes(boxes, begins)), expected_pairs(boxes, group));
  }
}

TEST(BoxPairs, OfNothingAreNone) { EXPECT_TRUE(found_pairs(GroupedBoxes({}, {})).empty()); }

}  // namespace
}  // namespace exactcsg
