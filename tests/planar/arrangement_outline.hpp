// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// An independent engine for planar sets: one CGAL arrangement of all edges of all figures, whose
// cells are walked through with the tree's value kept up to date. It shares no code with the
// evaluator but the types of its answer. [Exact]

#include "exactcsg/planar/outline.hpp"

namespace exactcsg::test {

// As exactcsg::outline_of.
Outline arrangement_outline(const PlanarTree& tree);

}  // namespace exactcsg::test
