// SPDX-License-Identifier: Apache-2.0
#pragma once

// Equal positions found among many vertices: one number for each distinct exact position. [Exact]

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "exactcsg/number/geometry.hpp"
#include "exactcsg/solid/bucket_sort.hpp"

namespace exactcsg {

// An interval of keys that cannot be told apart from others that overlap it.
struct KeyInterval {
  double lower = 0;
  double upper = 0;
  std::uint32_t item = 0;
};

// Sorts by lower ends and calls visit(span of intervals) for each maximal run that is connected by
// overlaps. Intervals that are not finite form a run with everything.
template <class Visit>
void for_each_cluster(std::vector<KeyInterval>& intervals, Visit visit) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (KeyInterval& interval : intervals) {
    if (!(interval.lower > -infinity && interval.upper < infinity)) {
      interval.lower = -infinity;
      interval.upper = infinity;
    }
  }
  const DoubleBuckets buckets(intervals,
                              [](const KeyInterval& interval) { return interval.lower; });
  sort_in_buckets(
      intervals, buckets.count(),
      [&](const KeyInterval& interval) { return buckets.of(interval.lower); },
      [](const KeyInterval& a, const KeyInterval& b) {
        return a.lower < b.lower || (a.lower == b.lower && a.item < b.item);
      });
  for (std::size_t begin = 0; begin < intervals.size();) {
    double reach = intervals[begin].upper;
    std::size_t end = begin + 1;
    while (end < intervals.size() && intervals[end].lower <= reach) {
      reach = std::max(reach, intervals[end].upper);
      ++end;
    }
    visit(std::span(intervals).subspan(begin, end - begin));
    begin = end;
  }
}

// Corners of pieces: meeting points, some of them more than once, and input points by id.
struct CornerVertices {
  std::vector<const Vertex*> meeting_points;  // null: one that does not occur
  std::vector<bool> has_point;                // by id, of all points of the geometry
};

struct InternedVertices {
  std::vector<std::uint32_t> number_of_meeting_point;  // of each that occurs
  std::vector<std::uint32_t> number_of_point;          // by id, of those that occur
  std::vector<Vertex> distinct;  // by number; an input point where one is among the equals
};

// LAW interning.1  two numbers are equal iff the exact positions are.
// COST: O(n log n) doubles; exact only where certified positions overlap.
InternedVertices intern(const Geometry& geometry, const CornerVertices& vertices,
                        TierStatistics& statistics);

}  // namespace exactcsg
