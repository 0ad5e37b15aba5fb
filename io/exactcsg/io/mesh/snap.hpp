// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// A boundary rounded to what a file's format can hold, and repaired where rounding broke it.
// [Exact, of the rounded numbers]
//
// Rounding may turn triangles flat or over, and let facets cross. A flat triangle is taken out, its
// middle corner becoming a corner of the neighbour; of a surface that crosses itself the solid in
// which the winding number is positive is computed exactly, its boundary triangulated and rounded
// again (iterated snap rounding), until a surface comes out that bounds a solid. If none does, that
// is tried again on coarser grids.

#include "exactcsg/io/mesh/mesh_file.hpp"
#include "exactcsg/solid/evaluate.hpp"

namespace exactcsg::io {

struct SnappedSurface {
  RoundedSurface surface;
  unsigned rounds = 0;             // of crossings that were resolved, over all grids
  std::size_t flat_triangles = 0;  // that were taken out of the surface, in its last rounding
  double grid = 0;                 // its cells, if it was not the format's own
  // No point of the surface was moved by more, but for parts that were cut off because they came to
  // cover others or turned over.
  double largest_move = 0;
  double volume_change = 0;
};

// LAW snap.1  the surface bounds a solid: examine (written_surface.hpp) finds no fault, and reading
// a file written from it gives the same points. LAW snap.2  where plain rounding breaks nothing, it
// is the surface that write_boundary writes.
// THROWS the fault that remains on the coarsest grid, as Error(DegenerateFacet | OpenMesh |
// InvertedMesh | SelfIntersectingMesh); Error(NumberOutOfRange) for coordinates that the format
// cannot hold, Error(EmptySolid) if the boundary is empty, and what Progress throws.
SnappedSurface snap(const Boundary& boundary, bool single_precision,
                    const EvaluateOptions& options = {});

}  // namespace exactcsg::io
