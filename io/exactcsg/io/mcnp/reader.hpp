// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The geometry of an MCNP input file, in the model that OpenMC's geometries are read into. [Exact]
//
// Read are cell cards, surface cards and TRn cards; the other data cards say nothing about
// geometry. LAW mcnp_reader.1  decimals mean themselves. Rounded are, to an exactly orthogonal
// matrix near by,
//                    rotations whose numbers are not exactly orthogonal (docs/mcnp.md), and the
//                    root of three in a hexagonal prism that is given by one vector of three.
// LAW mcnp_reader.2  bodies are the intersections of their facets; a surface "n.m" is the facet. A
//                    cone of one sheet is the cone cut by a plane through its apex.
// LAW mcnp_reader.3  a lattice cell is a cell that is filled with a lattice of its own number;
//                    elements are named as the file numbers them.
// LAW mcnp_reader.4  every text is answered: by a model, or by an Error.
// Cells of importance 0 are cells. There are no vacuum boundaries: every place has to be in a cell
// (Model::fills_space).

#include <string>
#include <string_view>

#include "exactcsg/io/openmc/model.hpp"

namespace exactcsg::io::mcnp {

// THROWS Error with line and column for everything that is wrong with the text, and for what is not
// supported (UnsupportedNode; docs/limits.md).
openmc::Model read_geometry(std::string_view text, std::string name);

}  // namespace exactcsg::io::mcnp
