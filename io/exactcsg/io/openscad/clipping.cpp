// SPDX-License-Identifier: GPL-3.0-or-later
// The order of calls is that of OpenSCAD 2021.01 (src/clipper-utils.cc) and is part of the result.
#include "exactcsg/io/openscad/clipping.hpp"

#include <algorithm>
#include <cmath>
#include <polyclipping/clipper.hpp>

#include "exactcsg/support/error.hpp"

namespace exactcsg::io::openscad {

namespace {

using csg::BooleanOperator;

constexpr double scale = 65536.0;
constexpr double largest = 4.6e18;  // the library's own limit, 2^62

ClipperLib::cInt cut(double value) {
  const double scaled = value * scale;
  if (!(std::fabs(scaled) < largest)) {
    throw Error(ErrorId::NumberOutOfRange, {"a coordinate beyond OpenSCAD's clipping grid", ""});
  }
  return static_cast<ClipperLib::cInt>(scaled);
}

ClipperLib::Paths paths_of(const DoubleFigure& figure, Winding winding) {
  ClipperLib::Paths paths;
  for (const DoubleOutline& outline : figure.outlines) {
    ClipperLib::Path& path = paths.emplace_back();
    for (const auto& [x, y] : outline.vertices) path.emplace_back(cut(x), cut(y));
    if (winding == Winding::MakePositive && !ClipperLib::Orientation(path)) {
      std::reverse(path.begin(), path.end());
    }
  }
  return paths;
}

DoubleFigure figure_of(const ClipperLib::PolyTree& tree) {
  DoubleFigure figure;
  for (const ClipperLib::PolyNode* node = tree.GetFirst(); node != nullptr;
       node = node->GetNext()) {
    ClipperLib::Path cleaned;
    ClipperLib::CleanPolygon(node->Contour, cleaned);
    if (cleaned.size() < 3) continue;
    DoubleOutline& outline = figure.outlines.emplace_back();
    outline.positive = ClipperLib::Orientation(node->Contour);
    for (const ClipperLib::IntPoint& p : cleaned) {
      outline.vertices.push_back(
          {static_cast<double>(p.X) / scale, static_cast<double>(p.Y) / scale});
    }
  }
  return figure;
}

ClipperLib::ClipType clip_type(BooleanOperator operation) {
  switch (operation) {
    case BooleanOperator::Union:
      return ClipperLib::ctUnion;
    case BooleanOperator::Intersection:
      return ClipperLib::ctIntersection;
    case BooleanOperator::Difference:
      return ClipperLib::ctDifference;
    case BooleanOperator::SymmetricDifference:
      return ClipperLib::ctXor;
  }
  throw Error(ErrorId::InternalError, {"a planar operation of no kind", ""});
}

// Two by two: the library's clip operands would be united.
DoubleFigure intersect(std::span<const DoubleFigure> operands) {
  ClipperLib::Clipper clipper;
  ClipperLib::PolyTree result;
  ClipperLib::Paths source = paths_of(operands[0], Winding::Keep);
  for (std::size_t i = 1; i < operands.size(); ++i) {
    clipper.AddPaths(source, ClipperLib::ptSubject, true);
    clipper.AddPaths(paths_of(operands[i], Winding::Keep), ClipperLib::ptClip, true);
    clipper.Execute(ClipperLib::ctIntersection, result, ClipperLib::pftNonZero,
                    ClipperLib::pftNonZero);
    if (i + 1 == operands.size()) break;
    ClipperLib::PolyTreeToPaths(result, source);
    clipper.Clear();
  }
  return figure_of(result);
}

ClipperLib::JoinType join_type(OffsetCorner corner) {
  switch (corner) {
    case OffsetCorner::Round:
      return ClipperLib::jtRound;
    case OffsetCorner::Sharp:
      return ClipperLib::jtMiter;
    case OffsetCorner::Chamfer:
      return ClipperLib::jtSquare;
  }
  throw Error(ErrorId::InternalError, {"a corner of no kind", ""});
}

ClipperLib::Path moved(ClipperLib::Path path, const ClipperLib::IntPoint& by) {
  for (ClipperLib::IntPoint& p : path) {
    p.X += by.X;
    p.Y += by.Y;
  }
  return path;
}

// The sums of the outlines' edges, two by two.
void add_sums_of_edges(const ClipperLib::Path& a, const ClipperLib::Path& b,
                       ClipperLib::Paths& terms) {
  for (std::size_t i = 0; i < b.size(); ++i) {
    const ClipperLib::Path here = moved(a, b[i]);
    const ClipperLib::Path there = moved(a, b[(i + 1) % b.size()]);
    for (std::size_t j = 0; j < a.size(); ++j) {
      const std::size_t k = (j + 1) % a.size();
      ClipperLib::Path& quad = terms.emplace_back();
      quad = {here[j], there[j], there[k], here[k]};
      if (!ClipperLib::Orientation(quad)) ClipperLib::ReversePath(quad);
    }
  }
}

// The figure at one point of each outline of the other that is no hole.
void add_moved_to_outlines(const ClipperLib::Paths& figure, const ClipperLib::Paths& other,
                           ClipperLib::Paths& terms) {
  for (const ClipperLib::Path& outline : other) {
    if (outline.empty() || !ClipperLib::Orientation(outline)) continue;
    for (const ClipperLib::Path& path : figure) terms.push_back(moved(path, outline.front()));
  }
}

}  // namespace

DoubleFigure clip(BooleanOperator operation, std::span<const DoubleFigure> operands) {
  if (operation == BooleanOperator::Intersection && operands.size() >= 2) {
    return intersect(operands);
  }
  ClipperLib::Clipper clipper;
  ClipperLib::PolyType type = ClipperLib::ptSubject;
  for (const DoubleFigure& operand : operands) {
    clipper.AddPaths(paths_of(operand, Winding::Keep), type, true);
    type = ClipperLib::ptClip;
  }
  ClipperLib::PolyTree result;
  clipper.Execute(clip_type(operation), result, ClipperLib::pftNonZero, ClipperLib::pftNonZero);
  return figure_of(result);
}

DoubleFigure sanitized(const DoubleFigure& figure, Winding winding) {
  ClipperLib::Clipper clipper;
  clipper.AddPaths(paths_of(figure, winding), ClipperLib::ptSubject, true);
  ClipperLib::PolyTree result;
  clipper.Execute(ClipperLib::ctUnion, result, ClipperLib::pftEvenOdd);
  return figure_of(result);
}

DoubleFigure grown(const DoubleFigure& figure, double distance, OffsetCorner corner,
                   double arc_tolerance) {
  constexpr double miter_limit = 1e6;
  cut(distance);  // is within the library's range
  ClipperLib::ClipperOffset offset(corner == OffsetCorner::Sharp ? miter_limit : 2.0,
                                   corner == OffsetCorner::Round ? arc_tolerance * scale : 1.0);
  offset.AddPaths(paths_of(figure, Winding::Keep), join_type(corner), ClipperLib::etClosedPolygon);
  ClipperLib::PolyTree result;
  offset.Execute(result, distance * scale);
  return figure_of(result);
}

DoubleFigure minkowski_sum(std::span<const DoubleFigure> operands) {
  if (operands.size() == 1) return operands.front();
  ClipperLib::PolyTree result;
  ClipperLib::Paths sum = paths_of(operands.front(), Winding::Keep);
  for (std::size_t i = 1; i < operands.size(); ++i) {
    const ClipperLib::Paths operand = paths_of(operands[i], Winding::Keep);
    ClipperLib::Paths terms;
    for (const ClipperLib::Path& b : operand) {
      for (const ClipperLib::Path& a : sum) add_sums_of_edges(a, b, terms);
    }
    add_moved_to_outlines(sum, operand, terms);
    add_moved_to_outlines(operand, sum, terms);
    ClipperLib::Clipper clipper;
    clipper.AddPaths(terms, ClipperLib::ptSubject, true);
    clipper.Execute(ClipperLib::ctUnion, result, ClipperLib::pftNonZero, ClipperLib::pftNonZero);
    ClipperLib::PolyTreeToPaths(result, sum);
  }
  return figure_of(result);
}

DoubleFigure united_shadows(std::span<const DoubleFigure> facets_of_solids) {
  ClipperLib::Clipper all;
  for (const DoubleFigure& facets : facets_of_solids) {
    ClipperLib::Clipper clipper;
    clipper.AddPaths(paths_of(facets, Winding::MakePositive), ClipperLib::ptSubject, true);
    ClipperLib::Paths shadow;
    clipper.Execute(ClipperLib::ctUnion, shadow, ClipperLib::pftNonZero);
    all.AddPaths(shadow, ClipperLib::ptSubject, true);
  }
  all.StrictlySimple(true);
  ClipperLib::PolyTree result;
  all.Execute(ClipperLib::ctUnion, result, ClipperLib::pftNonZero, ClipperLib::pftNonZero);
  return figure_of(result);
}

}  // namespace exactcsg::io::openscad
