// SPDX-License-Identifier: Apache-2.0
#pragma once

// A facet cut into convex parts along all that other facets have in common with it. [Exact]

#include <span>
#include <vector>

#include "exactcsg/solid/scene.hpp"

namespace exactcsg {

struct FacetPart {
  std::vector<Corner> corners;
  std::uint64_t share = 0;  // facet_share of piece_buffer.hpp
};

// Of the facet and the others given: LAW parts.1  the parts cover the facet and are disjoint but
// for their rims. LAW parts.2  the inside of a part meets another facet at most in single points,
// or lies in it as a whole.
// The lines are taken in an order without a pattern, and each cuts only those parts that the
// segment of it reaches (a planar binary space partition; M. Paterson and F. Yao, "Efficient binary
// space partitions for hidden-surface removal and solid modeling", Discrete and Computational
// Geometry 5, 1990). COST: O(k log k) expected for k segments.
std::vector<FacetPart> parts_of_facet(const Scene& scene, FacetIndex facet,
                                      std::span<const FacetIndex> others,
                                      TierStatistics& statistics);

}  // namespace exactcsg
