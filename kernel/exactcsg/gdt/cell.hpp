// SPDX-License-Identifier: Apache-2.0
#pragma once

// Cells of any dimension, and the usual ways to divide them: into orthants (quadtree, octree) and
// by a cut (bintree, k-d tree). [Exact, if the arithmetic of the coordinates is]
//
// A Division says what the cell of a child is, from the cell and the label of its father:
//   division(const C& cell, const N& label, size_t index) -> C
// Any type may be a cell. That it is a box is asked only where points, rays and faces come in: it
// has the corners `lower` and `upper`, as a type derived from Cell has. A Cell has its lower faces,
// not its upper ones, so that every point is in exactly one of the parts of a division:
// LAW cell.1  the parts that Orthants and Cuts make are disjoint, and their union is the cell.
// LAW cell.2  Orthants: bit a of the index says on which side of the centre the part is along axis
//             a. Cuts: part 0 is below the cut, part 1 above.
// LAW cell.3  Cuts commutes with restriction: a part of a smaller cell is that part of the cell,
//             restricted.
// COST: O(dimension).

#include <array>
#include <concepts>
#include <cstddef>
#include <utility>

#include "exactcsg/gdt/tree.hpp"

namespace exactcsg::gdt {

template <class Scalar, std::size_t dimension>
using Coordinates = std::array<Scalar, dimension>;

template <class Scalar, std::size_t dimension>
struct Cell {
  Coordinates<Scalar, dimension> lower;
  Coordinates<Scalar, dimension> upper;
  friend bool operator==(const Cell&, const Cell&) = default;
};

template <class C>
concept BoxCell = std::copyable<C> && requires(const C& cell, std::size_t axis) {
  { cell.lower[axis] < cell.upper[axis] } -> std::convertible_to<bool>;
  { cell.lower.size() } -> std::convertible_to<std::size_t>;
};

template <BoxCell C>
using ScalarOf = std::remove_cvref_t<decltype(std::declval<const C&>().lower[0])>;

template <class Division, class C, class N>
concept Divides = requires(const Division& division, const C& cell, const N& label) {
  { division(cell, label, std::size_t{}) } -> std::convertible_to<C>;
};

template <BoxCell C, class Point>
bool contains(const C& cell, const Point& point) {
  for (std::size_t axis = 0; axis < cell.lower.size(); ++axis) {
    if (point[axis] < cell.lower[axis] || !(point[axis] < cell.upper[axis])) return false;
  }
  return true;
}

template <BoxCell C>
bool is_empty(const C& cell) {
  for (std::size_t axis = 0; axis < cell.lower.size(); ++axis) {
    if (!(cell.lower[axis] < cell.upper[axis])) return true;
  }
  return false;
}

// Into 2^dimension parts that meet at the label, or at the middle of the cell if there is no label
// (rounded as the coordinates' division rounds).
struct Orthants {
  template <class Scalar, std::size_t dimension>
  Cell<Scalar, dimension> operator()(const Cell<Scalar, dimension>& cell, NoLabel,
                                     std::size_t index) const {
    Coordinates<Scalar, dimension> centre;
    for (std::size_t axis = 0; axis < dimension; ++axis) {
      centre[axis] = (cell.lower[axis] + cell.upper[axis]) / 2;
    }
    return (*this)(cell, centre, index);
  }
  template <class Scalar, std::size_t dimension>
  Cell<Scalar, dimension> operator()(const Cell<Scalar, dimension>& cell,
                                     const Coordinates<Scalar, dimension>& centre,
                                     std::size_t index) const {
    Cell<Scalar, dimension> part = cell;
    for (std::size_t axis = 0; axis < dimension; ++axis) {
      const bool above = (index >> axis) % 2 != 0;
      (above ? part.lower : part.upper)[axis] = centre[axis];
    }
    return part;
  }
};

template <class Scalar>
struct Cut {
  std::size_t axis;
  Scalar at;
  friend bool operator==(const Cut&, const Cut&) = default;
};

// Into two parts by the label. A cut outside the cell leaves one of them empty, the other whole.
struct Cuts {
  template <class Scalar, std::size_t dimension>
  Cell<Scalar, dimension> operator()(const Cell<Scalar, dimension>& cell, const Cut<Scalar>& cut,
                                     std::size_t index) const {
    Cell<Scalar, dimension> part = cell;
    Scalar& bound = (index == 0 ? part.upper : part.lower)[cut.axis];
    if (index == 0 ? cut.at < bound : bound < cut.at) bound = cut.at;
    return part;
  }
};

}  // namespace exactcsg::gdt
