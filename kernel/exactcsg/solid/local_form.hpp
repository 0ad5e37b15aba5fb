// SPDX-License-Identifier: Apache-2.0
#pragma once

// The local form of a primitive: a binary space partition by the facets that reach a cell, and by
// nothing else. [Exact]
//
// For a convex primitive it is the chain of those facets' half-spaces: inside all of them is inside
// the primitive (lemma in docs/architecture.md). For a mesh it is the autopartition of the clipped
// facets (Thibault and Naylor 1987): where no facet is left on one side of a facet, that side is
// outside in front of it and inside behind it.
//
// LAW local.1  for every point of the open cell off the partition's planes, walking down the nodes
// ends in In exactly for the points of the primitive.

#include <cstdint>
#include <span>
#include <vector>

#include "exactcsg/csg/boolean_operator.hpp"
#include "exactcsg/solid/scene.hpp"

namespace exactcsg {

// Where a walk through a local form stands: at a node, or decided.
class LocalPlace {
 public:
  static constexpr LocalPlace at_node(std::uint32_t index) {
    return LocalPlace(static_cast<std::int64_t>(index));
  }
  static constexpr LocalPlace decided(csg::Membership membership) {
    return LocalPlace(membership == csg::Membership::In ? -2 : -1);
  }
  constexpr bool is_decided() const { return value_ < 0; }
  constexpr std::uint32_t node() const { return static_cast<std::uint32_t>(value_); }
  constexpr csg::Membership membership() const {
    return value_ == -2 ? csg::Membership::In : csg::Membership::Out;
  }
  friend constexpr bool operator==(LocalPlace, LocalPlace) = default;

 private:
  explicit constexpr LocalPlace(std::int64_t value) : value_(value) {}
  std::int64_t value_;
};

struct LocalNode {
  PlaneRef plane;
  LocalPlace positive = LocalPlace::decided(csg::Membership::Out);  // along the stored normal
  LocalPlace negative = LocalPlace::decided(csg::Membership::Out);
};

// A facet clipped to the cell.
struct FacetPolygon {
  OrientedPlaneRef plane;
  CornerView corners;
};

// Appends the nodes of one primitive's local form and returns where a walk begins.
// REQUIRES facets not empty.
LocalPlace append_convex_form(std::span<const FacetPolygon> facets, std::vector<LocalNode>& nodes);
LocalPlace append_mesh_form(const Geometry& geometry, std::span<const FacetPolygon> facets,
                            std::vector<LocalNode>& nodes, TierStatistics& statistics);

}  // namespace exactcsg
