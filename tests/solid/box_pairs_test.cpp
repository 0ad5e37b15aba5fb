// SPDX-License-Identifier: GPL-3.0-or-later
// Expected pairs: those that a comparison of every box with every other one finds. The order is
// known by the property that defines Hilbert's curve: it goes from neighbour to neighbour.
#include "exactcsg/solid/box_pairs.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>
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

// LAW box_pairs.1
std::set<Pair> found_by_searches(const BoxHierarchy& boxes) {
  std::set<Pair> pairs;
  for (const BoxHierarchy::Search& search : boxes.searches()) {
    boxes.for_each_pair(search, [&](std::uint32_t i, std::uint32_t j) {
      EXPECT_TRUE(pairs.insert(std::minmax(i, j)).second) << i << ' ' << j;
    });
  }
  return pairs;
}

std::set<Pair> expected_pairs(const std::vector<DoubleBox>& boxes) {
  std::vector<std::uint32_t> group(boxes.size());
  std::iota(group.begin(), group.end(), 0U);
  return expected_pairs(boxes, group);
}

// All pairs, those of every third box's group, and what each box meets.
void check_against_comparing_all(const std::vector<DoubleBox>& boxes) {
  const BoxHierarchy hierarchy(boxes);
  EXPECT_EQ(found_pairs(hierarchy), expected_pairs(boxes));
  EXPECT_EQ(found_by_searches(hierarchy), expected_pairs(boxes));
  std::vector<std::uint32_t> group(boxes.size());
  for (std::uint32_t i = 0; i < group.size(); ++i) group[i] = i % 3;
  EXPECT_EQ(found_pairs(BoxHierarchy(boxes, group)), expected_pairs(boxes, group));
  EXPECT_EQ(found_by_searches(BoxHierarchy(boxes, group)), expected_pairs(boxes, group));
  for (std::uint32_t i = 0; i < boxes.size(); i += 7) {
    std::set<std::uint32_t> found;
    hierarchy.for_each_meeting(
        boxes[i], [&](std::uint32_t j) { EXPECT_TRUE(found.insert(j).second) << i << ' ' << j; });
    std::set<std::uint32_t> expected;
    for (std::uint32_t j = 0; j < boxes.size(); ++j) {
      if (meet(boxes[i], boxes[j])) expected.insert(j);
    }
    EXPECT_EQ(found, expected) << i;
  }
}

TEST(BoxPairs, AreThoseThatMeet) {
  for (const double size : {0.1, 0.3}) {
    const std::vector<DoubleBox> boxes = random_boxes(400, size);
    EXPECT_FALSE(expected_pairs(boxes).empty());
    check_against_comparing_all(boxes);
  }
}

TEST(BoxPairs, OfAnyNumberOfBoxes) {
  for (std::size_t count = 0; count < 40; ++count) {
    check_against_comparing_all(random_boxes(count, 0.4));
  }
  check_against_comparing_all(random_boxes(1027, 0.1));
}

TEST(BoxPairs, OfPointsThatAreEqual) {
  check_against_comparing_all(std::vector<DoubleBox>(150, {{1, 2, 3}, {1, 2, 3}}));
  std::vector<DoubleBox> boxes = random_boxes(300, 0);
  for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i] = boxes[i % 100];
  check_against_comparing_all(boxes);
}

TEST(BoxPairs, OfBoxesOfAllSizes) {
  std::vector<DoubleBox> boxes = random_boxes(600, 0.2);
  std::mt19937 random(12);
  for (DoubleBox& box : boxes) {
    // Also subnormal, and such that differences and sums overflow.
    const double factor =
        std::ldexp(random() % 2 == 0 ? 1 : -1, static_cast<int>(random() % 2100) - 1075);
    for (std::size_t i = 0; i < 3; ++i) {
      box.lower[i] *= factor;
      box.upper[i] *= factor;
      if (box.lower[i] > box.upper[i]) std::swap(box.lower[i], box.upper[i]);
    }
  }
  check_against_comparing_all(boxes);
}

TEST(BoxPairs, OfUnboundedBoxes) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::vector<DoubleBox> boxes = random_boxes(300, 0.1);
  for (std::size_t i = 0; i < boxes.size(); i += 10) {
    if (i % 3 != 0) boxes[i].lower[i % 4 % 3] = -infinity;
    if (i % 3 != 1) boxes[i].upper[i % 3] = infinity;
  }
  boxes[55] = {{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}};
  check_against_comparing_all(boxes);
  for (DoubleBox& box : boxes) box.upper[0] = infinity;
  check_against_comparing_all(boxes);
}

// Few boxes of one crowd meet, although the crowd is a point as seen from the whole.
TEST(BoxPairs, OfCrowdsFarApartAreSoughtWithinEach) {
  std::vector<DoubleBox> boxes = random_boxes(400, 0.05);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double origin = i % 2 == 0 ? 0 : std::ldexp(1.0, 20);
      boxes[i].lower[axis] = origin + std::ldexp(boxes[i].lower[axis], -20);
      boxes[i].upper[axis] = origin + std::ldexp(boxes[i].upper[axis], -20);
    }
  }
  check_against_comparing_all(boxes);
  // The curve goes through one half of a crowd and then through the other half: in the first
  // hundred boxes there are few of the seven farther octants.
  const std::vector<std::uint32_t> order = order_along_curve(boxes);
  std::set<std::uint32_t> first_octants;
  for (std::size_t k = 0; k < 20; ++k) {
    std::uint32_t octant = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (boxes[order[k]].lower[axis] > std::ldexp(0.5, -20)) octant |= 1U << axis;
    }
    first_octants.insert(octant);
  }
  EXPECT_LE(first_octants.size(), 2U);
}

TEST(BoxPairs, OrderGoesFromNeighbourToNeighbour) {
  std::vector<DoubleBox> boxes;
  constexpr int side = 16;
  for (int i = 0; i < side * side * side; ++i) {
    const std::array<double, 3> point{static_cast<double>(i % side),
                                      static_cast<double>(i / side % side),
                                      static_cast<double>(i / side / side)};
    boxes.push_back({point, point});
  }
  // The whole is as wide as sixteen cells.
  const auto corner = static_cast<std::uint32_t>(boxes.size());
  boxes.push_back({{side, side, side}, {side, side, side}});
  std::vector<std::uint32_t> order = order_along_curve(boxes);
  std::vector<std::uint32_t> numbers = order;
  std::sort(numbers.begin(), numbers.end());
  for (std::uint32_t i = 0; i < numbers.size(); ++i) ASSERT_EQ(numbers[i], i);
  std::erase(order, corner);
  for (std::size_t k = 1; k < order.size(); ++k) {
    double distance = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      distance += std::abs(boxes[order[k]].lower[axis] - boxes[order[k - 1]].lower[axis]);
    }
    ASSERT_EQ(distance, 1) << k;
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

TEST(BoxPairs, OfNothingAreNone) {
  EXPECT_TRUE(found_pairs(GroupedBoxes({}, {})).empty());
  EXPECT_TRUE(found_by_searches(BoxHierarchy(std::span<const DoubleBox>())).empty());
}

// More than the nodes of the level where the search is shared out; nearly all in one place too.
TEST(BoxPairs, OfManyBoxesAreSharedOut) {
  std::mt19937 random(12);
  for (const double extent : {1000.0, 3.0}) {
    std::uniform_real_distribution<double> place(0, extent);
    std::vector<DoubleBox> boxes;
    for (int i = 0; i < 12000; ++i) {
      const double x = place(random);
      const double y = place(random);
      boxes.push_back({{x, y, 0}, {x + 0.01, y + 0.01, 1}});
    }
    const BoxHierarchy hierarchy(boxes);
    EXPECT_GT(hierarchy.searches().size(), 50U);
    EXPECT_EQ(found_by_searches(hierarchy), found_pairs(hierarchy));
  }
}

}  // namespace
}  // namespace exactcsg
