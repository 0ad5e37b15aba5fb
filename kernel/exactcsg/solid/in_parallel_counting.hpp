// SPDX-License-Identifier: Apache-2.0
#pragma once

// Loops on one or several threads whose rounds count predicates.

#include <cstddef>
#include <vector>

#include "exactcsg/number/tier_statistics.hpp"
#include "exactcsg/support/in_parallel.hpp"

namespace exactcsg {

// round(i, tiers) for every i below count; what it counts in `tiers` is added to `statistics`.
template <class Round>
void in_parallel_counting(unsigned threads, std::size_t count, TierStatistics& statistics,
                          const Round& round) {
  std::vector<TierStatistics> counted(count);
  in_parallel(threads, count, [&](std::size_t i) {
    TierStatistics tiers;  // of its own, since neighbours in a vector share lines of the cache
    round(i, tiers);
    counted[i] = tiers;
  });
  for (const TierStatistics& tiers : counted) statistics += tiers;
}

// visit(part, begin, end, tiers) for every part, likewise.
template <class Visit>
void in_parallel_counting(unsigned threads, const Parts& parts, TierStatistics& statistics,
                          const Visit& visit) {
  in_parallel_counting(threads, parts.count(), statistics,
                       [&](std::size_t part, TierStatistics& tiers) {
                         visit(part, parts.begin(part), parts.end(part), tiers);
                       });
}

}  // namespace exactcsg
