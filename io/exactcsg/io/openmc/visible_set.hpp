// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The points of an OpenMC model where chosen cells are visible, as one region in the coordinates of
// the root universe. [Exact]
//
//   material_set(model)        all cells of a material; void is none
//   cell_set(model, cell id)   one cell, wherever it is visible
//
// LAW visible_set.1  each point has the class that it would have for the cells' own regions,
// clipped
//                    by the cells and elements above; where cells overlap, in their union.
// THROWS Error(UndefinedId) of an id that no cell has; Error(UnboundedSolid) where the outer
// universe of a lattice repeats without end; Error(TooLarge) above 10 000 000 half-spaces. COST:
// O(half-spaces of all instances).

#include <functional>

#include "exactcsg/io/openmc/model.hpp"

namespace exactcsg::io::openmc {

HalfSpaceRegion visible_set(const Model& model, const std::function<bool(const Cell&)>& is_chosen);
HalfSpaceRegion material_set(const Model& model);
HalfSpaceRegion cell_set(const Model& model, Id cell);

}  // namespace exactcsg::io::openmc
