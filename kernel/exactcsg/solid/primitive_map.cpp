// SPDX-License-Identifier: Apache-2.0
// Affine images of primitives.
#include <algorithm>
#include <type_traits>
#include <utility>

#include "exactcsg/solid/in_parallel.hpp"
#include "exactcsg/solid/primitive_in_parallel.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg {

namespace {

// Most maps of real models have many zeros and ones: skip what they do not change.
Rational map_coordinate(const std::array<Rational, 4>& row, const Point3& p) {
  Rational sum = row[3];
  const std::array<const Rational*, 3> coordinates{&p.x, &p.y, &p.z};
  for (std::size_t i = 0; i < 3; ++i) {
    if (sgn(row[i]) == 0 || sgn(*coordinates[i]) == 0) continue;
    if (row[i] == 1) {
      if (sgn(sum) == 0) {
        sum = *coordinates[i];
      } else {
        sum += *coordinates[i];
      }
    } else {
      sum += row[i] * *coordinates[i];
    }
  }
  return sum;
}

std::shared_ptr<const Polyhedron> map_polyhedron(const AffineMap& map, bool mirrors,
                                                 const Polyhedron& polyhedron, unsigned threads) {
  auto image = std::make_shared<Polyhedron>();
  image->vertices.resize(polyhedron.vertices.size());
  in_parallel_parts(threads, image->vertices.size(), [&](std::size_t v) {
    const Point3& p = polyhedron.vertices[v];
    image->vertices[v] = {map_coordinate(map.m[0], p), map_coordinate(map.m[1], p),
                          map_coordinate(map.m[2], p)};
  });
  image->facets.resize(polyhedron.facets.size());
  in_parallel_parts(threads, image->facets.size(), [&](std::size_t f) {
    image->facets[f] = polyhedron.facets[f];
    if (mirrors) std::reverse(image->facets[f].begin(), image->facets[f].end());
  });
  return image;
}

}  // namespace

Primitive apply(const AffineMap& map, const Primitive& primitive) {
  return apply(map, primitive, 1);
}

Primitive apply(const AffineMap& map, const Primitive& primitive, unsigned threads) {
  const Sign sign = sign_of(determinant(map));
  if (sign == Sign::Zero) {
    throw Error(ErrorId::SingularMap, {"a matrix of determinant 0", "an invertible matrix"});
  }
  if (map == AffineMap::identity()) return primitive;
  const PrimitiveShape shape = std::visit(
      [&](const auto& original) -> PrimitiveShape {
        using Shape = std::decay_t<decltype(original)>;
        if constexpr (std::is_same_v<Shape, HalfSpace>) {
          return HalfSpace{apply(map, original.plane)};
        } else {
          return Shape{map_polyhedron(map, sign == Sign::Negative, *original.polyhedron, threads)};
        }
      },
      primitive.shape);
  return {shape, primitive.origin};
}

}  // namespace exactcsg
