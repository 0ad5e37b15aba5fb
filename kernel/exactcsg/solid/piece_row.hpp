// SPDX-License-Identifier: Apache-2.0
#pragma once

// The pieces of many buffers in one row, numbered. Internal to the evaluator. [Exact]

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "exactcsg/solid/piece_buffer.hpp"

namespace exactcsg {

using PieceNumber = std::uint32_t;

// Refers to the buffers, which must outlive it and stay as they are.
class PieceRow {
 public:
  explicit PieceRow(const std::vector<PieceBuffer>& buffers) : buffers_(buffers) {
    for (const PieceBuffer& buffer : buffers) {
      first_piece_.push_back(first_piece_.back() + buffer.pieces.size());
      first_meeting_point_.push_back(first_meeting_point_.back() + buffer.meeting_points.size());
    }
  }

  std::size_t size() const { return first_piece_.back(); }
  std::size_t meeting_point_count() const { return first_meeting_point_.back(); }

  // visit(buffer, place of its first meeting point among all, piece, number of the piece) for the
  // pieces with these numbers.
  template <class Visit>
  void for_each(std::size_t begin, std::size_t end, Visit visit) const {
    if (begin == end) return;
    auto b =
        static_cast<std::size_t>(std::upper_bound(first_piece_.begin(), first_piece_.end(), begin) -
                                 first_piece_.begin() - 1);
    for (std::size_t number = begin; number < end; ++b) {
      const PieceBuffer& buffer = buffers_[b];
      const std::size_t end_here = std::min(end, first_piece_[b + 1]);
      for (; number < end_here; ++number) {
        visit(buffer, first_meeting_point_[b], buffer.pieces[number - first_piece_[b]],
              static_cast<PieceNumber>(number));
      }
    }
  }

 private:
  const std::vector<PieceBuffer>& buffers_;
  std::vector<std::size_t> first_piece_{0};
  std::vector<std::size_t> first_meeting_point_{0};
};

}  // namespace exactcsg
