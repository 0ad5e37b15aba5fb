// SPDX-License-Identifier: Apache-2.0
#pragma once

// Filled figures of the plane, and CSG trees of them. [Exact]

#include <optional>
#include <vector>

#include "exactcsg/csg/boolean_operator.hpp"
#include "exactcsg/csg/tree.hpp"
#include "exactcsg/number/exact.hpp"

namespace exactcsg {

struct Point2 {
  Rational x, y;
  friend bool operator==(const Point2&, const Point2&) = default;
};

// A filled figure: closed paths under the even-odd rule (holes, crossings and coincident edges are
// allowed; they mean what even-odd says). Orientation does not matter.
struct PlanarFigure {
  std::vector<std::vector<Point2>> paths;
};

using PlanarTree = csg::Tree<PlanarFigure, csg::BooleanOperator>;

// Counter-clockwise vertices if the closed path is, after its repeated and straight-on vertices are
// dropped, a strictly convex polygon. Dropping them changes nothing: they bound no area.
std::optional<std::vector<Point2>> strictly_convex(const std::vector<Point2>& path);

}  // namespace exactcsg
