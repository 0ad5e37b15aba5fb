// SPDX-License-Identifier: Apache-2.0
#pragma once

// What is left of the sides of pieces along one line of one oriented plane: a stretch that has
// pieces on both sides bounds neither. Internal to the evaluator. [Exact]

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "exactcsg/support/error.hpp"

namespace exactcsg {

// An end of a side of a piece, at a place on the line.
struct LineEvent {
  std::uint32_t rank;  // of the place among those on the line
  bool opens;
  bool forward;  // the side goes towards higher ranks: its piece is on the left
  std::uint32_t piece;
};

// Appends the two events of a side. REQUIRES from != to
inline void add_events(std::uint32_t from, std::uint32_t to, std::uint32_t piece,
                       std::vector<LineEvent>& events) {
  const bool forward = from < to;
  const auto [low, high] = std::minmax(from, to);
  events.push_back({low, true, forward, piece});
  events.push_back({high, false, forward, piece});
}

// visit(left, right, low, high): the pieces (at least one) on the left and on the right between
// neighbouring ranks, in ascending order. Sorts the events.
// THROWS Error(InternalError) if two pieces overlap. COST: O(n log n)
template <class Visit>
void sum_along_line(std::vector<LineEvent>& events, Visit visit) {
  std::sort(events.begin(), events.end(), [](const LineEvent& a, const LineEvent& b) {
    if (a.rank != b.rank) return a.rank < b.rank;
    return a.opens < b.opens;  // close first: pieces may follow one another
  });
  std::optional<std::uint32_t> left;
  std::optional<std::uint32_t> right;
  for (std::size_t i = 0; i < events.size();) {
    const std::uint32_t here = events[i].rank;
    for (; i < events.size() && events[i].rank == here; ++i) {
      std::optional<std::uint32_t>& side = events[i].forward ? left : right;
      if (events[i].opens == side.has_value()) {
        throw Error(ErrorId::InternalError, {"two pieces of boundary that overlap", ""});
      }
      side = events[i].opens ? std::optional(events[i].piece) : std::nullopt;
    }
    if (i == events.size()) break;
    if (left || right) visit(left, right, here, events[i].rank);
  }
}

}  // namespace exactcsg
