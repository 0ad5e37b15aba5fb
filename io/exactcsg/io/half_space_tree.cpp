// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/half_space_tree.hpp"

#include <array>
#include <compare>
#include <set>
#include <utility>
#include <vector>

#include "exactcsg/io/planar/substitute.hpp"

namespace exactcsg::io {

namespace {

using domain::Solid3;

struct IsBefore {
  bool operator()(const Plane& p, const Plane& q) const {
    return compare(p, q) == std::strong_ordering::less;
  }
};

bool are_collinear(const Point3& p, const Point3& q, const Point3& r) {
  const std::array<Rational, 3> a{Rational(q.x - p.x), Rational(q.y - p.y), Rational(q.z - p.z)};
  const std::array<Rational, 3> b{Rational(r.x - p.x), Rational(r.y - p.y), Rational(r.z - p.z)};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    if (a[i] * b[j] != a[j] * b[i]) return false;
  }
  return true;
}

// Of all facets, each once. A facet may have vertices in straight sides, and corners elsewhere.
std::set<Plane, IsBefore> planes_of(const StoredPolyhedron& polyhedron) {
  const std::vector<Point3> vertices = to_vector(polyhedron.vertices);
  std::set<Plane, IsBefore> result;
  for (const auto facet : polyhedron.facets) {
    const auto at = [&](std::size_t i) -> const Point3& {
      return vertices[facet[i % facet.size()]];
    };
    std::size_t corner = 0;
    while (are_collinear(at(corner), at(corner + 1), at(corner + 2))) ++corner;
    result.insert(plane_through(at(corner), at(corner + 1), at(corner + 2)));
  }
  return result;
}

domain::HalfSpace<3> half_space(const Plane& plane) {
  return domain::make_plane({Rational(plane.a), Rational(plane.b), Rational(plane.c)},
                            Rational(plane.d));
}

void check_convex(const StoredPolyhedron& polyhedron, const std::set<Plane, IsBefore>& planes,
                  const std::string& origin) {
  for (const Plane& plane : planes) {
    for (const Point3& vertex : polyhedron.vertices) {
      const Rational value = plane.a * vertex.x + plane.b * vertex.y + plane.c * vertex.z + plane.d;
      if (value > 0) {
        throw Error(ErrorId::NotConvex,
                    {origin.empty() ? std::string("a mesh") : "the mesh of " + origin,
                     "convex primitives where a model is held against a curved one"});
      }
    }
  }
}

Solid3 tree_of(const Primitive& primitive) {
  if (const auto* single = std::get_if<HalfSpace>(&primitive.shape)) {
    return Solid3::primitive(half_space(single->plane));
  }
  const StoredPolyhedron& polyhedron = *polyhedron_of(primitive);
  const auto planes = planes_of(polyhedron);
  if (std::holds_alternative<PolyhedralMesh>(primitive.shape)) {
    check_convex(polyhedron, planes, primitive.origin);
  }
  std::vector<Solid3> sides;
  for (const Plane& plane : planes) sides.push_back(Solid3::primitive(half_space(plane)));
  return Solid3::compose(csg::BooleanOperator::Intersection, std::move(sides));
}

}  // namespace

Solid3 half_space_tree(const Solid& solid) { return substitute(solid, Solid3::full(), tree_of); }

}  // namespace exactcsg::io
