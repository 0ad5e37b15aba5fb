// SPDX-License-Identifier: Apache-2.0
#pragma once

// The pieces of many buffers in one row, numbered. Internal to the evaluator. [Exact]

#include <algorithm>
#include <array>
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
  // pieces with these numbers. Each ask(piece) is called some pieces before that, in the order in
  // which they are given, to ask for the memory that the next one and visit will read.
  template <class Visit, class... Ask>
  void for_each(std::size_t begin, std::size_t end, Visit visit, Ask... ask) const {
    constexpr std::size_t distance = 6;
    Place place = place_of(begin);
    std::array<Ahead, sizeof...(Ask)> ahead;
    ahead.fill({place, begin});
    for (std::size_t number = begin; number < end; ++number) {
      std::size_t stage = 0;
      const auto go_ahead = [&](const auto& ask_for) {
        const std::size_t asked_end = std::min(end, number + (ahead.size() - stage) * distance);
        for (Ahead& here = ahead[stage++]; here.number < asked_end; ++here.number) {
          ask_for(next_piece(here.place));
        }
      };
      (go_ahead(ask), ...);
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

  struct Ahead {
    Place place;
    std::size_t number;  // of the next piece to be asked for
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
