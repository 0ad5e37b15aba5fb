// SPDX-License-Identifier: Apache-2.0
#pragma once

// What a closed curve bounds, as a model of Domain: strip trees in CSG trees beside half-planes and
// discs. [Exact]
//
// The region is the set of points round which the curve goes an odd number of times, and the curve;
// or the closure of the complement of that; or its image by an affine map. It is an immutable value
// that shares the strip tree.
//
// LAW curve_region.1  points, complements, maps and sections obey LAWs half_space.1 and .3 to .5 if
//                     the curve does not meet itself; where it runs twice along a segment, that is
//                     On and no more.
// LAW curve_region.2  a box is Unknown iff the curve meets its interior, else In or Out as a whole.
// COST: a point as for strip trees; a box and a line O(log n) rational operations for every segment
// near them; a section one point besides for each of its pieces.
//
// Source: Davy and Dew, section 3.7 (strip trees as a domain); Ballard, CACM 24(5), 1981.

#include <cstddef>
#include <memory>

#include "exactcsg/domain/half_space.hpp"
#include "exactcsg/domain/strip_tree.hpp"
#include "exactcsg/number/point.hpp"

namespace exactcsg::domain {

class CurveRegion {
 public:
  static constexpr std::size_t dimension = 2;

  // THROWS Error(BadArgument) if the curve is not closed.
  explicit CurveRegion(StripTree curve);

  const StripTree& curve() const noexcept { return *curve_; }
  // From the plane of the curve to that of the region, and back.
  const AffineMap& placement() const noexcept { return placement_; }
  const AffineMap& way_back() const noexcept { return way_back_; }
  bool is_complement() const noexcept { return is_complement_; }

  friend CurveRegion complement(CurveRegion region) {
    region.is_complement_ = !region.is_complement_;
    return region;
  }
  // THROWS Error(SingularMap) if the map is singular.
  friend CurveRegion apply(const AffineMap& map, CurveRegion region);

 private:
  std::shared_ptr<const StripTree> curve_;
  AffineMap placement_ = AffineMap::identity();
  AffineMap way_back_ = AffineMap::identity();
  bool is_complement_ = false;
};

PointClass classify(const CurveRegion& region, const Point<2>& point);
csg::Membership classify(const CurveRegion& region, const Box<2>& box);
Section section(const CurveRegion& region, const LineSection<2>& line);

static_assert(Domain<CurveRegion>);

}  // namespace exactcsg::domain
