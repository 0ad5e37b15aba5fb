// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// What the leaves and extrusions of a .csg file ask for, read and checked, free of any rounding:
// both rounding modes of the reader start from these.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "exactcsg/io/openscad/arguments.hpp"
#include "exactcsg/io/openscad/polyhedron.hpp"
#include "exactcsg/io/openscad/tessellation.hpp"
#include "exactcsg/io/openscad/text_outline.hpp"
#include "exactcsg/io/planar/offset.hpp"
#include "exactcsg/io/planar/planar.hpp"
#include "exactcsg/number/point.hpp"

namespace exactcsg::io::openscad {

// Sizes of zero are valid and mean the empty set, as in OpenSCAD; negative ones are refused.
struct BoxShape {
  std::array<Rational, 3> size;
  bool center = false;
};
struct SphereShape {
  Rational radius;
  Fineness fineness;
};
struct CylinderShape {
  Rational height, lower_radius, upper_radius;
  bool center = false;
  Fineness fineness;
};
struct SquareShape {
  std::array<Rational, 2> size;
  bool center = false;
};
struct CircleShape {
  Rational radius;
  Fineness fineness;
};
struct LinearExtrudeShape {
  Rational height;
  bool center = false;
  Rational twist;  // degrees
  std::array<Rational, 2> scale;
  std::optional<std::size_t> slices;
  Fineness fineness;
};
struct RotateExtrudeShape {
  Rational angle;  // degrees, in (-360, 360]
  std::optional<Rational> start;
  Fineness fineness;
};
struct OffsetShape {
  Rational distance;
  OffsetCorner corner = OffsetCorner::Round;
  Fineness fineness;
};
// A size of 0 keeps the extent, or with `automatic` takes the factor of the largest size.
struct ResizeShape {
  std::array<Rational, 3> size;
  std::array<bool, 3> automatic{};
};
struct FileShape {
  std::string file;
  SourcePosition position;  // of the name
};
struct SurfaceShape {
  FileShape file;
  bool center = false;
};

// All of them THROW Error(BadArgument | NumberOutOfRange | TooLarge | UnsupportedNode |
// UnknownVertex) with the position of the argument.
BoxShape read_cube(const SyntaxTree&, std::uint32_t node, Warnings&);
SphereShape read_sphere(const SyntaxTree&, std::uint32_t node, Warnings&);
CylinderShape read_cylinder(const SyntaxTree&, std::uint32_t node, Warnings&);
FacedPoints read_polyhedron(const SyntaxTree&, std::uint32_t node, Warnings&);
SquareShape read_square(const SyntaxTree&, std::uint32_t node, Warnings&);
CircleShape read_circle(const SyntaxTree&, std::uint32_t node, Warnings&);
PlanarFigure read_polygon(const SyntaxTree&, std::uint32_t node, Warnings&);
TextShape read_text(const SyntaxTree&, std::uint32_t node, Warnings&);
LinearExtrudeShape read_linear_extrude(const SyntaxTree&, std::uint32_t node, Warnings&);
RotateExtrudeShape read_rotate_extrude(const SyntaxTree&, std::uint32_t node, Warnings&);
OffsetShape read_offset(const SyntaxTree&, std::uint32_t node, Warnings&);
bool read_projection_cut(const SyntaxTree&, std::uint32_t node, Warnings&);
ResizeShape read_resize(const SyntaxTree&, std::uint32_t node, Warnings&);
FileShape read_import(const SyntaxTree&, std::uint32_t node, Warnings&);
SurfaceShape read_surface(const SyntaxTree&, std::uint32_t node, Warnings&);

// What OpenSCAD lets an arc of the offset be away from its circle. THROWS Error(TooLarge)
double arc_tolerance(const OffsetShape& shape);

// The factors by which a body of these extents is resized. REQUIRES positive extents.
template <std::size_t N>
std::array<Rational, N> resize_factors(const ResizeShape& shape,
                                       const std::array<Rational, N>& extents) {
  std::size_t largest = 0;
  std::array<Rational, N> factors;
  for (std::size_t i = 0; i < N; ++i) {
    factors[i] = shape.size[i] > 0 ? Rational(shape.size[i] / extents[i]) : Rational(1);
    if (shape.size[i] > shape.size[largest]) largest = i;
  }
  for (std::size_t i = 0; i < N; ++i) {
    if (shape.size[i] == 0 && shape.automatic[i]) factors[i] = factors[largest];
  }
  return factors;
}

// The matrix with its last row divided out. nullopt: the last entry of that row is zero.
std::optional<AffineMap> read_multmatrix(const SyntaxTree&, std::uint32_t node, Warnings&);

}  // namespace exactcsg::io::openscad
