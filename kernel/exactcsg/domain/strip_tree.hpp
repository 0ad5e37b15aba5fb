// SPDX-License-Identifier: Apache-2.0
#pragma once

// Strip trees: a digitised curve as a hierarchy of ever narrower strips round it. [Exact] where it
// says nothing else.
//
// A curve is the polygonal line through finite points in doubles, taken as the exact numbers that
// they are; its segments are counted from 0. A strip is a rectangle, turned along the chord of a
// part of the curve.
//
// LAW strip.1  the strip of a node contains the part of the curve from point `first` to point
//              `last`; a terminal is one segment; the parts of the children follow one another.
// LAW strip.2  no point of the part is further than `deviation` from its chord. [Certified]
// LAW strip.3  length(tree, bits) contains the curve's length and is at most 2^-bits wide.
// LAW strip.4  classify: In, On, Out of the closed curve by the even-odd rule; contains: On or not.
// LAW strip.5  intersection(a, b) has one entry for every pair of segments that meet, in ascending
//              order, with the exact points in which they do.
// LAW strip.6  the line through simplified(tree, tolerance) and the curve have a Hausdorff distance
//              of at most the tolerance.
// COST: make O(n log n), depth log2(n); length O(n); a point O(log n) exact only near the curve, if
// the curve is not wild there; intersection O(log n) for each meeting, likewise.
//
// Source: Ballard, "Strip trees: a hierarchical representation for curves", CACM 24(5), 1981; Davy
// and Dew, sections 3.7 and 6.1. Ours: the middle point divides, not the farthest one, which bounds
// the depth; errors are certified. An instance of gdt::create_multi_resolution, traverse and zip.

#include <cstdint>
#include <span>
#include <vector>

#include "exactcsg/domain/point.hpp"
#include "exactcsg/domain/point_class.hpp"
#include "exactcsg/gdt/multi_resolution.hpp"
#include "exactcsg/number/enclosure.hpp"

namespace exactcsg::domain {

struct CurvePoint {
  double x = 0;
  double y = 0;
  friend bool operator==(const CurvePoint&, const CurvePoint&) = default;
};

struct Strip {
  std::uint32_t first = 0;  // points of the curve
  std::uint32_t last = 0;
  CurvePoint begin;  // the chord
  CurvePoint end;
  // The bounding box.
  CurvePoint lower;
  CurvePoint upper;
  // The rectangle {p : low <= direction . (p - begin) <= high, the same across}.
  CurvePoint direction;
  double along_low = 0;
  double along_high = 0;
  double across_low = 0;
  double across_high = 0;
  double deviation = 0;

  friend bool operator==(const Strip&, const Strip&) = default;
};

using StripTree = gdt::MultiResolutionTree<Strip>;

// REQUIRES coordinates below 1e100. THROWS Error(BadArgument) if there are fewer than two points,
// one is not finite, or two in succession are equal; Error(TooLarge) beyond 2^30 points.
StripTree make_strip_tree(std::span<const CurvePoint> points);

// Of the whole curve.
const Strip& root_strip(const StripTree& tree);
inline bool is_closed(const StripTree& tree) {
  return root_strip(tree).begin == root_strip(tree).end;
}

Enclosure length(const StripTree& tree, int bits);

// THROWS Error(BadArgument) if the curve is not closed.
PointClass classify(const StripTree& tree, const Point<2>& point);
bool contains(const StripTree& tree, const Point<2>& point);

struct CurveMeeting {
  std::uint32_t first = 0;  // segments
  std::uint32_t second = 0;
  Point<2> from;
  Point<2> to;  // equal to `from` unless the segments overlap
};
std::vector<CurveMeeting> intersection(const StripTree& first, const StripTree& second);

// The points, by their numbers, of the coarsest line that the tree has within the tolerance.
std::vector<std::uint32_t> simplified(const StripTree& tree, double tolerance);

}  // namespace exactcsg::domain
