// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// From the nodes of a .csg file to a solid. Iterative: neither the depth of the nodes nor the
// number of children costs call stack.

#include "exactcsg/io/model.hpp"
#include "exactcsg/io/openscad/syntax.hpp"

namespace exactcsg::io::openscad {

// As `Rounding::AsWritten` says; docs/openscad.md has the rules.
// THROWS Error with the position of the node or argument.
Model evaluate_as_written(const SyntaxTree& tree, const ReadOptions& options);

// As `Rounding::OpenScadGrid` says; grid_rounding.hpp has the rules.
// THROWS Error(UnsupportedNode), besides, for what OpenSCAD's rounding leaves uncertain.
Model evaluate_on_grid(const SyntaxTree& tree, const ReadOptions& options);

}  // namespace exactcsg::io::openscad
