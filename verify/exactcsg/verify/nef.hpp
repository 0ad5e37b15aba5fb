// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The Nef oracle: the same tree through CGAL::Nef_polyhedron_3 with exact arithmetic. [Exact]
//
// It shares the primitives' vertices and facets with the kernel, and nothing else: no plane table,
// no predicate, no evaluator. Half-spaces are cut to a box so large that every meeting point of
// three planes of the model lies inside it; a solid that reaches the box is unbounded.
//
// Source: Hachenberger, Kettner, Mehlhorn, "Boolean operations on 3D selective Nef complexes",
// CGAL.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "exactcsg/solid/classify.hpp"
#include "exactcsg/solid/solid.hpp"
#include "exactcsg/support/progress.hpp"
#include "exactcsg/verify/facet_complex.hpp"

namespace exactcsg::verify {

struct NefResult {
  FacetComplex complex;
  std::vector<PointClass> classes;  // of the points asked for
};

// In this process, without limit. THROWS Error(OracleFailed | UnboundedSolid)
NefResult evaluate_nef(const Solid& solid, std::span<const Point3> points = {});

struct NefLimits {
  double seconds = 60;
  std::size_t memory = std::size_t{6} << 30U;
  Progress* progress = nullptr;
};

struct NefOutcome {
  bool answered = false;
  std::string reason;  // why not: "over the budget of 60 s", "out of memory", CGAL's message
  NefResult result;
};

// In a child process that is killed when its limits are reached.
NefOutcome run_nef(const Solid& solid, std::span<const Point3> points, const NefLimits& limits);

// One line of text each, so that the result can cross a process boundary.
std::string serialize(const NefResult& result);
NefResult deserialize_nef(const std::string& text);  // THROWS Error(OracleFailed)

}  // namespace exactcsg::verify
