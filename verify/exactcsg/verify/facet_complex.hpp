// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The boundary as an oracle gives it: oriented planar facets between shared vertices, exact, and
// the sets that are compared with our canonical boundary. [Exact]
//
// Nothing here is shared with the evaluator: volume is a divergence sum over the oracle's own
// cycles, and the canonical sets are made by cancelling and joining the oracle's own edges.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "exactcsg/number/point.hpp"
#include "exactcsg/solid/boundary.hpp"
#include "exactcsg/verify/exact_sums.hpp"
#include "exactcsg/verify/report.hpp"

namespace exactcsg::verify {

struct OracleFacet {
  Plane plane;  // outward: the solid is at plane <= 0
  // Every boundary cycle, each in either direction but all of one facet consistent with one
  // another.
  std::vector<std::vector<std::uint32_t>> cycles;
};

// A conforming complex: two facets meet in common vertices and whole edges.
struct FacetComplex {
  std::vector<Point3> vertices;
  std::vector<OracleFacet> facets;
  // Facets of the oracle without thickness, with nothing inside on either side: left out of
  // `facets`.
  std::vector<OracleFacet> membranes;
};

using ExactEdge = std::array<Point3, 2>;  // [0] < [1]

// Sorted, without repetition.
struct CanonicalSets {
  std::vector<Point3> vertices;
  std::vector<ExactEdge> edges;
  std::vector<Plane> planes;
};

// Divergence sums over the oracle's cycles, and over our loops.
VolumeSum volume_sum(const FacetComplex& complex);
VolumeSum volume_sum(const Boundary& boundary);

// LAW complex.1  the sets depend on the regularised solid alone: coplanar facets are joined,
// vertices inside a straight edge dropped.
CanonicalSets canonical_sets(const FacetComplex& complex);
CanonicalSets canonical_sets(const Boundary& boundary);

// "volume", "vertices", "edges", "planes", each named "<label>: ..." and held against equality.
std::vector<Check> compare_exactly(const Boundary& boundary, const FacetComplex& oracle,
                                   const std::string& oracle_name, const std::string& label);

// Text of exact values for messages: "(1/2, 0, 3)", long fractions as decimals with 17 digits.
std::string describe(const Point3& point);
std::string describe(const ExactEdge& edge);
std::string describe(const Plane& plane);
std::array<double, 3> approximate(const Point3& point);

}  // namespace exactcsg::verify
