// SPDX-License-Identifier: Apache-2.0
#pragma once

// What primitive.hpp says of large meshes, by several threads. [Exact]
//
// LAW primitive.2  neither the result nor what is thrown depends on the number of threads (as in
//                  EvaluateOptions).

#include "exactcsg/solid/primitive.hpp"

namespace exactcsg {

PolyhedralMesh make_mesh(Polyhedron polyhedron, unsigned threads);

Primitive apply(const AffineMap& map, const Primitive& primitive, unsigned threads);

}  // namespace exactcsg
