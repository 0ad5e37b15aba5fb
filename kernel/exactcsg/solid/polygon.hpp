// SPDX-License-Identifier: Apache-2.0
#pragma once

// Convex polygons as runs of corners, and cutting them by planes. Internal to the evaluator.
// [Exact]

#include <array>
#include <span>
#include <vector>

#include "exactcsg/solid/scene.hpp"

namespace exactcsg {

// What a plane does to a polygon that does not lie in it.
enum class PlaneSplit : unsigned char { AllNegative, AllPositive, Both, InPlane };

// The sides of all corners with respect to a plane, into `signs` (resized).
PlaneSplit split_signs(const Geometry& geometry, const CornerView& polygon, PlaneRef plane,
                       std::vector<Sign>& signs, TierStatistics& statistics);

// Where a plane crosses a convex polygon that lies in `supporting`, computed once for both parts.
class PolygonCut {
 public:
  // REQUIRES `signs` of split_signs, which said Both.
  PolygonCut(const Geometry& geometry, const CornerView& polygon, PlaneRef supporting,
             PlaneRef plane, std::span<const Sign> signs);

  // The part of the polygon on the given side of the plane, appended to `result`. REQUIRES the
  // polygon and the signs given are still there. A new corner is the meeting point of the
  // supporting plane, the cut side's plane and the cutting plane.
  void append_part(const CornerView& polygon, std::span<const Sign> signs, Sign kept,
                   std::vector<Corner>& result) const;

 private:
  PlaneRef plane_;
  std::array<Vertex, 2> crossings_;  // in the order of the sides
};

}  // namespace exactcsg
