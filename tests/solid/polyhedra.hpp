// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Polyhedra made of others, as lists of facets: nothing is checked or evaluated.

#include <algorithm>
#include <cstdint>

#include "exactcsg/solid/primitive.hpp"

namespace exactcsg::test {

inline Polyhedron box_polyhedron(int x0, int y0, int z0, int x1, int y1, int z1) {
  return to_polyhedron(*make_box({x0, y0, z0}, {x1, y1, z1}).polyhedron);
}

// A facet of n corners as n - 2 triangles, as STL files have it.
inline Polyhedron triangulated(const Polyhedron& p) {
  Polyhedron result{p.vertices, {}};
  for (const Facet& f : p.facets) {
    for (std::size_t k = 2; k < f.size(); ++k) result.facets.push_back({f[0], f[k - 1], f[k]});
  }
  return result;
}

inline AffineMap translation(const Rational& x, const Rational& y, const Rational& z) {
  AffineMap map = AffineMap::identity();
  map.m[0][3] = x;
  map.m[1][3] = y;
  map.m[2][3] = z;
  return map;
}

// Both polyhedra side by side, not merged.
inline Polyhedron together(Polyhedron a, const Polyhedron& b) {
  const auto shift = static_cast<std::uint32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (Facet f : b.facets) {
    for (auto& v : f) v += shift;
    a.facets.push_back(f);
  }
  return a;
}

// Inside out.
inline Polyhedron reversed(Polyhedron p) {
  for (Facet& f : p.facets) std::reverse(f.begin(), f.end());
  return p;
}

}  // namespace exactcsg::test
