// SPDX-License-Identifier: Apache-2.0
#pragma once

// Facets of which every part came out as boundary, put together again before merging: most facets
// of a model are cut by cell walls only, and whole they need no seams to be cancelled. [Exact]

#include <vector>

#include "exactcsg/solid/cell_evaluation.hpp"
#include "exactcsg/solid/scene.hpp"

namespace exactcsg {

// LAW whole.1  the pieces cover the same points of every oriented plane before and after.
// Afterwards a piece is the whole facet of the scene, corner by corner, iff its share is `whole`,
// and none is a slice. Buffers hold nothing that no piece needs. COST: O(corners + facets of the
// scene).
void restore_whole_facets(const Scene& scene, std::vector<PieceBuffer>& buffers,
                          unsigned threads = 1);

}  // namespace exactcsg
