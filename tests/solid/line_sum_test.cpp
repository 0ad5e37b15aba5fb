// SPDX-License-Identifier: GPL-3.0-or-later
// Expected: what covers each stretch between neighbouring ranks, counted side by side.
#include "exactcsg/solid/line_sum.hpp"

#include <gtest/gtest.h>

#include <random>

namespace exactcsg {
namespace {

struct Stretch {
  std::optional<std::uint32_t> left;
  std::optional<std::uint32_t> right;
  std::uint32_t low = 0;
  std::uint32_t high = 0;
  friend bool operator==(const Stretch&, const Stretch&) = default;
};

struct Side {
  std::uint32_t from;
  std::uint32_t to;
};

std::vector<Stretch> summed(const std::vector<Side>& sides) {
  std::vector<LineEvent> events;
  for (std::uint32_t i = 0; i < sides.size(); ++i) {
    add_events(sides[i].from, sides[i].to, i, events);
  }
  std::vector<Stretch> result;
  sum_along_line(events,
                 [&](const auto& left, const auto& right, std::uint32_t low, std::uint32_t high) {
                   result.push_back({left, right, low, high});
                 });
  return result;
}

std::vector<Stretch> counted(const std::vector<Side>& sides) {
  std::vector<std::uint32_t> ranks;
  for (const Side& side : sides) ranks.insert(ranks.end(), {side.from, side.to});
  std::sort(ranks.begin(), ranks.end());
  ranks.erase(std::unique(ranks.begin(), ranks.end()), ranks.end());
  std::vector<Stretch> result;
  for (std::size_t k = 0; k + 1 < ranks.size(); ++k) {
    Stretch stretch{{}, {}, ranks[k], ranks[k + 1]};
    for (std::uint32_t i = 0; i < sides.size(); ++i) {
      const auto [low, high] = std::minmax({sides[i].from, sides[i].to});
      if (low > ranks[k] || high < ranks[k + 1]) continue;
      (sides[i].from < sides[i].to ? stretch.left : stretch.right) = i;
    }
    if (stretch.left || stretch.right) result.push_back(stretch);
  }
  return result;
}

TEST(LineSum, TellsWhatIsOnEitherSideOfEachStretch) {
  std::mt19937 random(3);
  std::uniform_int_distribution<std::uint32_t> step(1, 4);
  for (int round = 0; round < 200; ++round) {
    std::vector<Side> sides;
    // Sides of one direction do not overlap, and may follow one another.
    for (const bool forward : {true, false}) {
      std::uint32_t at = step(random);
      for (std::uint32_t count = step(random); count > 0; --count) {
        const std::uint32_t end = at + step(random);
        sides.push_back(forward ? Side{at, end} : Side{end, at});
        at = end + step(random) / 3;
      }
    }
    std::shuffle(sides.begin(), sides.end(), random);
    EXPECT_EQ(summed(sides), counted(sides)) << round;
  }
}

TEST(LineSum, PiecesOnOneSideMustNotOverlap) {
  EXPECT_THROW(summed({{0, 2}, {1, 3}}), Error);
  EXPECT_NO_THROW(summed({{0, 2}, {3, 1}}));
}

}  // namespace
}  // namespace exactcsg
