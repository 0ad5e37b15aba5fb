// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Membranes in mesh files: OpenSCAD's Booleans are not regularised, and its exports hold both sides
// of every facet without thickness that they leave behind. [Certified]

#include <string>

#include "exactcsg/verify/facet_complex.hpp"
#include "exactcsg/verify/report.hpp"
#include "exactcsg/verify/welded_mesh.hpp"

namespace exactcsg::verify {

// Takes the facets of the membranes out of the mesh: those inside a membrane's outline whose
// corners all stand for vertices of that membrane. The check fails unless they cover each membrane
// once from either side: an area of twice its own, and area vectors that add up to nothing, both
// within what the format's rounding can change. So no facet of the solid is lost here unnoticed.
Check take_out_membranes(const FacetComplex& complex, WeldedMesh& mesh, const std::string& label);

}  // namespace exactcsg::verify
