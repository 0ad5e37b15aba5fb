// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The kinds of surfaces, their coefficients and their half-spaces. [Exact]
//
// plane A B C D; x-, y-, z-plane x0; sphere x0 y0 z0 r; x-, y-, z-cylinder: the two coordinates of
// the axis, then r; x-, y-, z-cone x0 y0 z0 r2, both nappes; quadric A B C D E F G H J K, where D,
// E and F belong to xy, yz and xz; x-, y-, z-torus x0 y0 z0 A B C: the major radius, 0 of an
// ellipsoid, and the semi-axes along the axis and across it.

#include "exactcsg/io/openmc/located_xml.hpp"
#include "exactcsg/io/openmc/model.hpp"

namespace exactcsg::io::openmc {

// THROWS Error with a place: UnknownNode (type, boundary), MissingValue, WrongCount, BadArgument (a
// negative radius), DegenerateSurface (no surface has this equation), and those of numbers.
Surface read_surface(const Element& element);

// The half-space of a surface of this type with these coefficients. nullopt: no surface has such an
// equation, or a radius is negative. REQUIRES a type of the list above with as many coefficients.
std::optional<HalfSpace> half_space_of(std::string_view type,
                                       const std::vector<Rational>& coefficients);

// True if f is below 0 somewhere and above 0 somewhere: then it is round each of its zeros, and
// f = 0 is a surface. COST: O(1) rational operations.
bool takes_both_signs(const domain::Quadric<3>& f);

// Where the surface lies along an axis, roughly, for dividing space: {greater, less} if it is not
// bounded there. [Approximate]
std::array<double, 2> extent_along(const Surface& surface, std::size_t axis);

// {x : normal x <= offset}, of a side of a plane.
struct PlaneSide {
  domain::Coordinates<3> normal;
  Rational offset;
};
std::optional<PlaneSide> plane_side(const Surface& surface, bool is_positive);

// Along an axis, where it is bounded.
struct Extent {
  std::optional<Rational> lower, upper;
};
// Of the inside ("-id") of a sphere, cylinder or torus; unbounded for others.
Extent inside_extent(const Surface& surface, std::size_t axis);

}  // namespace exactcsg::io::openmc
