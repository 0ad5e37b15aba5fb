// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/vertex_interning.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "exactcsg/number/bucket_sort.hpp"
#include "exactcsg/solid/in_parallel_counting.hpp"
#include "exactcsg/support/give_up.hpp"

namespace exactcsg {

namespace {

bool same_representation(const Vertex& v, const Vertex& w) {
  if (v.is_point != w.is_point) return false;
  if (v.is_point) return v.point == w.point;
  return std::equal(std::begin(v.planes), std::end(v.planes), std::begin(w.planes));
}

bool may_coincide(const Vertex& v, const Vertex& w) {
  const double reach = (v.error + w.error) * (1 + 0x1p-50);
  return !(std::abs(v.x - w.x) > reach || std::abs(v.y - w.y) > reach ||
           std::abs(v.z - w.z) > reach);
}

// A linear form in general position: different vertices of a model hardly ever have equal keys.
KeyInterval key_of(const Vertex& v, std::uint32_t item) {
  constexpr double alpha = 0.8414709848078965;
  constexpr double beta = 0.5403023058681398;
  constexpr double gamma = 0.2955202066613396;
  const double key = alpha * v.x + beta * v.y + gamma * v.z;
  // The coefficients sum to less than 1.68; three products and two sums round by at most
  // 4u (|x| + |y| + |z|) with u = 2^-53; doubled.
  const double spread =
      1.7 * v.error + 0x1p-50 * (std::abs(v.x) + std::abs(v.y) + std::abs(v.z)) + 0x1p-1000;
  return {key - spread, key + spread, item};
}

std::vector<KeyInterval> sorted_by_lower_ends(std::vector<KeyInterval> intervals,
                                              unsigned threads) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  in_parallel_parts(threads, intervals.size(), [&](std::size_t i) {
    KeyInterval& interval = intervals[i];
    if (!(interval.lower > -infinity && interval.upper < infinity)) {
      interval.lower = -infinity;
      interval.upper = infinity;
    }
  });
  const auto lower_end = [](const KeyInterval& interval) { return interval.lower; };
  const DoubleBuckets buckets(intervals, lower_end, threads);
  sort_in_buckets(
      intervals, buckets.count(),
      [&](const KeyInterval& interval) { return buckets.of(interval.lower); },
      [](const KeyInterval& a, const KeyInterval& b) {
        return a.lower < b.lower || (a.lower == b.lower && a.item < b.item);
      },
      threads);
  return intervals;
}

// All vertices of pieces in one row: meeting points, then input points.
class Items {
 public:
  Items(const Geometry& geometry, const CornerVertices& vertices)
      : geometry_(geometry),
        vertices_(vertices),
        meeting_points_(static_cast<std::uint32_t>(vertices.meeting_points.size())) {}

  std::size_t count() const { return meeting_points_ + vertices_.point_occurs.size(); }
  bool is_point(std::uint32_t item) const { return item >= meeting_points_; }
  std::uint32_t id(std::uint32_t item) const { return item - meeting_points_; }
  CornerOccurrence occurrence(std::uint32_t item) const {
    return is_point(item) ? vertices_.point_occurs[id(item)] : vertices_.meeting_point_occurs[item];
  }
  // Ask for what vertex(item) reads, the first one for what the second one reads.
  void prefetch_place(std::uint32_t item) const {
    if (is_point(item)) {
      __builtin_prefetch(&geometry_.approximate(PointId{id(item)}));
    } else {
      __builtin_prefetch(&vertices_.meeting_points[item]);
    }
  }
  void prefetch(std::uint32_t item) const {
    if (is_point(item)) return;
    const Vertex* const vertex = vertices_.meeting_points[item];
    __builtin_prefetch(vertex);
    __builtin_prefetch(reinterpret_cast<const char*>(vertex + 1) - 1);
  }
  Vertex vertex(std::uint32_t item) const {
    return is_point(item) ? geometry_.vertex(PointId{id(item)}) : *vertices_.meeting_points[item];
  }

 private:
  const Geometry& geometry_;
  const CornerVertices& vertices_;
  std::uint32_t meeting_points_;
};

std::vector<KeyInterval> keys_of(const Items& items, unsigned threads) {
  const Parts parts(items.count());
  std::vector<std::vector<KeyInterval>> keys(parts.count());
  in_parallel(threads, parts, [&](std::size_t part, std::size_t begin, std::size_t end) {
    keys[part].reserve(end - begin);
    for (std::size_t i = begin; i < end; ++i) {
      const auto item = static_cast<std::uint32_t>(i);
      if (items.occurrence(item) != CornerOccurrence::Some) continue;
      keys[part].push_back(key_of(items.vertex(item), item));
    }
  });
  return joined(threads, std::move(keys));
}

// Where the vertices of each of several lists begin, and how many all have.
std::vector<VertexRow::Counts> first_counts(std::span<const VertexRow::Counts> counts) {
  std::vector<VertexRow::Counts> firsts(1);
  for (const VertexRow::Counts& count : counts) {
    const VertexRow::Counts& first = firsts.back();
    firsts.push_back(
        {first.vertices + count.vertices, first.meeting_points + count.meeting_points});
  }
  return firsts;
}

// Of those that stand alone, by part of the items.
std::vector<VertexRow::Counts> count_alone(const Items& items, const Parts& parts,
                                           unsigned threads) {
  std::vector<VertexRow::Counts> counts(parts.count());
  in_parallel(threads, parts, [&](std::size_t part, std::size_t begin, std::size_t end) {
    VertexRow::Counts count;
    for (std::size_t i = begin; i < end; ++i) {
      const auto item = static_cast<std::uint32_t>(i);
      if (items.occurrence(item) != CornerOccurrence::Alone) continue;
      ++count.vertices;
      count.meeting_points += items.is_point(item) ? 0 : 1;
    }
    counts[part] = count;
  });
  return counts;
}

// Those that stand alone, in their order, each with a number of its own. firsts: of each part.
template <class NumberOf>
void set_alone(const Items& items, const Parts& parts, std::span<const VertexRow::Counts> firsts,
               unsigned threads, const NumberOf& number_of, VertexRow& distinct) {
  in_parallel(threads, parts, [&](std::size_t part, std::size_t begin, std::size_t end) {
    VertexRow::Counts next = firsts[part];
    for (std::size_t i = begin; i < end; ++i) {
      const auto item = static_cast<std::uint32_t>(i);
      if (items.occurrence(item) != CornerOccurrence::Alone) continue;
      number_of(item) = static_cast<std::uint32_t>(next.vertices);
      distinct.set(items.vertex(item), next);
    }
  });
}

// The distinct ones among the vertices of one cluster.
class ClusterVertices {
 public:
  ClusterVertices(const Geometry& geometry, TierStatistics& statistics)
      : geometry_(geometry), statistics_(statistics) {}

  void clear() { distinct_.clear(); }

  // Its place among the distinct ones; of equals, an input point stays.
  std::size_t place_of(const Vertex& vertex) {
    const auto find = [&](auto same) {
      return std::find_if(distinct_.begin(), distinct_.end(), same);
    };
    auto known = find([&](const Vertex& other) { return same_representation(vertex, other); });
    if (known == distinct_.end()) {
      known = find([&](const Vertex& other) {
        return may_coincide(vertex, other) && geometry_.same_position(vertex, other, statistics_);
      });
    }
    const auto place = static_cast<std::size_t>(known - distinct_.begin());
    if (known == distinct_.end()) {
      distinct_.push_back(vertex);
    } else if (vertex.is_point && !known->is_point) {
      *known = vertex;
    }
    return place;
  }

  const std::vector<Vertex>& distinct() const { return distinct_; }

 private:
  const Geometry& geometry_;
  TierStatistics& statistics_;
  std::vector<Vertex> distinct_;
};

}  // namespace

Clusters::Clusters(std::vector<KeyInterval> intervals, unsigned threads)
    : intervals_(sorted_by_lower_ends(std::move(intervals), threads)),
      parts_(parts_of_sorted(threads)) {}

// Each part moved to where its first cluster begins.
Parts Clusters::parts_of_sorted(unsigned threads) const {
  const Parts even(intervals_.size());
  // The farthest upper end before each part.
  std::vector<double> reach(even.count(), -std::numeric_limits<double>::infinity());
  in_parallel(threads, even, [&](std::size_t part, std::size_t begin, std::size_t end) {
    if (part + 1 == even.count()) return;
    for (std::size_t i = begin; i < end; ++i) {
      reach[part + 1] = std::max(reach[part + 1], intervals_[i].upper);
    }
  });
  std::partial_sum(reach.begin(), reach.end(), reach.begin(),
                   [](double a, double b) { return std::max(a, b); });
  std::vector<std::size_t> bounds{intervals_.size()};
  for (std::size_t part = even.count(); part-- > 0;) {
    double farthest = reach[part];
    std::size_t begin = even.begin(part);
    while (part > 0 && begin < even.end(part) && intervals_[begin].lower <= farthest) {
      farthest = std::max(farthest, intervals_[begin].upper);
      ++begin;
    }
    // No cluster begins here: the part is empty.
    bounds.push_back(part > 0 && begin == even.end(part) ? bounds.back() : begin);
  }
  std::reverse(bounds.begin(), bounds.end());
  return Parts(std::move(bounds));
}

InternedVertices intern(const Geometry& geometry, const CornerVertices& vertices,
                        TierStatistics& statistics, unsigned threads) {
  const Items items(geometry, vertices);
  InternedVertices result{{}, {}, VertexRow(geometry)};
  result.number_of_meeting_point.resize(vertices.meeting_points.size());
  result.number_of_point.resize(vertices.point_occurs.size());
  const auto number_of = [&](std::uint32_t item) -> std::uint32_t& {
    return items.is_point(item) ? result.number_of_point[items.id(item)]
                                : result.number_of_meeting_point[item];
  };
  std::optional<const Clusters> found(std::in_place, keys_of(items, threads), threads);
  const Clusters& clusters = *found;
  const Parts& parts = clusters.parts();
  // By part, and numbered from 0 in each.
  std::vector<std::vector<Vertex>> distinct(parts.count());
  in_parallel_counting(
      threads, parts, statistics,
      [&](std::size_t part, std::size_t begin, std::size_t end, TierStatistics& tiers) {
        distinct[part].reserve(end - begin);
        ClusterVertices cluster_vertices(geometry, tiers);
        constexpr std::size_t items_ahead = 8;
        const std::span<const KeyInterval> keys = clusters.part(part);
        const KeyInterval* const last = keys.data() + keys.size();
        clusters.for_each(part, [&](std::span<const KeyInterval> cluster) {
          const std::size_t first = distinct[part].size();
          cluster_vertices.clear();
          for (const KeyInterval& key : cluster) {
            const auto left = static_cast<std::size_t>(last - &key);
            if (left > 2 * items_ahead) items.prefetch_place((&key + 2 * items_ahead)->item);
            if (left > items_ahead) items.prefetch((&key + items_ahead)->item);
            const std::size_t place = cluster_vertices.place_of(items.vertex(key.item));
            number_of(key.item) = static_cast<std::uint32_t>(first + place);
          }
          distinct[part].insert(distinct[part].end(), cluster_vertices.distinct().begin(),
                                cluster_vertices.distinct().end());
        });
      });
  std::vector<VertexRow::Counts> counts;
  for (const std::vector<Vertex>& vertices_of_part : distinct) {
    const auto meeting_points =
        std::ranges::count_if(vertices_of_part, [](const Vertex& v) { return !v.is_point; });
    counts.push_back({vertices_of_part.size(), static_cast<std::size_t>(meeting_points)});
  }
  // Those that stand alone come behind.
  const Parts items_in_parts(items.count());
  const std::vector<VertexRow::Counts> alone = count_alone(items, items_in_parts, threads);
  counts.insert(counts.end(), alone.begin(), alone.end());
  const std::vector<VertexRow::Counts> firsts = first_counts(counts);
  result.distinct.grow(threads, firsts.back());
  in_parallel(threads, parts, [&](std::size_t part, std::size_t, std::size_t) {
    VertexRow::Counts next = firsts[part];
    const auto first = static_cast<std::uint32_t>(next.vertices);
    for (const Vertex& vertex : distinct[part]) result.distinct.set(vertex, next);
    if (first == 0) return;
    for (const KeyInterval& key : clusters.part(part)) number_of(key.item) += first;
  });
  give_up(distinct);
  found.reset();  // its memory is wanted now
  set_alone(items, items_in_parts, std::span(firsts).subspan(parts.count(), alone.size()), threads,
            number_of, result.distinct);
  return result;
}

}  // namespace exactcsg
