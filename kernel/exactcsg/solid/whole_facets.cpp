// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/whole_facets.hpp"

#include <algorithm>
#include <atomic>
#include <limits>
#include <utility>

#include "exactcsg/solid/per_thread.hpp"
#include "exactcsg/solid/polygon.hpp"
#include "exactcsg/support/in_parallel.hpp"

namespace exactcsg {

namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

// What came out of a facet. Parts that are boundary of either sense never add up to a whole.
struct FacetParts {
  std::uint64_t share = 0;  // of all
  std::uint32_t first_buffer = none;
  unsigned char some_outward = 0;  // with the stored normal
  unsigned char some_inward = 0;
  unsigned char touched = 0;  // not in general position somewhere
  unsigned char restored = 0;

  bool is_whole() const {
    return share == facet_share::whole && (some_outward == 0 || some_inward == 0);
  }
};

void set_least(std::uint32_t& least, std::uint32_t value) {
  const std::atomic_ref shared(least);
  std::uint32_t known = shared.load(std::memory_order_relaxed);
  while (value < known && !shared.compare_exchange_weak(known, value, std::memory_order_relaxed)) {
  }
}

// Sums do not depend on the order of the buffers.
void add_parts(const PieceBuffer& buffer, std::uint32_t number, std::vector<FacetParts>& facets) {
  for (const BoundaryPiece& piece : buffer.pieces) {
    FacetParts& facet = facets[piece.facet];
    std::atomic_ref(facet.share).fetch_add(piece.share, std::memory_order_relaxed);
    set_least(facet.first_buffer, number);
    set_mark(piece.plane.sense > 0 ? facet.some_outward : facet.some_inward);
    if (!piece.in_general_position) set_mark(facet.touched);
  }
}

// Of the parts of a whole facet the first one stays, for all of it.
void restore(PieceBuffer& buffer, std::uint32_t number, std::vector<FacetParts>& facets) {
  const auto is_needless = [&](BoundaryPiece& piece) {
    FacetParts& facet = facets[piece.facet];
    if (!facet.is_whole()) return false;
    if (facet.first_buffer != number || facet.restored != 0) return true;
    facet.restored = 1;
    piece.share = facet_share::whole;
    piece.is_slice = false;
    piece.in_general_position = facet.touched == 0;
    return false;
  };
  buffer.pieces.erase(std::remove_if(buffer.pieces.begin(), buffer.pieces.end(), is_needless),
                      buffer.pieces.end());
}

// For one thread.
struct SliceCutter {
  PieceCollector collector;
  Slicer slicer;
  std::vector<Corner> corners;

  // What is left of slices are parts of facets of which other parts are missing.
  const PieceBuffer& cut(const Scene& scene, PieceBuffer&& buffer) {
    collector.resume(std::move(buffer));
    for (std::size_t i = 0; i < collector.buffer().pieces.size(); ++i) {
      const BoundaryPiece& piece = collector.buffer().pieces[i];
      if (!piece.is_slice) continue;
      corners.clear();
      slicer.append(scene.geometry, scene.corners_of(piece.facet), piece.plane.plane,
                    collector.buffer().slice_of(piece), corners);
      collector.cut_slice(i, corners);
    }
    return collector.buffer();
  }
};

}  // namespace

void restore_whole_facets(const Scene& scene, std::vector<PieceBuffer>& buffers, unsigned threads) {
  std::vector<FacetParts> facets;
  resize(threads, facets, scene.facets.size());
  PerThread<SliceCutter> cutters([] { return SliceCutter(); });
  in_parallel(threads, buffers.size(),
              [&](std::size_t b) { add_parts(buffers[b], static_cast<std::uint32_t>(b), facets); });
  in_parallel(threads, buffers.size(), [&](std::size_t b) {
    PieceBuffer& buffer = buffers[b];
    restore(buffer, static_cast<std::uint32_t>(b), facets);
    buffer = std::ranges::any_of(buffer.pieces, &BoundaryPiece::is_slice)
                 ? compacted(cutters.local().cut(scene, std::move(buffer)))
                 : compacted(buffer);
  });
}

}  // namespace exactcsg
