// SPDX-License-Identifier: Apache-2.0
#pragma once

// A solid: a CSG tree of primitives under the regularised Boolean operators.

#include "exactcsg/csg/boolean_operator.hpp"
#include "exactcsg/csg/tree.hpp"
#include "exactcsg/solid/primitive.hpp"

namespace exactcsg {

using Solid = csg::Tree<Primitive, csg::BooleanOperator>;

// The image of a solid under an invertible map: every primitive mapped. A primitive or subtree that
// occurs several times is mapped once. threads: as in EvaluateOptions, for the vertices of each.
// THROWS Error(SingularMap)
Solid apply(const AffineMap& map, const Solid& solid, unsigned threads = 1);

}  // namespace exactcsg
