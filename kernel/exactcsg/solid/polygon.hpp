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

// The same with respect to a wall, into `signs` (resized).
PlaneSplit wall_signs(const Geometry& geometry, const CornerView& polygon, Axis axis,
                      double position, std::vector<Sign>& signs, TierStatistics& statistics);

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

// Walls that leave a part of a facet, and on which side.
class Slice {
 public:
  struct Wall {
    PlaneRef plane;
    Sign kept = Sign::Zero;
  };

  void add(const Wall& wall) { walls_[count_++] = wall; }
  std::span<const Wall> walls() const { return std::span(walls_).first(count_); }

 private:
  std::array<Wall, 6> walls_;
  std::size_t count_ = 0;
};

// Cuts such parts, in memory of its own.
class Slicer {
 public:
  // The corners of the part, appended to `result`. REQUIRES the polygon lies in `supporting`, and a
  // part of it is on the kept sides of all walls, of which there is one.
  void append(const Geometry& geometry, const CornerView& polygon, PlaneRef supporting,
              const Slice& slice, std::vector<Corner>& result);

 private:
  void cut(const Geometry& geometry, const CornerView& polygon, PlaneRef supporting,
           const Slice::Wall& wall, std::vector<Corner>& result);

  std::vector<Sign> signs_;
  std::array<std::vector<Corner>, 2> parts_;  // in turn
};

}  // namespace exactcsg
