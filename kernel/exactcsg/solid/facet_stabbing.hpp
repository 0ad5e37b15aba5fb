// SPDX-License-Identifier: Apache-2.0
#pragma once

// Winding numbers next to the facets of a closed surface that may meet itself in any way, by rays
// along the coordinate axes. [Exact]

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "exactcsg/solid/box_pairs.hpp"
#include "exactcsg/solid/scene.hpp"

namespace exactcsg {

// In front is along the stored normal of the plane in question.
struct WindingSides {
  std::int64_t front = 0;
  std::int64_t behind = 0;
  FacetIndex lowest = 0;  // of the facets that cover the place
};

class FacetStabbing {
 public:
  // REQUIRES the facets of the scene are those of closed surfaces, none of a half-space; outlives
  // this.
  explicit FacetStabbing(const Scene& scene);

  // The winding numbers on either side of a convex part of a facet.
  // REQUIRES the inside of the part meets other facets at most in single points, or lies in them as
  // a whole
  WindingSides winding_sides(FacetIndex facet, const CornerView& part,
                             TierStatistics& statistics) const;

 private:
  class Origin;
  std::optional<WindingSides> shoot(FacetIndex facet, const Origin& origin,
                                    TierStatistics& statistics) const;

  const Scene& scene_;
  std::vector<DoubleBox> boxes_;
  BoxHierarchy hierarchy_;
};

}  // namespace exactcsg
