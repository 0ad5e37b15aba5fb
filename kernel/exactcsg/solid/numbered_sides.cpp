// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/numbered_sides.hpp"

#include <algorithm>
#include <functional>

#include "exactcsg/solid/bucket_sort.hpp"

namespace exactcsg {

namespace {

// By the boundary's own numbers of planes.
std::vector<NumberedSide> sides_by_plane(const Boundary& boundary,
                                         std::span<const std::uint32_t> rename,
                                         SideDirection direction) {
  std::vector<NumberedSide> sides;
  for (const BoundaryFace& face : boundary.faces) {
    for (const std::vector<std::uint32_t>& loop : face.loops) {
      for (std::size_t k = 0; k < loop.size(); ++k) {
        std::uint32_t from = rename[loop[k]];
        std::uint32_t to = rename[loop[k + 1 == loop.size() ? 0 : k + 1]];
        if (direction == SideDirection::Reversed) std::swap(from, to);
        sides.push_back({face.plane, from, to});
      }
    }
  }
  sort_in_buckets(
      sides, boundary.plane_count, [](const NumberedSide& side) { return side[0]; }, std::less<>());
  return sides;
}

}  // namespace

std::vector<NumberedSide> numbered_sides(const Boundary& boundary,
                                         std::span<const std::uint32_t> rename,
                                         SideDirection direction) {
  const std::vector<NumberedSide> sides = sides_by_plane(boundary, rename, direction);
  using SidesOfPlane = std::span<const NumberedSide>;
  std::vector<SidesOfPlane> planes;
  for (std::size_t begin = 0; begin < sides.size();) {
    std::size_t end = begin + 1;
    while (end < sides.size() && sides[end][0] == sides[begin][0]) ++end;
    planes.push_back(std::span(sides).subspan(begin, end - begin));
    begin = end;
  }
  const auto earlier_side = [](const NumberedSide& a, const NumberedSide& b) {
    return a[1] != b[1] ? a[1] < b[1] : a[2] < b[2];
  };
  sort_in_buckets(
      planes, rename.size(), [](SidesOfPlane plane) { return plane.front()[1]; },
      [&](SidesOfPlane a, SidesOfPlane b) {
        return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), earlier_side);
      });
  std::vector<NumberedSide> result;
  result.reserve(sides.size());
  for (std::uint32_t p = 0; p < planes.size(); ++p) {
    for (const NumberedSide& side : planes[p]) result.push_back({p, side[1], side[2]});
  }
  return result;
}

}  // namespace exactcsg
