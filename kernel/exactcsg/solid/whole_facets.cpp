// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/whole_facets.hpp"

#include <algorithm>
#include <array>

#include "exactcsg/solid/in_parallel.hpp"

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

void restore_whole_facets(const Scene& scene, std::vector<PieceBuffer>& buffers, unsigned threads) {
  std::vector<Shares> shares(scene.facets.size());
  std::vector<bool> touched(scene.facets.size(), false);  // not in general position somewhere
  for (const PieceBuffer& buffer : buffers) {
    for (const BoundaryPiece& piece : buffer.pieces) {
      share_of(shares, piece) += piece.share;
      if (!piece.in_general_position) touched[piece.facet] = true;
    }
  }
  std::vector<bool> done(scene.facets.size(), false);
  for (PieceBuffer& buffer : buffers) {
    const auto restore = [&](BoundaryPiece& piece) {
      if (!is_whole(shares, piece)) return false;
      if (done[piece.facet]) return true;
      done[piece.facet] = true;
      piece.share = facet_share::whole;
      piece.in_general_position = !touched[piece.facet];
      return false;
    };
    buffer.pieces.erase(std::remove_if(buffer.pieces.begin(), buffer.pieces.end(), restore),
                        buffer.pieces.end());
  }
  in_parallel_parts(threads, buffers.size(),
                    [&](std::size_t b) { buffers[b] = compacted(buffers[b]); });
}

}  // namespace exactcsg
