// SPDX-License-Identifier: Apache-2.0
#pragma once

// The cells into which planes and cones through the origin cut space. [Exact]
//
// LAW direction_cells.1  no direction lies on any of the cones and planes.
// LAW direction_cells.2  if `complete`, every cell has a direction.
//
// Not complete only where two of the forms have a common factor: a pair of planes written as one
// quadric, and one of the two, or another such pair with it.
//
// Method: directions (x, y, 1), where the forms are curves of degree one and two. Their order along
// y changes only at the roots in x of discriminants, leading coefficients and resultants; one
// rational x between each two of these, and there one rational y between each two curves. COST: for
// k forms O(k^2) polynomials of degree at most four, and O(k^3) directions.
// Source: G. Collins, Quantifier elimination by cylindrical algebraic decomposition (1975), of
// which only the cells of full dimension are needed.

#include <span>
#include <vector>

#include "exactcsg/domain/quadric.hpp"
#include "exactcsg/number/algebraic_number.hpp"

namespace exactcsg::domain {

// One number below all, one between each two that are different, one above all.
std::vector<Rational> rationals_between(std::vector<AlgebraicNumber> numbers);

struct DirectionCells {
  std::vector<Coordinates<3>> directions;
  bool complete = true;
};

// REQUIRES forms that are not 0, homogeneous of degree one or two, no two of them proportional
DirectionCells direction_cells(std::span<const Quadric<3>> forms);

}  // namespace exactcsg::domain
