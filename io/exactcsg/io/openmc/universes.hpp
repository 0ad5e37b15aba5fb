// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// How universes are put down in each other. [Exact]

#include <vector>

#include "exactcsg/domain/bounded_primitives.hpp"
#include "exactcsg/io/openmc/model.hpp"

namespace exactcsg::io::openmc {

// All universes, each after all that contain it (LAW openmc_model.2: there is no cycle).
std::vector<Index> universes_from_above(const Model& model);

// THROWS Error(CyclicFill) at a cell that is filled with a universe that it is itself part of.
void refuse_cycles(const Model& model);

AffineMap translation(const domain::Coordinates<3>& offset);
HalfSpaceRegion region_of(const domain::Solid3& solid);
HalfSpaceRegion moved(const AffineMap& map, const HalfSpaceRegion& region);

// The centre of a lattice's element as a translation of what it holds: lattices without layers
// leave z alone.
domain::Coordinates<3> place_of_element(const Lattice& lattice, domain::Coordinates<3> centre);

// The points of the element at this centre, in the lattice's coordinates.
HalfSpaceRegion element_region(const Lattice& lattice, const domain::Coordinates<3>& centre);

}  // namespace exactcsg::io::openmc
