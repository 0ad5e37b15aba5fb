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
  // pieces with these numbers. ask_early(piece) and ask_late(piece) are called some pieces before
  // that, in this order, to ask for the memory that visit will read.
  template <class Visit, class AskEarly, class AskLate>
  void for_each(std::size_t begin, std::size_t end, Visit visit, AskEarly ask_early,
                AskLate ask_late) const {
    constexpr std::size_t distance = 6;
    Place place = place_of(begin);
    Place late = place;
    Place early = place;
    std::size_t asked_late = begin;
    std::size_t asked_early = begin;
    for (std::size_t number = begin; number < end; ++number) {
      for (; asked_early < std::min(end, number + 2 * distance); ++asked_early) {
        ask_early(next_piece(early));
      }
      for (; asked_late < std::min(end, number + distance); ++asked_late) {
        ask_late(next_piece(late));
      }
      const BoundaryPiece& piece = next_piece(place);
      visit(buffers_[place.buffer], first_meeting_point_[place.buffer], piece,
            static_cast<PieceNumber>(number));
    }
  }

 private:
  // Of a piece: its buffer, and the number of it there.
  struct Place {
    std::size_t buffer;
    std::size_t piece;
  };

  Place place_of(std::size_t number) const {
    const auto buffer = static_cast<std::size_t>(
        std::upper_bound(first_piece_.begin(), first_piece_.end(), number) - first_piece_.begin() -
        1);
    return {buffer, number - first_piece_[std::min(buffer, buffers_.size())]};
  }

  // The piece there, which may be the end of a buffer; the place goes behind it.
  const BoundaryPiece& next_piece(Place& place) const {
    while (place.piece == buffers_[place.buffer].pieces.size()) place = {place.buffer + 1, 0};
    return buffers_[place.buffer].pieces[place.piece++];
  }

  const std::vector<PieceBuffer>& buffers_;
  std::vector<std::size_t> first_piece_{0};
  std::vector<std::size_t> first_meeting_point_{0};
};

}  // namespace exactcsg
