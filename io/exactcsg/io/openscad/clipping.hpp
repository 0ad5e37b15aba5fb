// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Planar figures as OpenSCAD 2021.01 holds them, and its operations on them: polygons with double
// coordinates, sent through the Clipper library (release 6.4.2, the one it contains) at a scale of
// 2^16, cut toward zero, and cleaned up with that library's own distance. [Approximate, on purpose:
// the same roundings as OpenSCAD's, for Rounding::OpenScadGrid alone.]

#include <array>
#include <span>
#include <vector>

#include "exactcsg/csg/boolean_operator.hpp"
#include "exactcsg/io/planar/offset.hpp"

namespace exactcsg::io::openscad {

using DoublePoint2 = std::array<double, 2>;

struct DoubleOutline {
  std::vector<DoublePoint2> vertices;
  bool positive = true;  // not a hole
};

// Outlines that do not cross, holes clockwise.
struct DoubleFigure {
  std::vector<DoubleOutline> outlines;
};

// An empty figure is an operand like any other.
// THROWS Error(NumberOutOfRange) for coordinates beyond the library's integers.
DoubleFigure clip(csg::BooleanOperator operation, std::span<const DoubleFigure> operands);

enum class Winding : unsigned char { Keep, MakePositive };

// The even-odd interior of outlines that may cross: what polygon() and mirrored figures become.
// THROWS Error(NumberOutOfRange)
DoubleFigure sanitized(const DoubleFigure& figure, Winding winding);

// What offset() becomes; `arc_tolerance` counts for round corners alone.
// THROWS Error(NumberOutOfRange)
DoubleFigure grown(const DoubleFigure& figure, double distance, OffsetCorner corner,
                   double arc_tolerance);

// What minkowski() becomes. REQUIRES an operand
// THROWS Error(NumberOutOfRange)
DoubleFigure minkowski_sum(std::span<const DoubleFigure> operands);

// What projection() without cut becomes: the facets of each solid, seen from above or below.
// THROWS Error(NumberOutOfRange)
DoubleFigure united_shadows(std::span<const DoubleFigure> facets_of_solids);

}  // namespace exactcsg::io::openscad
