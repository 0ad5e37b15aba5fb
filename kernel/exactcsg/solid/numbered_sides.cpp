// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/numbered_sides.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "exactcsg/number/bucket_sort.hpp"
#include "exactcsg/solid/faces_ahead.hpp"

namespace exactcsg {

namespace {

// The sorted sides of each plane, by the boundary's own numbers of planes.
class SidesByPlane {
 public:
  SidesByPlane(const Boundary& boundary, std::span<const std::uint32_t> rename,
               SideDirection direction)
      : end_(boundary.plane_count + std::size_t{1}) {
    for (std::size_t i = 0; i < boundary.faces.size(); ++i) {
      ask_for_faces_after(boundary.faces, i, [](std::uint32_t) {});
      const BoundaryFace& face = boundary.faces[i];
      for (const auto& loop : face.loops) end_[face.plane + std::size_t{1}] += loop.size();
    }
    std::partial_sum(end_.begin(), end_.end(), end_.begin());
    sides_.resize(end_.back());
    for (std::size_t i = 0; i < boundary.faces.size(); ++i) {
      ask_for_faces_after(boundary.faces, i,
                          [&](std::uint32_t vertex) { __builtin_prefetch(&rename[vertex]); });
      const BoundaryFace& face = boundary.faces[i];
      for (const auto& loop : face.loops) add_loop(face.plane, loop, rename, direction);
    }
    for (std::uint32_t plane = 0; plane < boundary.plane_count; ++plane) {
      Side* const begin = sides_.data() + begin_of(plane);
      Side* const end = sides_.data() + end_[plane];
      if (!std::is_sorted(begin, end)) std::sort(begin, end);
    }
  }

  SidesOfPlane of(std::uint32_t plane) const {
    return SidesOfPlane(sides_).subspan(begin_of(plane), end_[plane] - begin_of(plane));
  }
  std::vector<Side> release() && { return std::move(sides_); }

 private:
  std::size_t begin_of(std::uint32_t plane) const { return plane == 0 ? 0 : end_[plane - 1]; }

  void add_loop(std::uint32_t plane, const std::vector<std::uint32_t>& loop,
                std::span<const std::uint32_t> rename, SideDirection direction) {
    if (loop.empty()) return;
    // While sides are added, this is where the next one of the plane belongs.
    std::size_t& place = end_[plane];
    std::uint32_t from = rename[loop.back()];
    for (const std::uint32_t vertex : loop) {
      const std::uint32_t to = rename[vertex];
      sides_[place++] = direction == SideDirection::Kept ? Side(from, to) : Side(to, from);
      from = to;
    }
  }

  std::vector<std::size_t> end_;
  std::vector<Side> sides_;
};

}  // namespace

bool operator==(const NumberedSides& a, const NumberedSides& b) {
  return std::ranges::equal(a.planes_, b.planes_, [](SidesOfPlane p, SidesOfPlane q) {
    return std::ranges::equal(p, q);
  });
}

NumberedSides numbered_sides(const Boundary& boundary, std::span<const std::uint32_t> rename,
                             SideDirection direction) {
  SidesByPlane sides(boundary, rename, direction);
  std::vector<SidesOfPlane> planes;
  planes.reserve(boundary.plane_count);
  for (std::uint32_t plane = 0; plane < boundary.plane_count; ++plane) {
    if (const SidesOfPlane of_plane = sides.of(plane); !of_plane.empty()) {
      planes.push_back(of_plane);
    }
  }
  const auto earlier = [](SidesOfPlane a, SidesOfPlane b) {
    if (a.front() != b.front()) return a.front() < b.front();
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  };
  // As they are where the vertices keep their numbers, nearly always.
  if (!std::is_sorted(planes.begin(), planes.end(), earlier)) {
    sort_in_buckets(
        planes, rename.size(), [](SidesOfPlane plane) { return std::size_t{plane.front().from()}; },
        earlier);
  }
  return {std::move(sides).release(), std::move(planes)};
}

}  // namespace exactcsg
