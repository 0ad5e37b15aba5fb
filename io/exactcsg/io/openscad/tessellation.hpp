// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// How many pieces OpenSCAD 2021.01 cuts its round shapes into, and those shapes with exactly planar
// facets.
//
// Vertex i of ring j is the exact product of the rounded unit direction (c_i, s_i) and the ring's
// radius, at the ring's height. Neighbouring rings have parallel edges, so every quadrilateral
// between them is planar in exact arithmetic, and stays so under exact affine maps.
//
// LAW tessellation.1  facets are exactly planar, and the shapes exactly convex (checked once for
// each
//                     number of fragments).
// LAW tessellation.2  every vertex of a unit shape differs from the one with exact sines and
// cosines
//                     by at most `unit_rounding_bound` in each coordinate.
// Source: OpenSCAD's src/calc.cc, src/primitives.cc (2021.01).

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "exactcsg/number/point.hpp"
#include "exactcsg/solid/primitive.hpp"

namespace exactcsg::io::openscad {

// No single shape may have more vertices than this.
constexpr std::size_t shape_vertex_limit = 2'000'000;
// Nor the primitives of a model together more than this.
constexpr std::size_t model_vertex_limit = 10'000'000;

// The special variables of a node; NaN for one that was given as inf, nan or undef.
struct Fineness {
  double fn = 0;
  double fa = 12;
  double fs = 2;
};

// OpenSCAD's count of fragments of a circle of this radius. At least 3.
// THROWS Error(TooLarge) beyond shape_vertex_limit.
std::size_t fragments(double radius, const Fineness& fineness);

// OpenSCAD's count of slices of a linear extrusion, where the model does not give it.
// `radius_squared` is that of the outline's farthest vertex; `delta_squared` that of the longest
// way of a vertex from bottom to top, seen from above. THROWS Error(TooLarge)
std::size_t helix_slices(double radius_squared, double height, double twist, const Fineness&);
std::size_t conical_helix_slices(double radius_squared, double height, double twist, double scale,
                                 const Fineness&);
std::size_t diagonal_slices(double delta_squared, double height, const Fineness&);

// The rounded unit directions (cosine, sine) of 360 i / n degrees, i = 0 .. n - 1.
using Direction = std::array<double, 2>;
std::vector<Direction> circle_directions(std::size_t n);

// 2^-48. A direction is off by at most 2^-51 (LAW degree.2) plus 2 pi 2^-53 for the rounding of the
// angle 360 i / n, together less than 2.6 * 2^-51; ring radii and heights of a sphere are such
// numbers too, and a product of two of them is off by at most 5.3 * 2^-51.
Rational unit_rounding_bound();

// A convex polytope whose vertices share one denominator, so that it is mapped with integers alone.
struct IntegerPolyhedron {
  std::vector<std::array<Integer, 3>> vertices;
  Integer denominator{1};
  ConvexFacets facets;
};
// REQUIRES a convex polytope, as for make_convex_polytope_unchecked
IntegerPolyhedron with_common_denominator(const Polyhedron& polyhedron);

// The image; facets are turned round if the map mirrors. REQUIRES determinant(map) != 0
Polyhedron place(const AffineMap& map, const IntegerPolyhedron& polyhedron);
// Images under maps that do not mirror share the facets.
ConvexPolytope place_polytope(const AffineMap& map, const IntegerPolyhedron& polyhedron);

// Shapes of radius 1. Sphere: OpenSCAD's rings. Cylinder: height 0 to 1. Cached by n: two nodes
// with the same n share one shape. Not to be called from several threads on one cache.
class ShapeCache {
 public:
  ShapeCache();
  ~ShapeCache();
  const IntegerPolyhedron& sphere(std::size_t n);
  const IntegerPolyhedron& cylinder(std::size_t n);
  const IntegerPolyhedron& box();  // [0, 1]^3
  // Lower radius 1 and upper radius `ratio` >= 0, not cached.
  IntegerPolyhedron frustum(std::size_t n, const Rational& ratio);

 private:
  struct Tables;
  std::unique_ptr<Tables> tables_;
};

}  // namespace exactcsg::io::openscad
