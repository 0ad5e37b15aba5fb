// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Figures for the tests of planar geometry, and measures that share no code with it.

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "exactcsg/csg/walk.hpp"
#include "exactcsg/io/planar/planar.hpp"

namespace exactcsg::io::test {

using Path = std::vector<Point2>;

inline Path rectangle(const Rational& x0, const Rational& y0, const Rational& x1,
                      const Rational& y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}
inline PlanarTree figure(std::vector<Path> paths) {
  return PlanarTree::primitive({std::move(paths)});
}
inline PlanarTree box(const Rational& x0, const Rational& y0, const Rational& x1,
                      const Rational& y1) {
  return figure({rectangle(x0, y0, x1, y1)});
}

// A polygon of n corners near the circle, as the readers make it: exact products of the radius and
// rounded directions.
inline Path circle(const Rational& cx, const Rational& cy, const Rational& r, int n) {
  Path path;
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * M_PI * i / n;
    path.push_back({cx + r * Rational(std::cos(angle)), cy + r * Rational(std::sin(angle))});
  }
  return path;
}

// The shoelace formula: signed, so holes of a resolved figure count negative.
inline Rational area(const Path& path) {
  Rational twice = 0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Point2& p = path[i];
    const Point2& q = path[(i + 1) % path.size()];
    twice += p.x * q.y - p.y * q.x;
  }
  return twice / 2;
}
inline Rational area(const std::vector<Path>& paths) {
  Rational sum = 0;
  for (const Path& path : paths) sum += area(path);
  return sum;
}
inline Rational area(const PlanarTree& tree) { return area(resolve(tree).paths); }

// By the divergence theorem over fans of the facets.
inline Rational volume(const Polyhedron& polyhedron) {
  Rational six_times = 0;
  for (const Facet& facet : polyhedron.facets) {
    const Point3& a = polyhedron.vertices[facet[0]];
    for (std::size_t i = 1; i + 1 < facet.size(); ++i) {
      const Point3& b = polyhedron.vertices[facet[i]];
      const Point3& c = polyhedron.vertices[facet[i + 1]];
      six_times += a.x * (b.y * c.z - b.z * c.y) - a.y * (b.x * c.z - b.z * c.x) +
                   a.z * (b.x * c.y - b.y * c.x);
    }
  }
  return six_times / 6;
}

// What the checking constructors accept: closed, planar, convex facets, not crossing. Returns the
// sum of the primitives' volumes: the volume if they are disjoint.
inline Rational checked_volume(const Solid& solid, std::size_t* primitives = nullptr) {
  Rational sum = 0;
  std::size_t count = 0;
  csg::for_each_primitive(solid, [&](const Primitive& primitive) {
    ++count;
    if (const auto* mesh = std::get_if<PolyhedralMesh>(&primitive.shape)) {
      sum += volume(to_polyhedron(*make_mesh(to_polyhedron(*mesh->polyhedron)).polyhedron));
    } else {
      const Polyhedron polyhedron =
          to_polyhedron(*std::get<ConvexPolytope>(primitive.shape).polyhedron);
      const auto again = make_convex_polytope(polyhedron);
      // Nothing merged: no two facets were coplanar.
      if (again.polyhedron->facets.size() != polyhedron.facets.size()) sum += 1'000'000;
      sum += volume(to_polyhedron(*again.polyhedron));
    }
  });
  if (primitives != nullptr) *primitives = count;
  return sum;
}

}  // namespace exactcsg::io::test
