// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/whole_facets.hpp"

#include <algorithm>
#include <array>

namespace exactcsg {

namespace {

// The shares of a facet that became boundary with the stored normal outward, and with the other.
using Shares = std::array<std::uint64_t, 2>;

std::uint64_t& share_of(std::vector<Shares>& shares, const BoundaryPiece& piece) {
  return shares[piece.facet][piece.plane.sense > 0 ? 0 : 1];
}

bool is_whole(std::vector<Shares>& shares, const BoundaryPiece& piece) {
  return share_of(shares, piece) == facet_share::whole;
}

}  // namespace

void restore_whole_facets(const Scene& scene, std::vector<PieceBuffer>& buffers) {
  std::vector<Shares> shares(scene.facets.size());
  for (const PieceBuffer& buffer : buffers) {
    for (const BoundaryPiece& piece : buffer.pieces) share_of(shares, piece) += piece.share;
  }
  std::vector<bool> done(scene.facets.size(), false);
  for (PieceBuffer& buffer : buffers) {
    if (std::none_of(buffer.pieces.begin(), buffer.pieces.end(),
                     [&](const BoundaryPiece& piece) { return is_whole(shares, piece); })) {
      continue;
    }
    PieceBuffer restored;
    for (const BoundaryPiece& piece : buffer.pieces) {
      std::span<const Corner> corners =
          std::span(buffer.corners).subspan(piece.first_corner, piece.corner_count);
      std::uint64_t share = piece.share;
      if (is_whole(shares, piece)) {
        if (done[piece.facet]) continue;
        done[piece.facet] = true;
        const SceneFacet& facet = scene.facets[piece.facet];
        corners = std::span(scene.corners).subspan(facet.first_corner, facet.corner_count);
        share = facet_share::whole;
      }
      restored.add(piece.plane, piece.corner_sense, piece.facet, share, corners);
      restored.pieces.back().isolated = piece.isolated;
    }
    buffer = std::move(restored);
  }
}

}  // namespace exactcsg
