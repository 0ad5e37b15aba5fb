// SPDX-License-Identifier: Apache-2.0
#pragma once

// The exact evaluator: from a CSG tree to its canonical boundary. [Exact]
//
// Recursive decomposition of space (an instance of skeleton::divacon): a task is a cell, the facets
// clipped to it and the tree pruned to it. A cell with few facets is evaluated by two-sided
// classification: every facet is cut by the other primitives' planes until the pruned tree is
// constant in front and behind; different means boundary. Coincident faces need no tolerance.
//
// Source: DESIGN section 4; local form of convex sets (docs/architecture.md); pruning after the
// Bath modellers; divacon after Davy and Dew, section 3.1.

#include <cstddef>

#include "exactcsg/solid/boundary.hpp"
#include "exactcsg/solid/solid.hpp"
#include "exactcsg/support/progress.hpp"

namespace exactcsg {

struct EvaluateOptions {
  unsigned threads = 1;  // 1: sequential executor; 0: as many as the machine has
  // Cells with at most so many facets are evaluated, and by `evaluate` also cells with more of them
  // that two or three convex primitives have.
  std::size_t facets_per_cell = 24;
  Progress* progress = nullptr;  // advanced and asked for cancellation, if given
};

// LAW evaluate.1  the result is boundary.1's canonical boundary of the regularised set.
// THROWS Error(UnboundedSolid) if the set is unbounded (Full included), and what Progress throws.
// The empty set has an empty boundary.
Boundary evaluate(const Solid& solid, const EvaluateOptions& options = {});

}  // namespace exactcsg
