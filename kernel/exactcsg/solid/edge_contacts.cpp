// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/edge_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "exactcsg/solid/box_pairs.hpp"
#include "exactcsg/solid/in_parallel_counting.hpp"
#include "exactcsg/solid/nearest_crossing.hpp"

namespace exactcsg {

namespace {

class ContactSearch {
 public:
  ContactSearch(const Geometry& geometry, const VertexRow& vertices,
                std::span<const EdgeSpan> spans)
      : geometry_(geometry), vertices_(vertices), spans_(spans) {}

  // Spans of one line may overlap where their lines have different numbers: where such a span ends
  // inside another, so do edges of other directions, which touch it there.
  void add_contact(std::uint32_t first, std::uint32_t second, std::vector<EdgeContact>& result,
                   TierStatistics& statistics) const {
    const EdgeSpan& a = spans_[first];
    const EdgeSpan& b = spans_[second];
    if (a.line == b.line) return;
    if (a.from == b.from || a.from == b.to || a.to == b.from || a.to == b.to) return;
    std::optional<PlaneRef> crossing;
    std::array<Sign, 2> crossing_sides{};
    for (const PlaneRef plane : b.planes) {
      const auto side = sides(a, plane, statistics);
      if (side[0] == side[1]) {
        if (side[0] != Sign::Zero) return;
        continue;
      }
      crossing = plane;
      crossing_sides = side;
    }
    if (!crossing) return;
    for (const PlaneRef plane : a.planes) {
      const auto side = sides(b, plane, statistics);
      if (side[0] == side[1] && side[0] != Sign::Zero) return;
    }
    // The point of a's line in the crossing plane; it is on b's line iff in b's other plane as
    // well.
    std::optional<std::uint32_t> end;
    if (crossing_sides[0] == Sign::Zero) {
      end = a.from;
    } else if (crossing_sides[1] == Sign::Zero) {
      end = a.to;
    }
    const Vertex point =
        end ? vertices_[*end] : geometry_.meet(a.planes[0], a.planes[1], *crossing);
    const PlaneRef other = *crossing == b.planes[0] ? b.planes[1] : b.planes[0];
    if (geometry_.side(point, other, statistics) != Sign::Zero) return;
    if (!within(point, b, statistics)) return;
    for (const std::uint32_t end_of_b : {b.from, b.to}) {
      if (!end && geometry_.same_position(point, vertices_[end_of_b], statistics)) end = end_of_b;
    }
    result.push_back({first, second, point, end});
  }

 private:
  // Of a span's ends.
  std::array<Sign, 2> sides(const EdgeSpan& span, PlaneRef plane,
                            TierStatistics& statistics) const {
    return {geometry_.side(vertices_[span.from], plane, statistics),
            geometry_.side(vertices_[span.to], plane, statistics)};
  }

  // Points of the line only; both ends included.
  bool within(const Vertex& point, const EdgeSpan& span, TierStatistics& statistics) const {
    const bool ascending =
        geometry_.compare_position(vertices_[span.from], vertices_[span.to], statistics) < 0;
    const std::uint32_t low = ascending ? span.from : span.to;
    const std::uint32_t high = ascending ? span.to : span.from;
    return geometry_.compare_position(vertices_[low], point, statistics) <= 0 &&
           geometry_.compare_position(point, vertices_[high], statistics) <= 0;
  }

  const Geometry& geometry_;
  const VertexRow& vertices_;
  std::span<const EdgeSpan> spans_;
};

// The spans of one primitive are a group, and each of none.
GroupedBoxes boxes_of(const VertexRow& vertices, std::span<const EdgeSpan> spans,
                      unsigned threads) {
  std::vector<DoubleBox> boxes(spans.size());
  in_parallel_parts(threads, spans.size(), [&](std::size_t i) {
    boxes[i] = join(box_of(vertices[spans[i].from]), box_of(vertices[spans[i].to]));
  });
  std::vector<std::uint32_t> group_begins;
  for (std::uint32_t i = 0; i < spans.size(); ++i) {
    if (i == 0 || spans[i].primitive == EdgeSpan::no_primitive ||
        spans[i].primitive != spans[i - 1].primitive) {
      group_begins.push_back(i);
    }
  }
  return {boxes, group_begins};
}

}  // namespace

std::vector<EdgeContact> edge_contacts(const Geometry& geometry, const VertexRow& vertices,
                                       std::span<const EdgeSpan> spans, TierStatistics& statistics,
                                       unsigned threads, Progress* progress) {
  const GroupedBoxes grouped = boxes_of(vertices, spans, threads);
  const ContactSearch contact_search(geometry, vertices, spans);
  const std::vector<BoxHierarchy::Search> searches = grouped.hierarchy().searches();
  std::vector<std::vector<EdgeContact>> contacts(searches.size());
  in_parallel_counting(
      threads, searches.size(), statistics, [&](std::size_t search, TierStatistics& tiers) {
        if (progress != nullptr) progress->check();
        grouped.hierarchy().for_each_pair(searches[search], [&](std::uint32_t i, std::uint32_t j) {
          contact_search.add_contact(i, j, contacts[search], tiers);
        });
      });
  return joined(threads, std::move(contacts));
}

VertexFinder::VertexFinder(const Geometry& geometry, const VertexRow& vertices)
    : geometry_(geometry), by_x_(vertices.size()) {
  std::iota(by_x_.begin(), by_x_.end(), 0U);
  std::sort(by_x_.begin(), by_x_.end(),
            [&](std::uint32_t a, std::uint32_t b) { return vertices[a].x < vertices[b].x; });
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    widest_error_ = std::max(widest_error_, vertices[i].error);
  }
}

std::optional<std::uint32_t> VertexFinder::find(const Vertex& point, const VertexRow& vertices,
                                                TierStatistics& statistics) const {
  const double reach = 2 * (point.error + widest_error_) + 0x1p-50 * std::abs(point.x);
  auto it = std::lower_bound(by_x_.begin(), by_x_.end(), point.x - reach,
                             [&](std::uint32_t a, double x) { return vertices[a].x < x; });
  for (; it != by_x_.end() && vertices[*it].x <= point.x + reach; ++it) {
    const Vertex& v = vertices[*it];
    if (std::abs(v.y - point.y) > 2 * (point.error + v.error) + 0x1p-50 * std::abs(v.y)) continue;
    if (geometry_.same_position(v, point, statistics)) return *it;
  }
  return std::nullopt;
}

}  // namespace exactcsg
