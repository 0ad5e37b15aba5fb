// SPDX-License-Identifier: Apache-2.0
// Affine images of primitives.
#include <algorithm>
#include <type_traits>
#include <utility>

#include "exactcsg/solid/prepared_polyhedron.hpp"
#include "exactcsg/solid/primitive_in_parallel.hpp"
#include "exactcsg/support/error.hpp"
#include "exactcsg/support/in_parallel.hpp"

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

std::vector<Point3> map_points(const AffineMap& map, const ExactPoints& points, unsigned threads) {
  std::vector<Point3> images(points.size());
  in_parallel_parts(threads, images.size(), [&](std::size_t v) {
    const Point3 p = points[v];
    images[v] = {map_coordinate(map.m[0], p), map_coordinate(map.m[1], p),
                 map_coordinate(map.m[2], p)};
  });
  return images;
}

bool is_translation(const AffineMap& map) {
  const AffineMap identity = AffineMap::identity();
  for (std::size_t i = 0; i < 3; ++i) {
    if (!std::equal(map.m[i].begin(), map.m[i].begin() + 3, identity.m[i].begin())) return false;
  }
  return true;
}

Polyhedron with_facets(std::vector<Point3> vertices, const FlatFacets& facets, bool turned_round) {
  Polyhedron result{std::move(vertices), {}};
  result.facets.reserve(facets.size());
  for (const auto facet : facets) {
    Facet& copy = result.facets.emplace_back(facet.begin(), facet.end());
    if (turned_round) std::reverse(copy.begin(), copy.end());
  }
  return result;
}

ConvexPolytope image_of(const AffineMap& map, bool mirrors, const ConvexPolytope& polytope,
                        unsigned threads) {
  const StoredPolyhedron& original = *polytope.polyhedron;
  std::vector<Point3> vertices = map_points(map, original.vertices, threads);
  if (original.prepared && !mirrors) {
    return {store_image(vertices, original.prepared->facets, threads)};
  }
  return {store_polytope(with_facets(std::move(vertices), original.facets, mirrors))};
}

PolyhedralMesh image_of(const AffineMap& map, bool mirrors, const PolyhedralMesh& mesh,
                        unsigned threads) {
  const StoredPolyhedron& original = *mesh.polyhedron;
  std::vector<Point3> vertices = map_points(map, original.vertices, threads);
  if (original.prepared && is_translation(map)) {
    return {store_image(vertices, original.prepared->facets, threads)};
  }
  return {store_mesh(with_facets(std::move(vertices), original.facets, mirrors), threads)};
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
          return image_of(map, sign == Sign::Negative, original, threads);
        }
      },
      primitive.shape);
  return {shape, primitive.origin};
}

}  // namespace exactcsg
