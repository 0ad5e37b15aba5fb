// SPDX-License-Identifier: Apache-2.0
// The convex polytope that half-spaces have in common.
//
// Each plane carries one candidate facet: a square of the plane, larger than any polytope these
// planes can bound, clipped by all other half-spaces. A square's corner that survives shows that
// the set is unbounded.

#include <algorithm>
#include <utility>

#include "exactcsg/solid/polyhedron_check.hpp"
#include "exactcsg/solid/primitive.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg {

namespace {

using Polygon = std::vector<Point3>;

bool less(const Plane& p, const Plane& q) { return compare(p, q) < 0; }

std::vector<Plane> distinct_planes(std::span<const HalfSpace> half_spaces) {
  std::vector<Plane> planes;
  for (const HalfSpace& h : half_spaces) planes.push_back(h.plane);
  std::sort(planes.begin(), planes.end(), less);
  planes.erase(std::unique(planes.begin(), planes.end()), planes.end());
  return planes;
}

// Larger than every coordinate of a vertex, and of the point nearest to the origin of every plane
// and of every line of two planes: those are quotients of integers, the denominator at least 1, the
// numerator at most 36 times the fourth power of the largest coefficient (Cramer's rule).
Integer beyond_all_vertices(const std::vector<Plane>& planes) {
  Integer largest = 1;
  for (const Plane& p : planes) {
    for (const Integer* c : {&p.a, &p.b, &p.c, &p.d}) {
      const Integer magnitude = abs(*c);
      largest = std::max(largest, magnitude);
    }
  }
  return 100 * largest * largest * largest * largest;
}

std::vector<Plane> walls(const Integer& size) {
  return {{1, 0, 0, -size},  {-1, 0, 0, -size}, {0, 1, 0, -size},
          {0, -1, 0, -size}, {0, 0, 1, -size},  {0, 0, -1, -size}};
}

// A part of the plane that holds all of it within |x|, |y|, |z| <= size, counter-clockwise seen
// from outside.
Polygon large_square(const Plane& plane, const Integer& size) {
  const std::array<const Integer*, 3> normal{&plane.a, &plane.b, &plane.c};
  const std::size_t k = sgn(plane.a) != 0 ? 0 : sgn(plane.b) != 0 ? 1 : 2;
  const std::size_t i = (k + 1) % 3;
  const std::size_t j = (k + 2) % 3;
  Polygon corners;
  for (const auto& [si, sj] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
    std::array<Rational, 3> x;
    x[i] = Rational(size * si);
    x[j] = Rational(size * sj);
    x[k] = -(x[i] * *normal[i] + x[j] * *normal[j] + plane.d) / Rational(*normal[k]);
    corners.push_back({x[0], x[1], x[2]});
  }
  if (sgn(*normal[k]) < 0) std::reverse(corners.begin(), corners.end());
  return corners;
}

Rational value_at(const Plane& plane, const Point3& p) {
  return plane.a * p.x + plane.b * p.y + plane.c * p.z + plane.d;
}

Polygon clip(const Polygon& polygon, const Plane& plane) {
  std::vector<Rational> values;
  for (const Point3& p : polygon) values.push_back(value_at(plane, p));
  Polygon inside;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const std::size_t n = (k + 1) % polygon.size();
    if (sgn(values[k]) <= 0) inside.push_back(polygon[k]);
    if (sgn(values[k]) * sgn(values[n]) < 0) {
      const Rational t = values[k] / (values[k] - values[n]);
      inside.push_back(polygon[k] + t * (polygon[n] - polygon[k]));
    }
  }
  return inside;
}

bool has_area(const Polygon& polygon) {
  for (std::size_t k = 2; k < polygon.size(); ++k) {
    if (cross(polygon[1] - polygon[0], polygon[k] - polygon[0]) != Vector3{0, 0, 0}) return true;
  }
  return false;
}

Polyhedron facets_of(const std::vector<Plane>& planes, const Integer& size) {
  Polyhedron polyhedron;
  for (const Plane& plane : planes) {
    Polygon polygon = large_square(plane, size);
    for (const Plane& other : planes) {
      if (other == plane) continue;
      polygon = clip(polygon, other);
      if (polygon.size() < 3) break;
    }
    if (!has_area(polygon)) continue;
    Facet facet;
    for (Point3& p : polygon) {
      facet.push_back(static_cast<std::uint32_t>(polyhedron.vertices.size()));
      polyhedron.vertices.push_back(std::move(p));
    }
    polyhedron.facets.push_back(std::move(facet));
  }
  return polyhedron;
}

// A set with interior has a facet, and a vertex strictly inside of that facet's plane.
bool has_interior(const std::vector<Plane>& planes, const Polyhedron& polyhedron) {
  return std::all_of(planes.begin(), planes.end(), [&](const Plane& plane) {
    return std::any_of(polyhedron.vertices.begin(), polyhedron.vertices.end(),
                       [&](const Point3& p) { return side(plane, p) == Sign::Negative; });
  });
}

bool reaches(const Polyhedron& polyhedron, const Integer& size) {
  return std::any_of(polyhedron.vertices.begin(), polyhedron.vertices.end(), [&](const Point3& p) {
    return abs(p.x) >= size || abs(p.y) >= size || abs(p.z) >= size;
  });
}

}  // namespace

ConvexPolytope make_convex_polytope(std::span<const HalfSpace> half_spaces) {
  std::vector<Plane> planes = distinct_planes(half_spaces);
  const Integer size = beyond_all_vertices(planes);
  const std::vector<Plane> bounds = walls(size);
  planes.insert(planes.end(), bounds.begin(), bounds.end());
  Polyhedron polyhedron = facets_of(planes, size);
  const std::string found =
      "the intersection of " + std::to_string(half_spaces.size()) + " half-spaces";
  if (!has_interior(planes, polyhedron)) {
    throw Error(ErrorId::FlatPolytope, {found, "common interior points"});
  }
  if (reaches(polyhedron, size)) {
    throw Error(ErrorId::UnboundedSolid, {found, "half-spaces that bound each other"});
  }
  return make_convex_polytope(std::move(polyhedron));
}

}  // namespace exactcsg
