// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/polygon.hpp"

namespace exactcsg {

PlaneSplit split_signs(const Geometry& geometry, std::span<const Corner> polygon, PlaneRef plane,
                       std::vector<Sign>& signs, TierStatistics& statistics) {
  signs.resize(polygon.size());
  bool negative = false;
  bool positive = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    signs[i] = geometry.side(polygon[i].vertex, plane, statistics);
    negative |= signs[i] == Sign::Negative;
    positive |= signs[i] == Sign::Positive;
  }
  if (negative && positive) return PlaneSplit::Both;
  if (negative) return PlaneSplit::AllNegative;
  return positive ? PlaneSplit::AllPositive : PlaneSplit::InPlane;
}

void append_part(const Geometry& geometry, std::span<const Corner> polygon, PlaneRef supporting,
                 PlaneRef plane, std::span<const Sign> signs, Sign kept,
                 std::vector<Corner>& result) {
  const std::size_t count = polygon.size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t next = i + 1 == count ? 0 : i + 1;
    const Sign here = signs[i];
    const Sign there = signs[next];
    if (here == kept || here == Sign::Zero) {
      // A corner in the cutting plane whose next side leaves the kept part starts the cut side.
      const bool leaves = here == Sign::Zero && there != kept;
      result.push_back({polygon[i].vertex, leaves ? plane : polygon[i].side_plane});
    }
    if (here != Sign::Zero && there == -here) {
      const Vertex crossing = geometry.meet(supporting, polygon[i].side_plane, plane);
      result.push_back({crossing, there == kept ? polygon[i].side_plane : plane});
    }
  }
}

}  // namespace exactcsg
