// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/ordered_vertices.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <utility>

#include "exactcsg/number/bucket_sort.hpp"
#include "exactcsg/support/in_parallel.hpp"

namespace exactcsg {

namespace {

// Indices of points, whose nearest doubles are known, in lexicographic order. Rounding to nearest
// is monotone: the doubles sort all but runs of equal ones, and of these it is enough to know that
// their exact numbers are equal too, as nearly all are.
class LexicographicOrder {
 public:
  LexicographicOrder(const std::vector<std::array<double, 3>>& nearest, const ExactPoints& exact)
      : nearest_(nearest), exact_(exact) {}

  void sort(std::vector<std::uint32_t>& order, unsigned threads) const {
    const auto x = [this](std::uint32_t i) { return nearest_[i][0]; };
    const DoubleBuckets buckets(order, x, threads);
    sort_in_buckets(
        order, buckets.count(), [&](std::uint32_t i) { return buckets.of(x(i)); },
        [this](std::uint32_t i, std::uint32_t j) { return nearest_[i] < nearest_[j]; }, threads);
    const Parts parts(order.size(), [&](std::size_t i) { return x(order[i]) != x(order[i - 1]); });
    in_parallel(threads, parts, [&](std::size_t, std::size_t begin, std::size_t end) {
      const auto run = std::span(order).subspan(begin, end - begin);
      if (!ascends(run)) settle(run, 0);
    });
  }

 private:
  // Whether it does so exactly, as it does by doubles; not, if equal doubles leave it open.
  bool ascends(std::span<const std::uint32_t> run) const {
    PointView last = exact_.view(run.front());
    for (std::size_t k = 1; k < run.size(); ++k) {
      const PointView next = exact_.view(run[k]);
      const std::array<double, 3>& p = nearest_[run[k - 1]];
      const std::array<double, 3>& q = nearest_[run[k]];
      for (std::size_t axis = 0; axis < 3 && p[axis] == q[axis]; ++axis) {
        if (!equal(last[axis], next[axis])) return false;
      }
      last = next;
    }
    return true;
  }

  // The coordinates before `axis` are equal, and the rest is sorted by doubles.
  void settle(std::span<std::uint32_t> run, std::size_t axis) const {
    for (std::size_t begin = 0; begin < run.size();) {
      std::size_t end = begin + 1;
      while (end < run.size() && nearest_[run[end]][axis] == nearest_[run[begin]][axis]) ++end;
      const auto equals = run.subspan(begin, end - begin);
      if (equals.size() > 1) {
        if (axis < 2 && are_equal(equals, axis)) {
          settle(equals, axis + 1);
        } else {
          std::sort(equals.begin(), equals.end(), [this](std::uint32_t i, std::uint32_t j) {
            return compare(exact_.view(i), exact_.view(j)) < 0;
          });
        }
      }
      begin = end;
    }
  }

  bool are_equal(std::span<const std::uint32_t> run, std::size_t axis) const {
    const RationalView first = exact_.view(run.front())[axis];
    return std::all_of(run.begin() + 1, run.end(),
                       [&](std::uint32_t i) { return equal(first, exact_.view(i)[axis]); });
  }

  const std::vector<std::array<double, 3>>& nearest_;
  const ExactPoints& exact_;
};

struct Wanted {
  double x;
  float y;
  std::uint32_t vertex;
};

// Those that are wanted, nearly in lexicographic order: points that are neighbours there are to lie
// side by side in memory, too.
std::vector<Wanted> wanted_vertices(const VertexRow& vertices,
                                    std::span<const unsigned char> is_wanted, unsigned threads) {
  const Parts parts(vertices.size());
  std::vector<std::size_t> firsts(parts.count() + 1, 0);
  in_parallel(threads, parts, [&](std::size_t part, std::size_t begin, std::size_t end) {
    firsts[part + 1] = static_cast<std::size_t>(
        std::ranges::count_if(is_wanted.subspan(begin, end - begin), std::identity()));
  });
  std::partial_sum(firsts.begin(), firsts.end(), firsts.begin());
  std::vector<Wanted> wanted;
  resize(threads, wanted, firsts.back());
  in_parallel(threads, parts, [&](std::size_t part, std::size_t begin, std::size_t end) {
    auto next = wanted.begin() + static_cast<std::ptrdiff_t>(firsts[part]);
    for (auto v = static_cast<std::uint32_t>(begin); v < end; ++v) {
      if (!is_wanted[v]) continue;
      const Vertex& vertex = vertices[v];
      *next++ = {vertex.x, static_cast<float>(vertex.y), v};
    }
  });
  const auto x = [](const Wanted& vertex) { return vertex.x; };
  const DoubleBuckets buckets(wanted, x, threads);
  sort_in_buckets(
      wanted, buckets.count(), [&](const Wanted& vertex) { return buckets.of(x(vertex)); },
      [](const Wanted& a, const Wanted& b) {
        if (a.x != b.x) return a.x < b.x;
        return a.y != b.y ? a.y < b.y : a.vertex < b.vertex;
      },
      threads);
  return wanted;
}

struct Positions {
  ExactPoints exact;
  std::vector<std::array<double, 3>> nearest;
};

// Item i becomes what was item order[i], in place: nearly all are where they belong.
template <class Item>
void reorder(std::span<const std::uint32_t> order, std::vector<Item>& items, unsigned threads) {
  const Parts parts(order.size());
  std::vector<std::vector<Item>> moved(parts.count());
  in_parallel(threads, parts, [&](std::size_t part, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (order[i] != i) moved[part].push_back(items[order[i]]);
    }
  });
  in_parallel(threads, parts, [&](std::size_t part, std::size_t begin, std::size_t end) {
    auto next = moved[part].begin();
    for (std::size_t i = begin; i < end; ++i) {
      if (order[i] != i) items[i] = *next++;
    }
  });
}

// Input points lie in the order of their primitives, and their limbs elsewhere: a pass in another
// order waits for most of them unless it asks ahead, for what leads to them first.
class PointsAhead {
 public:
  PointsAhead(const Geometry& geometry, const VertexRow& vertices, std::span<const Wanted> wanted)
      : geometry_(geometry), vertices_(vertices), wanted_(wanted) {}

  void ask_beyond(std::size_t i) const {
    constexpr std::size_t distance = 6;  // which takes longer than a line of memory to arrive
    if (i + 4 * distance < wanted_.size()) vertices_.prefetch_place(vertex(i + 4 * distance));
    if (i + 3 * distance < wanted_.size()) vertices_.prefetch(vertex(i + 3 * distance));
    if (i + 2 * distance < wanted_.size()) ask_where_it_is(vertex(i + 2 * distance));
    if (i + distance < wanted_.size() && vertices_.is_point(vertex(i + distance))) {
      // Of points whose coordinates are as long as doubles the limbs take one line or two.
      const PointRecord point = geometry_.point(vertices_.point(vertex(i + distance)));
      const auto* const limbs = static_cast<const mp_limb_t*>(point.address());
      __builtin_prefetch(limbs);
      __builtin_prefetch(limbs + 6);
    }
  }

 private:
  std::uint32_t vertex(std::size_t i) const { return wanted_[i].vertex; }

  void ask_where_it_is(std::uint32_t v) const {
    if (vertices_.is_point(v)) {
      geometry_.ask_for_point(vertices_.point(v));
      return;
    }
    const Vertex met = vertices_[v];
    for (const PlaneRef plane : met.planes) geometry_.ask_for_points_on(plane);
  }

  const Geometry& geometry_;
  const VertexRow& vertices_;
  std::span<const Wanted> wanted_;
};

Positions positions_of(const Geometry& geometry, const VertexRow& vertices,
                       std::span<const Wanted> wanted, unsigned threads) {
  Positions positions;
  resize(threads, positions.nearest, wanted.size());
  const Parts parts(wanted.size());
  std::vector<ExactPoints> exact(parts.count());
  const PointsAhead ahead(geometry, vertices, wanted);
  in_parallel(threads, parts, [&](std::size_t part, std::size_t begin, std::size_t end) {
    exact[part].reserve(end - begin);
    for (std::size_t i = begin; i < end; ++i) {
      ahead.ask_beyond(i);
      const NearPointView point = geometry.exact_view(vertices[wanted[i].vertex]);
      exact[part].push_back(point.exact);
      positions.nearest[i] = point.nearest;
    }
  });
  positions.exact.reserve(wanted.size());
  for (ExactPoints& points : exact) positions.exact.append(std::move(points));
  return positions;
}

}  // namespace

OrderedVertices ordered_vertices(const Geometry& geometry, const VertexRow& vertices,
                                 std::span<const unsigned char> is_wanted, unsigned threads) {
  const std::vector<Wanted> wanted = wanted_vertices(vertices, is_wanted, threads);
  Positions positions = positions_of(geometry, vertices, wanted, threads);
  std::vector<std::uint32_t> order(wanted.size());
  std::iota(order.begin(), order.end(), 0U);
  LexicographicOrder(positions.nearest, positions.exact).sort(order, threads);
  OrderedVertices result;
  resize(threads, result.number, vertices.size());
  in_parallel_parts(threads, vertices.size(),
                    [&](std::size_t v) { result.number[v] = OrderedVertices::none; });
  in_parallel_parts(threads, order.size(), [&](std::size_t place) {
    result.number[wanted[order[place]].vertex] = static_cast<std::uint32_t>(place);
  });
  reorder(order, positions.nearest, threads);
  result.nearest = std::move(positions.nearest);
  positions.exact.reorder(order);
  result.exact = std::move(positions.exact);
  return result;
}

}  // namespace exactcsg
