// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The OpenSCAD oracle: three comparisons in falling strength (docs/openscad.md).
//  1. The model read with OpenSCAD's own input rounding against its .nef3: equal rationals and
//  sets.
//  2. The model as written against the .nef3, within a bound computed from the displacement of
//  every
//     primitive and its area.
//  3. The model against OpenSCAD's exports (OFF, binary STL), within the format's rounding.
//     OpenSCAD's membranes without thickness, which the .nef3 names, are taken out of them first.
//
// OpenSCAD exits 0 when it drops an operand; an oracle that reports an error of its own is skipped.
// Where OpenSCAD's rounding depends on its triangulation (E0104 under Rounding::OpenScadGrid) 1 and
// 2 are skipped, and 3 takes the model as written, its vertices displaced by 2^-19 more, or by
// 2^-15 where that does not do (outlines are cut to 2^-16); a file that does not agree within that
// is undecided and skipped. An export that OpenSCAD itself doubts
// ("may not be a valid 2-manifold") is compared, and skipped if it differs. Every skip has its row.

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "exactcsg/io/model.hpp"
#include "exactcsg/solid/boundary.hpp"
#include "exactcsg/support/progress.hpp"
#include "exactcsg/verify/facet_complex.hpp"
#include "exactcsg/verify/report.hpp"

namespace exactcsg::verify {

struct OpenScadOptions {
  std::string program = "openscad";
  double budget_seconds = 60;  // of each run
  std::size_t memory_limit = std::size_t{6} << 30U;
  unsigned threads = 1;
  bool exports = true;  // comparison 3
  Progress* progress = nullptr;
  std::vector<std::string>* notes = nullptr;  // what the reader of a report should know
};

// The exact complex of a .nef3 file ("Selective Nef Complex, standard"). Only facets that separate
// a marked volume from an unmarked one are kept. THROWS Error(OracleFailed) naming the line.
FacetComplex parse_nef3(const std::string& text);

std::vector<Check> compare_with_openscad(const io::Model& model, const Boundary& boundary,
                                         const std::filesystem::path& source,
                                         const OpenScadOptions& options);

// The first comparison alone: our boundary under OpenSCAD's rounding against the .nef3's complex.
std::vector<Check> compare_with_nef3(const Boundary& gridded, const FacetComplex& nef3);

// An upper bound of the volume of the symmetric difference of two solids written by the same tree,
// whose primitives correspond one to one: the sum over the primitives of what their displacement
// can sweep. nullopt if they do not correspond. [Certified]
struct DisplacementBound {
  Rational volume{0};
  double largest_displacement = 0;
  std::size_t moved_primitives = 0;
};
std::optional<DisplacementBound> displacement_bound(const Solid& as_written, const Solid& gridded);

}  // namespace exactcsg::verify
