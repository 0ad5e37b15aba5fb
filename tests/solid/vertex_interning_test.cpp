// SPDX-License-Identifier: GPL-3.0-or-later
// Expected: the clusters' definition, by looking at one interval after the other.
#include "exactcsg/solid/vertex_interning.hpp"

#include <gtest/gtest.h>

#include <random>

namespace exactcsg {
namespace {

using Items = std::vector<std::vector<std::uint32_t>>;

Items expected_clusters(std::vector<KeyInterval> intervals) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (KeyInterval& interval : intervals) {
    if (!(interval.lower > -infinity && interval.upper < infinity)) {
      interval.lower = -infinity;
      interval.upper = infinity;
    }
  }
  std::sort(intervals.begin(), intervals.end(), [](const auto& a, const auto& b) {
    return std::pair(a.lower, a.item) < std::pair(b.lower, b.item);
  });
  Items result;
  double reach = -infinity;
  for (const KeyInterval& interval : intervals) {
    if (result.empty() || interval.lower > reach) result.emplace_back();
    result.back().push_back(interval.item);
    reach = std::max(reach, interval.upper);
  }
  return result;
}

Items found_clusters(const std::vector<KeyInterval>& intervals, unsigned threads) {
  const Clusters clusters(intervals, threads);
  Items result;
  for (std::size_t part = 0; part < clusters.parts().count(); ++part) {
    clusters.for_each(part, [&](std::span<const KeyInterval> cluster) {
      result.emplace_back();
      for (const KeyInterval& interval : cluster) result.back().push_back(interval.item);
    });
  }
  return result;
}

std::vector<KeyInterval> random_intervals(std::size_t count, double width, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(0, static_cast<double>(count));
  std::vector<KeyInterval> result;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double lower = place(random);
    result.push_back({lower, lower + width * place(random) / static_cast<double>(count), i});
  }
  return result;
}

TEST(Clusters, AreTheIntervalsConnectedByOverlaps) {
  for (const std::size_t count : {0U, 1U, 100U, 20000U}) {
    // Most alone; some dozens in each; one chain from end to end.
    for (const double width : {0.1, 5.0, 1000.0}) {
      const std::vector<KeyInterval> intervals = random_intervals(count, width, 5);
      for (const unsigned threads : {1U, 2U, 0U}) {
        EXPECT_EQ(found_clusters(intervals, threads), expected_clusters(intervals))
            << count << ' ' << width << ' ' << threads;
      }
    }
  }
}

// A long interval joins several parts of the sequence; what follows it is apart again.
TEST(Clusters, MayReachOverSeveralParts) {
  std::vector<KeyInterval> intervals = random_intervals(20000, 0.1, 6);
  intervals.push_back({4000, 13000, 20000});
  for (const unsigned threads : {1U, 2U, 0U}) {
    EXPECT_EQ(found_clusters(intervals, threads), expected_clusters(intervals)) << threads;
  }
}

TEST(Clusters, WhatIsNotFiniteMeetsEverything) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  for (const KeyInterval& endless :
       {KeyInterval{-infinity, 3, 9}, KeyInterval{3, infinity, 9}, KeyInterval{unknown, 3, 9}}) {
    std::vector<KeyInterval> intervals = random_intervals(9, 0.1, 7);
    intervals.push_back(endless);
    EXPECT_EQ(found_clusters(intervals, 1).size(), 1U);
  }
}

// Points, and meeting points of walls, of which one is there twice and is a point as well.
// LAW interning.1
TEST(InternedVertices, ThoseThatStandAloneHaveNumbersOfTheirOwn) {
  Geometry::Builder builder;
  for (int i = 0; i < 6; ++i) builder.add_point({i, 0, 0});
  const Geometry geometry = std::move(builder).build();
  const auto corner = [&](double x) {
    return geometry.meet(PlaneRef::of_wall(Axis::X, x), PlaneRef::of_wall(Axis::Y, 0),
                         PlaneRef::of_wall(Axis::Z, 0));
  };
  const std::vector<Vertex> corners{corner(1), corner(7), corner(1), corner(8), corner(9)};
  CornerVertices vertices;
  for (const Vertex& vertex : corners) vertices.meeting_points.push_back(&vertex);
  using enum CornerOccurrence;
  vertices.meeting_point_occurs = {Some, Alone, Some, None, Some};
  vertices.point_occurs = {Alone, Some, None, Some, Alone, None};
  for (const unsigned threads : {1U, 2U}) {
    TierStatistics statistics;
    const InternedVertices interned = intern(geometry, vertices, statistics, threads);
    // x = 1 three times, 7, 9, and the points 0, 3, 4.
    EXPECT_EQ(interned.distinct.size(), 6U);
    const auto x_of = [&](std::uint32_t number) { return interned.distinct[number].x; };
    for (const std::size_t i : {0U, 1U, 2U, 4U}) {
      EXPECT_EQ(x_of(interned.number_of_meeting_point[i]), corners[i].x);
    }
    for (const std::size_t i : {0U, 1U, 3U, 4U}) {
      EXPECT_EQ(x_of(interned.number_of_point[i]), static_cast<double>(i));
    }
    EXPECT_EQ(interned.number_of_meeting_point[0], interned.number_of_point[1]);
    EXPECT_TRUE(interned.distinct[interned.number_of_point[1]].is_point);
  }
}

}  // namespace
}  // namespace exactcsg
