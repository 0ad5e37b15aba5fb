// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace exactcsg {

template <class Visit>
void for_each_cluster(std::vector<KeyInterval>& intervals, Visit visit) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (KeyInterval& interval : intervals) {
    if (!(interval.lower > -infinity && interval.upper < infinity)) {
      interval.lower = -infinity;
      interval.upper = infinity;
    }
  }
  std::sort(intervals.begin(), intervals.end(), [](const KeyInterval& a, const KeyInterval& b) {
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

}  // namespace exactcsg
