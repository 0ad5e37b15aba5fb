// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/facet_section.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "exactcsg/support/error.hpp"

namespace exactcsg {

std::uint32_t SectionStore::append(const Vertex& vertex) {
  vertices_.push_back(vertex);
  return static_cast<std::uint32_t>(vertices_.size() - 1);
}

std::uint32_t SectionStore::meet(const Geometry& geometry, PlaneRef p, PlaneRef q, PlaneRef r,
                                 std::uint32_t from, std::uint32_t to) {
  if (met_ * 2 >= slots_.size()) enlarge_slots();
  std::array<PlaneRef, 3> planes{p, q, r};
  if (planes[1] < planes[0]) std::swap(planes[0], planes[1]);
  if (planes[2] < planes[1]) std::swap(planes[1], planes[2]);
  if (planes[1] < planes[0]) std::swap(planes[0], planes[1]);
  Slot& slot = slot_of(planes);
  if (slot.round != round_) {
    slot = {append(geometry.meet(p, q, r, vertices_[from], vertices_[to])), round_};
    ++met_;
  }
  return slot.vertex;
}

void SectionStore::clear() {
  corners.clear();
  vertices_.clear();
  met_ = 0;
  if (++round_ == 0) {
    slots_.clear();
    round_ = 1;
  }
}

// That of the meeting point, or the free one where it belongs.
SectionStore::Slot& SectionStore::slot_of(const std::array<PlaneRef, 3>& planes) {
  std::uint64_t hash = 0;
  for (const PlaneRef plane : planes) hash = (hash ^ plane.bits()) * 0x9e3779b97f4a7c15U;
  const std::size_t mask = slots_.size() - 1;
  std::size_t i = (hash >> 32U) & mask;
  while (slots_[i].round == round_ && !std::equal(planes.begin(), planes.end(),
                                                  std::begin(vertices_[slots_[i].vertex].planes))) {
    i = (i + 1) & mask;
  }
  return slots_[i];
}

void SectionStore::enlarge_slots() {
  const std::vector<Slot> old = std::move(slots_);
  slots_.assign(std::max<std::size_t>(old.size() * 2, 256), Slot{});
  for (const Slot& slot : old) {
    if (slot.round == round_) {
      slot_of(std::to_array(vertices_[slot.vertex].planes)) = slot;
    }
  }
}

CornerRun append_polygon(const CornerView& polygon, SectionStore& store) {
  CornerRun run{store.corners.size(), store.corners.size() + polygon.size()};
  polygon.for_each_vertex([&](std::size_t i, const Vertex& vertex) {
    store.corners.push_back({store.append(vertex), 0, 0, polygon.side_plane(i)});
  });
  forget_whole(run, store);
  return run;
}

void forget_whole(const CornerRun& section, SectionStore& store) {
  for (std::size_t i = 0; i < section.size(); ++i) {
    SectionCorner& corner = store.corners[section.begin + i];
    corner.side = static_cast<std::int32_t>(i);
    corner.place = 2 * corner.side;
  }
}

std::array<std::uint32_t, 2> append_crossings(const Geometry& geometry, PlaneRef supporting,
                                              const CornerRun& polygon, const CuttingPlane& cut,
                                              SectionStore& store) {
  std::array<std::uint32_t, 2> result{};
  std::size_t found = 0;
  const std::span<const SectionCorner> corners = store.of(polygon);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const std::size_t next = i + 1 == corners.size() ? 0 : i + 1;
    if (cut.signs[i] == Sign::Zero || cut.signs[next] != -cut.signs[i]) continue;
    if (found == result.size()) {
      throw Error(ErrorId::InternalError, {"a facet that is not convex", "a convex one"});
    }
    result[found++] = store.meet(geometry, supporting, corners[i].side_plane, cut.plane,
                                 corners[i].vertex, corners[next].vertex);
  }
  return result;
}

namespace {

// The corners of append_part, one after the other, and whether they lie in the cutting plane.
template <class Visit>
CornerRun append_each(const CornerRun& polygon, const CuttingPlane& cut, Sign kept,
                      const std::array<std::uint32_t, 2>& crossings, SectionStore& store,
                      const Visit& adapt) {
  constexpr std::int32_t none = SectionCorner::none;
  CornerRun part{store.corners.size(), 0};
  std::size_t crossing = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Sign here = cut.signs[i];
    const Sign there = cut.signs[i + 1 == polygon.size() ? 0 : i + 1];
    const SectionCorner corner = store.corners[polygon.begin + i];
    if (here == kept || here == Sign::Zero) {
      SectionCorner kept_corner = corner;
      // A corner in the cutting plane whose next side leaves the kept part starts the cut side.
      if (here == Sign::Zero && there != kept) {
        kept_corner.side = none;
        kept_corner.side_plane = cut.plane;
      }
      store.corners.push_back(adapt(kept_corner, here == Sign::Zero));
    }
    if (here != Sign::Zero && there == -here) {
      const std::int32_t place = corner.side == none ? none : 2 * corner.side + 1;
      const std::uint32_t vertex = crossings[crossing++];
      const SectionCorner crossed =
          there == kept ? SectionCorner{vertex, corner.side, place, corner.side_plane}
                        : SectionCorner{vertex, none, place, cut.plane};
      store.corners.push_back(adapt(crossed, true));
    }
  }
  part.end = store.corners.size();
  return part;
}

// What sides and places of a polygon are for its half, whose corners still have the polygon's.
class HalfRim {
 public:
  HalfRim(const CornerRun& half, const SectionStore& store)
      : half_(half), store_(store), cut_side_(side(none)) {}

  SectionCorner operator()(SectionCorner corner, bool is_in_cut, PlaneRef cut) const {
    if (corner.side != none) {
      corner.side = side(corner.side);
    } else if (corner.side_plane == cut) {
      corner.side = cut_side_;
    }
    if (corner.place != none) {
      corner.place = place(corner.place, is_in_cut);
    } else if (is_in_cut) {
      corner.place = 2 * cut_side_ + 1;
    }
    return corner;
  }

 private:
  static constexpr std::int32_t none = SectionCorner::none;

  std::int32_t side(std::int32_t old) const {
    return find([=](const SectionCorner& corner) { return corner.side == old; });
  }
  // Of the half's corners in the cut, that on the same side of the polygon; or as it was.
  std::int32_t place(std::int32_t old, bool is_in_cut) const {
    if (old % 2 == 0 || is_in_cut) {
      return 2 * find([=](const SectionCorner& corner) { return corner.place == old; });
    }
    return 2 * side(old / 2) + 1;
  }
  template <class Predicate>
  std::int32_t find(const Predicate& predicate) const {
    const std::span<const SectionCorner> corners = store_.of(half_);
    const auto found = std::find_if(corners.begin(), corners.end(), predicate);
    if (found == corners.end()) {
      throw Error(ErrorId::InternalError, {"a section that leaves its polygon", "a part of it"});
    }
    return static_cast<std::int32_t>(found - corners.begin());
  }

  CornerRun half_;
  const SectionStore& store_;  // which grows meanwhile
  std::int32_t cut_side_;
};

}  // namespace

CornerRun append_part(const CornerRun& polygon, const CuttingPlane& cut, Sign kept,
                      const std::array<std::uint32_t, 2>& crossings, SectionStore& store) {
  return append_each(polygon, cut, kept, crossings, store,
                     [](const SectionCorner& corner, bool) { return corner; });
}

CornerRun append_part_of_half(const CornerRun& section, const CuttingPlane& cut, Sign kept,
                              const std::array<std::uint32_t, 2>& crossings, const CornerRun& half,
                              SectionStore& store) {
  const HalfRim rim(half, store);
  return append_each(section, cut, kept, crossings, store,
                     [&](const SectionCorner& corner, bool is_in_cut) {
                       return rim(corner, is_in_cut, cut.plane);
                     });
}

Remainder::Remainder(const CornerRun& polygon, const CornerRun& section, const SectionStore& store)
    : polygon_(store.of(polygon)), section_(store.of(section)) {
  constexpr std::int32_t none = SectionCorner::none;
  for (std::uint32_t i = 0; i < section_.size(); ++i) {
    if (section_[i].place != none && section_[i].side == none) starts_.push_back(i);
  }
}

// Both loops run counter-clockwise: between the ends of a stretch of the section's rim inside the
// polygon, the polygon's rim bounds what the stretch cuts off. It has a corner at least: the
// section is convex, and on the same side of the polygon as the stretch's end lies its beginning
// only if the section touches that side from there to here.
void Remainder::append_loop(std::size_t loop, std::vector<LoopCorner>& result) const {
  if (is_ring()) {
    if (loop == 0) {
      for (const SectionCorner& corner : polygon_) {
        result.push_back({corner.vertex, corner.side_plane});
      }
    } else {
      append_reversed(0, section_.size(), result);
    }
    return;
  }
  const std::size_t first = starts_[loop];
  std::size_t length = 1;  // sides of the stretch
  while (section_[(first + length) % section_.size()].place == SectionCorner::none) ++length;
  const SectionCorner& from = section_[first];
  const SectionCorner& to = section_[(first + length) % section_.size()];
  // Along the polygon's rim from the one to the other.
  const auto corners = static_cast<std::int32_t>(polygon_.size());
  const std::int32_t round = 2 * corners;
  std::int32_t way = to.place - from.place;
  if (way <= 0) way += round;
  result.push_back({from.vertex, polygon_[static_cast<std::size_t>(from.place / 2)].side_plane});
  const std::int32_t passed = from.place % 2 == 0 ? (way - 1) / 2 : way / 2;
  for (std::int32_t i = 1; i <= passed; ++i) {
    const SectionCorner& corner =
        polygon_[static_cast<std::size_t>((from.place / 2 + i) % corners)];
    result.push_back({corner.vertex, corner.side_plane});
  }
  append_reversed(first + 1, length, result);
}

// The corners from `from` on, backwards, each with the plane of the side that leads to it.
void Remainder::append_reversed(std::size_t from, std::size_t count,
                                std::vector<LoopCorner>& result) const {
  const std::size_t size = section_.size();
  for (std::size_t i = count; i > 0; --i) {
    const std::size_t here = (from + i - 1) % size;
    const std::size_t before = (from + i - 2 + size) % size;
    result.push_back({section_[here].vertex, section_[before].side_plane});
  }
}

}  // namespace exactcsg
