// SPDX-License-Identifier: Apache-2.0
// Affine images of primitives.
#include <algorithm>
#include <type_traits>
#include <utility>

#include "exactcsg/solid/primitive.hpp"
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
                                                 const Polyhedron& polyhedron) {
  auto image = std::make_shared<Polyhedron>();
  image->vertices.reserve(polyhedron.vertices.size());
  for (const Point3& p : polyhedron.vertices) {
    image->vertices.push_back(
        {map_coordinate(map.m[0], p), map_coordinate(map.m[1], p), map_coordinate(map.m[2], p)});
  }
  image->facets = polyhedron.facets;
  if (mirrors) {
    for (Facet& facet : image->facets) std::reverse(facet.begin(), facet.end());
  }
  return image;
}

}  // namespace

Primitive apply(const AffineMap& map, const Primitive& primitive) {
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
          return Shape{map_polyhedron(map, sign == Sign::Negative, *original.polyhedron)};
        }
      },
      primitive.shape);
  return {shape, primitive.origin};
}

}  // namespace exactcsg
