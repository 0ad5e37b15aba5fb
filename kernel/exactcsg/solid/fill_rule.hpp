// SPDX-License-Identifier: Apache-2.0
#pragma once

// The solid that a closed surface bounds by its winding numbers, where facets may cross, overlap in
// one plane, touch and nest in any way. [Exact]
//
// The winding number of a point off the surface is how often the surface goes round it: the facets
// that a ray from the point leaves through, less those that it enters through. A rule says which
// numbers are inside; the solid is the closure of the interior of the points where it holds.
//
// LAW fill.1  of a mesh that make_mesh accepts, the boundary is that of evaluate, by every rule.
// LAW fill.2  of the surfaces of several solids taken together, NonZero and Positive give their
// union and EvenOdd their symmetric difference.
// LAW fill.3  turning every facet round leaves NonZero and EvenOdd as they are.
//
// Source: the two-sided classification of docs/architecture.md, with numbers in place of truth
// values.

#include <cstdint>
#include <string_view>

#include "exactcsg/solid/boundary.hpp"
#include "exactcsg/solid/evaluate.hpp"
#include "exactcsg/solid/primitive.hpp"

namespace exactcsg {

enum class FillRule : unsigned char { NonZero, Positive, EvenOdd };

constexpr bool is_inside(FillRule rule, std::int64_t winding) {
  switch (rule) {
    case FillRule::NonZero:
      return winding != 0;
    case FillRule::Positive:
      return winding > 0;
    case FillRule::EvenOdd:
      return winding % 2 != 0;
  }
  return false;
}

// "nonzero", "positive", "even-odd"
std::string_view name_of(FillRule rule);

// The canonical boundary of the points where the rule holds; empty if there are none. Of the
// options, facets_per_cell is not used.
// REQUIRES nothing of how facets meet. THROWS Error(DegenerateFacet | NonPlanarFacet |
//          NonConvexFacet | OpenMesh | UnknownVertex | NumberOutOfRange), and what Progress throws.
// COST: O(n log n) expected for facets that meet others in common vertices and edges only. For the
// others O(k log k) each, k being the facets that it meets otherwise, and a ray for each part that
// it is cut into.
Boundary filled_boundary(Polyhedron polyhedron, FillRule rule, const EvaluateOptions& options = {});

// Whether the facets are the whole boundary of a solid, every point of it in the inside of at most
// one facet, with their fronts outside. They may touch each other in any way, where make_mesh wants
// them to meet in common vertices and edges only, but neither cross nor overlap.
// THROWS and COST as filled_boundary.
bool is_boundary_of_solid(Polyhedron polyhedron, const EvaluateOptions& options = {});

}  // namespace exactcsg
