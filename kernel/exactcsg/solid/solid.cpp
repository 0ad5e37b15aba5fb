// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/solid.hpp"

#include <array>
#include <unordered_map>

#include "exactcsg/solid/primitive_in_parallel.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg {

Solid apply(const AffineMap& map, const Solid& solid, unsigned threads) {
  if (determinant(map) == 0) {
    throw Error(ErrorId::SingularMap, {"a matrix of determinant 0", "an invertible matrix"});
  }
  if (map == AffineMap::identity()) return solid;
  // Different nodes may hold the same polyhedron: keep it one. A table for each kind of shape.
  std::array<std::unordered_map<const StoredPolyhedron*, PrimitiveShape>,
             std::variant_size_v<PrimitiveShape>>
      images;
  return csg::map(solid, [&](const Primitive& primitive) {
    const StoredPolyhedron* polyhedron = polyhedron_of(primitive);
    if (polyhedron == nullptr) return apply(map, primitive, threads);
    auto& known = images[primitive.shape.index()];
    const auto found = known.find(polyhedron);
    if (found != known.end()) return Primitive{found->second, primitive.origin};
    Primitive image = apply(map, primitive, threads);
    known.emplace(polyhedron, image.shape);
    return image;
  });
}

}  // namespace exactcsg
