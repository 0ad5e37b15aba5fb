// SPDX-License-Identifier: Apache-2.0
#pragma once

// Equal positions found among many vertices: one number for each distinct exact position. [Exact]

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "exactcsg/number/geometry.hpp"
#include "exactcsg/solid/vertex_row.hpp"
#include "exactcsg/support/in_parallel.hpp"

namespace exactcsg {

// An interval of keys that cannot be told apart from others that overlap it.
struct KeyInterval {
  double lower = 0;
  double upper = 0;
  std::uint32_t item = 0;
};

// The maximal runs of intervals that are connected by overlaps, each sorted by lower ends.
// Intervals that are not finite form a run with everything.
class Clusters {
 public:
  Clusters(std::vector<KeyInterval> intervals, unsigned threads);

  // Of the intervals; every cluster lies in one part.
  const Parts& parts() const { return parts_; }
  std::span<const KeyInterval> part(std::size_t number) const {
    return std::span(intervals_)
        .subspan(parts_.begin(number), parts_.end(number) - parts_.begin(number));
  }

  // visit(span of intervals) for each cluster of a part, in order.
  template <class Visit>
  void for_each(std::size_t number, Visit visit) const {
    const std::span<const KeyInterval> intervals = part(number);
    for (std::size_t begin = 0; begin < intervals.size();) {
      double reach = intervals[begin].upper;
      std::size_t end = begin + 1;
      while (end < intervals.size() && intervals[end].lower <= reach) {
        reach = std::max(reach, intervals[end].upper);
        ++end;
      }
      visit(intervals.subspan(begin, end - begin));
      begin = end;
    }
  }

 private:
  Parts parts_of_sorted(unsigned threads) const;

  std::vector<KeyInterval> intervals_;
  Parts parts_;
};

// What is known of a corner of pieces before anything is compared.
enum class CornerOccurrence : unsigned char {
  None = 0,  // it is no corner of a piece
  Alone,     // no other has its position
  Some
};

// Corners of pieces: meeting points, some of them more than once, and input points by id.
struct CornerVertices {
  std::vector<const Vertex*> meeting_points;
  std::vector<CornerOccurrence> meeting_point_occurs;
  std::vector<CornerOccurrence> point_occurs;  // by id, of all points of the geometry
};

struct InternedVertices {
  std::vector<std::uint32_t> number_of_meeting_point;  // of each that occurs
  std::vector<std::uint32_t> number_of_point;          // by id, of those that occur
  VertexRow distinct;  // by number; an input point where one is among the equals
};

// LAW interning.1  two numbers are equal iff the exact positions are.
// COST: O(n log n) doubles; exact only where certified positions overlap. O(1) for those that stand
// alone.
InternedVertices intern(const Geometry& geometry, const CornerVertices& vertices,
                        TierStatistics& statistics, unsigned threads = 1);

}  // namespace exactcsg
