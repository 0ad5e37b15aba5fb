// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/piece_buffer.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

namespace exactcsg {

namespace {

std::size_t hash_of(const Vertex& meeting_point) {
  std::uint64_t hash = 0x9e3779b97f4a7c15ULL;
  for (const PlaneRef plane : meeting_point.planes) {
    hash = (hash ^ plane.bits()) * 0xff51afd7ed558ccdULL;
    hash ^= hash >> 32U;
  }
  return hash;
}

bool same_planes(const Vertex& v, const Vertex& w) {
  return std::equal(std::begin(v.planes), std::end(v.planes), std::begin(w.planes));
}

}  // namespace

void append(const PieceBuffer& added, PieceBuffer& result) {
  const auto first_corner = static_cast<std::uint32_t>(result.corners.size());
  const auto first_point = static_cast<std::uint32_t>(result.meeting_points.size());
  for (BoundaryPiece piece : added.pieces) {
    piece.first_corner += first_corner;
    result.pieces.push_back(piece);
  }
  for (PieceCorner corner : added.corners) {
    if (!corner.is_point) corner.vertex += first_point;
    result.corners.push_back(corner);
  }
  result.meeting_points.insert(result.meeting_points.end(), added.meeting_points.begin(),
                               added.meeting_points.end());
}

PieceBuffer compacted(const PieceBuffer& buffer) {
  constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
  PieceBuffer result;
  std::vector<std::uint32_t> new_number(buffer.meeting_points.size(), none);
  std::size_t corners = 0;
  std::uint32_t meeting_points = 0;
  for (const BoundaryPiece& piece : buffer.pieces) {
    if (piece.share == facet_share::whole) continue;
    corners += piece.corner_count;
    for (const PieceCorner& corner : buffer.corners_of(piece)) {
      if (corner.is_point || new_number[corner.vertex] != none) continue;
      new_number[corner.vertex] = meeting_points++;
    }
  }
  result.pieces = buffer.pieces;
  result.corners.reserve(corners);
  result.meeting_points.resize(meeting_points);
  for (BoundaryPiece& piece : result.pieces) {
    const auto first_corner = static_cast<std::uint32_t>(result.corners.size());
    if (piece.share == facet_share::whole) {
      piece.first_corner = piece.corner_count = 0;
      continue;
    }
    for (PieceCorner corner : buffer.corners_of(piece)) {
      if (!corner.is_point) corner.vertex = new_number[corner.vertex];
      result.corners.push_back(corner);
    }
    piece.first_corner = first_corner;
  }
  for (std::size_t i = 0; i < new_number.size(); ++i) {
    if (new_number[i] != none) result.meeting_points[new_number[i]] = buffer.meeting_points[i];
  }
  return result;
}

void PieceCollector::add(OrientedPlaneRef outward, signed char corner_sense, FacetIndex facet,
                         std::uint64_t share, const CornerView& polygon) {
  if (share == facet_share::whole) {
    buffer_.pieces.push_back({outward, corner_sense, 0, 0, facet, share});
    return;
  }
  begin(outward, corner_sense, facet, share);
  polygon.for_each_vertex(
      [&](std::size_t i, const Vertex& vertex) { add_corner(vertex, polygon.side_plane(i)); });
}

void PieceCollector::begin(OrientedPlaneRef outward, signed char corner_sense, FacetIndex facet,
                           std::uint64_t share, bool is_hole) {
  buffer_.pieces.push_back({outward, corner_sense,
                            static_cast<std::uint32_t>(buffer_.corners.size()), 0, facet, share,
                            false, is_hole});
}

void PieceCollector::add_corner(const Vertex& vertex, PlaneRef side_plane) {
  append_corner(vertex, side_plane);
  ++buffer_.pieces.back().corner_count;
}

void PieceCollector::append_corner(const Vertex& vertex, PlaneRef side_plane) {
  const std::uint32_t number =
      vertex.is_point ? static_cast<std::uint32_t>(vertex.point) : place_of(vertex);
  buffer_.corners.push_back({side_plane, number, vertex.is_point});
}

void PieceCollector::add_slice(OrientedPlaneRef outward, signed char corner_sense, FacetIndex facet,
                               std::uint64_t share, const Slice& slice) {
  begin(outward, corner_sense, facet, share);
  buffer_.pieces.back().is_slice = true;
  for (const Slice::Wall& wall : slice.walls()) {
    buffer_.corners.push_back({wall.plane, wall.kept == Sign::Positive ? 1U : 0U, true});
    ++buffer_.pieces.back().corner_count;
  }
}

void PieceCollector::resume(PieceBuffer buffer) {
  discard();
  buffer_ = std::move(buffer);
  if (buffer_.meeting_points.size() * 2 >= slots_.size()) {
    enlarge_slots();
    return;
  }
  for (std::uint32_t place = 0; place < buffer_.meeting_points.size(); ++place) {
    slot_of(buffer_.meeting_points[place]) = {place, round_};
  }
}

void PieceCollector::cut_slice(std::size_t piece, const CornerView& polygon) {
  BoundaryPiece& cut = buffer_.pieces[piece];
  cut.is_slice = false;
  cut.first_corner = static_cast<std::uint32_t>(buffer_.corners.size());
  cut.corner_count = static_cast<std::uint32_t>(polygon.size());
  polygon.for_each_vertex(
      [&](std::size_t i, const Vertex& vertex) { append_corner(vertex, polygon.side_plane(i)); });
}

PieceCollector::Mark PieceCollector::mark() const {
  return {buffer_.pieces.size(), buffer_.corners.size(), buffer_.meeting_points.size()};
}

std::span<const BoundaryPiece> PieceCollector::pieces_since(const Mark& mark) const {
  return std::span(buffer_.pieces).subspan(mark.pieces);
}

void PieceCollector::take_back_to(const Mark& mark) {
  buffer_.pieces.resize(mark.pieces);
  buffer_.corners.resize(mark.corners);
  // The latest first: no other can have passed over a slot on the way to its own.
  while (buffer_.meeting_points.size() > mark.meeting_points) {
    slot_of(buffer_.meeting_points.back()) = {};
    buffer_.meeting_points.pop_back();
  }
}

PieceBuffer PieceCollector::take(bool in_general_position) {
  for (BoundaryPiece& piece : buffer_.pieces) piece.in_general_position = in_general_position;
  PieceBuffer result = buffer_;  // copies have no memory to spare
  discard();
  return result;
}

void PieceCollector::discard() {
  buffer_.pieces.clear();
  buffer_.corners.clear();
  buffer_.meeting_points.clear();
  if (++round_ == 0) {
    slots_.clear();
    round_ = 1;
  }
}

std::uint32_t PieceCollector::place_of(const Vertex& meeting_point) {
  if (buffer_.meeting_points.size() * 2 >= slots_.size()) enlarge_slots();
  Slot& slot = slot_of(meeting_point);
  if (slot.round != round_) {
    slot = {static_cast<std::uint32_t>(buffer_.meeting_points.size()), round_};
    buffer_.meeting_points.push_back(meeting_point);
  }
  return slot.place;
}

// That of the meeting point, or the free one where it belongs.
PieceCollector::Slot& PieceCollector::slot_of(const Vertex& meeting_point) {
  const std::size_t mask = slots_.size() - 1;
  std::size_t i = hash_of(meeting_point) & mask;
  while (slots_[i].round == round_ &&
         !same_planes(buffer_.meeting_points[slots_[i].place], meeting_point)) {
    i = (i + 1) & mask;
  }
  return slots_[i];
}

void PieceCollector::enlarge_slots() {
  std::size_t size = std::max<std::size_t>(slots_.size() * 2, 64);
  while (buffer_.meeting_points.size() * 2 >= size) size *= 2;
  slots_.assign(size, Slot{});
  for (std::uint32_t place = 0; place < buffer_.meeting_points.size(); ++place) {
    slot_of(buffer_.meeting_points[place]) = {place, round_};
  }
}

}  // namespace exactcsg
