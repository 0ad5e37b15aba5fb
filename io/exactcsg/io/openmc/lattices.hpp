// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Lattices: how they are read, which element a point is in, and what an element is. [Exact]
//
// Rectangular: the first row of the file has the highest y, x ascends, layers ascend. Hexagonal
// ones: rows from the highest y, x ascends; with p the pitch and s = sqrt(3)/2 rounded, the element
// (i, a) has its centre at (s p i, p (a + i/2)) for orientation y, at (p (i + a/2), s p a) for x,
// relative to the lattice's. An element is a hexagon of the plane's tiling by them, that of regular
// hexagons but for the rounding of s.

#include <functional>

#include "exactcsg/io/openmc/located_xml.hpp"
#include "exactcsg/io/openmc/model.hpp"

namespace exactcsg::io::openmc {

// The ids that a lattice names, in the place of the indices, which are known later.
struct LatticeText {
  Lattice lattice;
  std::vector<Field> elements;  // in the order of Lattice::elements
  std::optional<Field> outer;
};

// Of a <lattice> or <hex_lattice>. THROWS Error(MissingValue | WrongCount | BadArgument |
// UnknownNode | TooLarge) and those of numbers
LatticeText read_lattice(const Element& element);

struct LatticePlace {
  // On the boundary between two elements, or of one and the outside.
  bool is_on_boundary = false;
  // nullopt: outside. Rectangular: along x, y, z from 0; hexagonal: i, a and the layer from 0.
  std::optional<std::array<std::int64_t, 3>> element;
  std::optional<Index> universe;  // of the element, or outer; nullopt: a gap
  Point local;                    // relative to the element's centre; a lattice without layers
                                  // leaves z alone
};
LatticePlace place_in(const Lattice& lattice, const Point& point);

// The position in Lattice::elements. REQUIRES an element of the lattice.
std::size_t element_index(const Lattice& lattice, const std::array<std::int64_t, 3>& element);
// Of the grid that the lattice is a part of: an element of it or not.
domain::Coordinates<3> centre_of(const Lattice& lattice,
                                 const std::array<std::int64_t, 3>& element);

// An element round its own centre: the points inside `sides` whose coordinates are at most
// half_extent in magnitude; along z any, if the lattice has no layers.
struct ElementShape {
  domain::Coordinates<3> half_extent;
  HalfSpaceRegion sides;  // Full if rectangular
};
ElementShape element_shape(const Lattice& lattice);

// Numbers of elements in a row along each of the three: from first up to, but without, last.
struct ElementRange {
  std::array<std::int64_t, 3> first{};
  std::array<std::int64_t, 3> last{};
};
// Has all elements of the grid that meet the interior of the box, and perhaps others.
// THROWS Error(TooLarge) if they cannot be counted
ElementRange elements_near(const Lattice& lattice, const domain::Box<3>& box);

bool is_element_of(const Lattice& lattice, const std::array<std::int64_t, 3>& element);

// visit(element, universe, centre) for those that may have points inside the box, in which the
// lattice's grid goes on for ever if it has an outer universe; without a box for all elements, and
// not for those of the outer universe. THROWS Error(TooLarge) as elements_near
void for_each_element(
    const Lattice& lattice, const std::optional<domain::Box<3>>& box,
    const std::function<void(const std::array<std::int64_t, 3>& element, Index universe,
                             const domain::Coordinates<3>& centre)>& visit);

}  // namespace exactcsg::io::openmc
