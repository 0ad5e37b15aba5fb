// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// What the leaves and extrusions of a .csg file ask for, read and checked, free of any rounding:
// both rounding modes of the reader start from these.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "exactcsg/io/openscad/arguments.hpp"
#include "exactcsg/io/openscad/polyhedron.hpp"
#include "exactcsg/io/openscad/tessellation.hpp"
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

// All of them THROW Error(BadArgument | NumberOutOfRange | TooLarge | UnsupportedNode |
// UnknownVertex) with the position of the argument.
BoxShape read_cube(const SyntaxTree&, std::uint32_t node, Warnings&);
SphereShape read_sphere(const SyntaxTree&, std::uint32_t node, Warnings&);
CylinderShape read_cylinder(const SyntaxTree&, std::uint32_t node, Warnings&);
FacedPoints read_polyhedron(const SyntaxTree&, std::uint32_t node, Warnings&);
SquareShape read_square(const SyntaxTree&, std::uint32_t node, Warnings&);
CircleShape read_circle(const SyntaxTree&, std::uint32_t node, Warnings&);
PlanarFigure read_polygon(const SyntaxTree&, std::uint32_t node, Warnings&);
LinearExtrudeShape read_linear_extrude(const SyntaxTree&, std::uint32_t node, Warnings&);
RotateExtrudeShape read_rotate_extrude(const SyntaxTree&, std::uint32_t node, Warnings&);

// The matrix with its last row divided out. nullopt: the last entry of that row is zero.
std::optional<AffineMap> read_multmatrix(const SyntaxTree&, std::uint32_t node, Warnings&);

}  // namespace exactcsg::io::openscad
