// SPDX-License-Identifier: Apache-2.0
#pragma once

// A solid made ready for decomposition: its primitives as numbers, their facets as convex polygons
// over one Geometry, and its tree over those numbers. Internal to the evaluator and the classifier.
//
// LAW scene.1  facets of one convex primitive lie in pairwise different planes.
// LAW scene.2  every facet's interior meets the open root cell, and no facet lies in its walls.

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "exactcsg/csg/flat_tree.hpp"
#include "exactcsg/number/geometry.hpp"
#include "exactcsg/solid/solid.hpp"

namespace exactcsg {

using PrimitiveIndex = std::uint32_t;
using FacetIndex = std::uint32_t;
using PrunedTree = csg::FlatTree<PrimitiveIndex, csg::BooleanOperator>;

// A corner of a convex polygon, and the plane that meets the polygon's plane in the side from this
// corner to the next.
struct Corner {
  Vertex vertex;
  PlaneRef side_plane;
};

// An open axis-parallel box.
struct Cell {
  std::array<double, 3> lower{};
  std::array<double, 3> upper{};
};

struct SceneFacet {
  PrimitiveIndex primitive = 0;
  OrientedPlaneRef plane;  // outward
  std::uint32_t first_corner = 0;
  std::uint32_t corner_count = 0;
};

struct ScenePrimitive {
  bool convex = true;  // half-spaces and convex polytopes; otherwise a closed mesh
  FacetIndex first_facet = 0;
  std::uint32_t facet_count = 0;
};

struct Range {
  double lower = std::numeric_limits<double>::infinity();
  double upper = -std::numeric_limits<double>::infinity();
};

// Along each axis, bounds that the true corners do not exceed.
struct SceneBounds {
  std::array<std::vector<Range>, 3> facets;
  std::array<std::vector<Range>, 3> primitives;
};

// Widens `bounds` so that the true corners do not exceed them.
void widen(std::array<Range, 3>& bounds, std::span<const Corner> corners);

struct Scene {
  Geometry geometry;
  std::vector<ScenePrimitive> primitives;
  std::vector<SceneFacet> facets;
  std::vector<Corner> corners;  // of all facets
  SceneBounds bounds;
  PrunedTree tree;
  Cell root;

  std::span<const Corner> corners_of(FacetIndex facet) const {
    return std::span(corners).subspan(facets[facet].first_corner, facets[facet].corner_count);
  }
};

// Occurrences of one handle in the tree become one primitive.
// THROWS Error(NumberOutOfRange) if a coordinate exceeds 1e290 in magnitude.
// COST: O(facets log facets).
Scene make_scene(const Solid& solid);

}  // namespace exactcsg
