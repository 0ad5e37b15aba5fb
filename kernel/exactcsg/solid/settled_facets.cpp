// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/settled_facets.hpp"

#include <algorithm>
#include <atomic>
#include <span>

#include "exactcsg/support/in_parallel.hpp"

namespace exactcsg {

namespace {

// No two sides in succession lie on one line. Those of a triangle do not; those of a facet of a
// convex polytope do only if one facet lies across both.
bool turns_at_every_corner(const Scene& scene, const SceneFacet& facet) {
  if (facet.is_half_space) return false;
  const auto corners = std::span(scene.corners).subspan(facet.first_corner, facet.corner_count);
  if (corners.size() == 3) return true;
  if (!scene.primitives[facet.primitive].convex) return false;
  const auto same_side_plane = [](const PointCorner& a, const PointCorner& b) {
    return a.side_plane == b.side_plane;
  };
  return std::adjacent_find(corners.begin(), corners.end(), same_side_plane) == corners.end() &&
         corners.front().side_plane != corners.back().side_plane;
}

}  // namespace

SettledFacets::SettledFacets(const Scene& scene, const std::vector<Emitted>& emitted,
                             unsigned threads) {
  std::vector<std::uint32_t> facets_in_plane;
  resize(threads, facets_in_plane, scene.geometry.plane_count());
  in_parallel_parts(threads, scene.facets.size(), [&](std::size_t f) {
    std::atomic_ref(facets_in_plane[scene.facets[f].plane.plane.table_index()])
        .fetch_add(1, std::memory_order_relaxed);
  });
  resize(threads, planes_, scene.geometry.plane_count());
  in_parallel_parts(threads, scene.facets.size(), [&](std::size_t f) {
    const SceneFacet& facet = scene.facets[f];
    const std::uint32_t plane = facet.plane.plane.table_index();
    if (emitted[f] != Emitted::NotWhole && facets_in_plane[plane] == 1 &&
        turns_at_every_corner(scene, facet)) {
      planes_[plane] = emitted[f];
    }
  });
}

SettledFacets settled_facets(const Scene& scene, const std::vector<PieceBuffer>& buffers,
                             unsigned threads) {
  using Emitted = SettledFacets::Emitted;
  std::vector<Emitted> emitted;
  resize(threads, emitted, scene.facets.size());
  in_parallel(threads, buffers.size(), [&](std::size_t b) {
    for (const BoundaryPiece& piece : buffers[b].pieces) {
      if (piece.share != facet_share::whole) continue;
      emitted[piece.facet] =
          piece.in_general_position ? Emitted::InGeneralPosition : Emitted::Whole;
    }
  });
  return SettledFacets(scene, emitted, threads);
}

}  // namespace exactcsg
