// SPDX-License-Identifier: Apache-2.0
#pragma once

// From convex boundary pieces to the canonical boundary. [Exact]
//
// 1. Equal positions get one number, equal lines get one number.
// 2. On every oriented plane, piece edges are added up along their lines as signed intervals: seams
//    cancel (T-junctions included) and join the pieces on either side to one face; what is left
//    bounds faces.
// 3. A vertex is where edges of two or more lines meet, also where edges only touch; edges are
//    maximal between vertices.
// 4. Each face's edges are linked to loops, the interior kept on the left.
//
// Source: DESIGN section 5 (docs/architecture.md).

#include <vector>

#include "exactcsg/solid/boundary.hpp"
#include "exactcsg/solid/cell_evaluation.hpp"
#include "exactcsg/support/progress.hpp"

namespace exactcsg {

// REQUIRES the pieces are what cell evaluation emits for one bounded solid: closed, and disjoint
// but for their rims; a piece whose share is `whole` is a facet of the scene, of no half-space.
// THROWS Error(InternalError) where they are not. The statistics of the result hold what merging
// itself counted.
Boundary merge_pieces(const Scene& scene, std::vector<PieceBuffer> buffers, unsigned threads,
                      Progress* progress);
// The same; the scene's facets are given up, as their memory is wanted.
Boundary merge_pieces(Scene&& scene, std::vector<PieceBuffer> buffers, unsigned threads,
                      Progress* progress);

}  // namespace exactcsg
