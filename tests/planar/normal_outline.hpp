// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Outlines in a form that two engines must agree on, and the laws of one. [Exact]

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>
#include <vector>

#include "exactcsg/planar/outline.hpp"
#include "io/planar_support.hpp"

namespace exactcsg::test {

using NormalPoint = std::pair<Rational, Rational>;
using NormalLoop = std::vector<NormalPoint>;  // from its least point
struct NormalComponent {
  NormalLoop outer;
  std::vector<NormalLoop> holes;  // in order
  bool convex = false;
  friend auto operator<=>(const NormalComponent& a, const NormalComponent& b) {
    return std::tie(a.outer, a.holes, a.convex) <=> std::tie(b.outer, b.holes, b.convex);
  }
  friend bool operator==(const NormalComponent&, const NormalComponent&) = default;
};

inline std::vector<NormalComponent> normal(const Outline& outline) {
  std::vector<NormalComponent> result;
  for (const OutlineComponent& component : outline.components) {
    NormalComponent& normal = result.emplace_back();
    normal.convex = component.convex;
    for (const PlanarLoop& loop : component.loops) {
      NormalLoop points;
      for (const std::uint32_t v : loop) {
        points.emplace_back(outline.points[v].x, outline.points[v].y);
      }
      std::rotate(points.begin(), std::min_element(points.begin(), points.end()), points.end());
      if (&loop == component.loops.data()) {
        normal.outer = std::move(points);
      } else {
        normal.holes.push_back(std::move(points));
      }
    }
    std::sort(normal.holes.begin(), normal.holes.end());
  }
  std::sort(result.begin(), result.end());
  return result;
}

inline Rational area(const Outline& outline) {
  Rational sum = 0;
  for (const OutlineComponent& component : outline.components) {
    for (const PlanarLoop& loop : component.loops) {
      io::test::Path path;
      for (const std::uint32_t v : loop) path.push_back(outline.points[v]);
      sum += io::test::area(path);
    }
  }
  return sum;
}

// LAW outline.1, as far as one loop after the other tells.
inline void expect_simple_loops(const Outline& outline) {
  std::vector<NormalPoint> points;
  for (const Point2& p : outline.points) points.emplace_back(p.x, p.y);
  std::sort(points.begin(), points.end());
  EXPECT_EQ(std::adjacent_find(points.begin(), points.end()), points.end());
  for (const OutlineComponent& component : outline.components) {
    for (const PlanarLoop& loop : component.loops) {
      io::test::Path path;
      for (const std::uint32_t v : loop) path.push_back(outline.points[v]);
      EXPECT_EQ(io::test::area(path) > 0, &loop == component.loops.data());
      PlanarLoop sorted = loop;
      std::sort(sorted.begin(), sorted.end());
      EXPECT_EQ(std::adjacent_find(sorted.begin(), sorted.end()), sorted.end());
    }
  }
}

}  // namespace exactcsg::test
