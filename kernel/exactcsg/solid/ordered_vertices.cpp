// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/ordered_vertices.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "exactcsg/solid/bucket_sort.hpp"
#include "exactcsg/solid/in_parallel.hpp"

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

struct Approximated {
  std::array<double, 3> at;
  std::uint32_t vertex;
};

// Those that are wanted, nearly in lexicographic order: points that are neighbours there are to lie
// side by side in memory, too.
std::vector<Approximated> wanted_vertices(std::span<const Vertex> vertices,
                                          std::span<const unsigned char> is_wanted,
                                          unsigned threads) {
  std::vector<Approximated> wanted;
  wanted.reserve(vertices.size());
  for (std::uint32_t v = 0; v < vertices.size(); ++v) {
    if (is_wanted[v]) wanted.push_back({{vertices[v].x, vertices[v].y, vertices[v].z}, v});
  }
  const auto x = [](const Approximated& vertex) { return vertex.at[0]; };
  const DoubleBuckets buckets(wanted, x, threads);
  sort_in_buckets(
      wanted, buckets.count(), [&](const Approximated& vertex) { return buckets.of(x(vertex)); },
      [](const Approximated& a, const Approximated& b) {
        return a.at != b.at ? a.at < b.at : a.vertex < b.vertex;
      },
      threads);
  return wanted;
}

struct Positions {
  ExactPoints exact;
  std::vector<std::array<double, 3>> nearest;
};

template <class T>
void prefetch(const T* item) {
  constexpr std::size_t cache_line = 64;
  const char* const bytes = reinterpret_cast<const char*>(item);
  for (std::size_t at = 0; at < sizeof(T); at += cache_line) __builtin_prefetch(bytes + at);
  __builtin_prefetch(bytes + sizeof(T) - 1);
}

void prefetch(const Rational& number) {
  for (const mpz_srcptr integer : {number.get_num_mpz_t(), number.get_den_mpz_t()}) {
    __builtin_prefetch(mpz_limbs_read(integer));
  }
}

// Input points lie in the order of their primitives, and their limbs elsewhere: a pass in another
// order waits for most of them unless it asks ahead, for what leads to them first.
class PointsAhead {
 public:
  PointsAhead(const Geometry& geometry, std::span<const Vertex> vertices,
              std::span<const Approximated> wanted)
      : geometry_(geometry), vertices_(vertices), wanted_(wanted) {}

  void ask_beyond(std::size_t i) const {
    constexpr std::size_t distance = 6;  // which takes longer than a line of memory to arrive
    if (i + 3 * distance < wanted_.size()) prefetch(&vertex(i + 3 * distance));
    if (i + 2 * distance < wanted_.size() && vertex(i + 2 * distance).is_point) {
      prefetch(&geometry_.approximate(vertex(i + 2 * distance).point));
      prefetch(&geometry_.point(vertex(i + 2 * distance).point));
    }
    if (i + distance < wanted_.size() && vertex(i + distance).is_point) {
      const Point3& point = geometry_.point(vertex(i + distance).point);
      for (std::size_t axis = 0; axis < 3; ++axis) prefetch(coordinate(point, axis));
    }
  }

 private:
  const Vertex& vertex(std::size_t i) const { return vertices_[wanted_[i].vertex]; }

  const Geometry& geometry_;
  std::span<const Vertex> vertices_;
  std::span<const Approximated> wanted_;
};

Positions positions_of(const Geometry& geometry, std::span<const Vertex> vertices,
                       std::span<const Approximated> wanted, unsigned threads) {
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

OrderedVertices ordered_vertices(const Geometry& geometry, std::span<const Vertex> vertices,
                                 std::span<const unsigned char> is_wanted, unsigned threads) {
  const std::vector<Approximated> wanted = wanted_vertices(vertices, is_wanted, threads);
  Positions positions = positions_of(geometry, vertices, wanted, threads);
  std::vector<std::uint32_t> order(wanted.size());
  std::iota(order.begin(), order.end(), 0U);
  LexicographicOrder(positions.nearest, positions.exact).sort(order, threads);
  OrderedVertices result;
  resize(threads, result.number, vertices.size());
  in_parallel_parts(threads, vertices.size(),
                    [&](std::size_t v) { result.number[v] = OrderedVertices::none; });
  resize(threads, result.nearest, order.size());
  in_parallel_parts(threads, order.size(), [&](std::size_t place) {
    result.number[wanted[order[place]].vertex] = static_cast<std::uint32_t>(place);
    result.nearest[place] = positions.nearest[order[place]];
  });
  positions.exact.reorder(order);
  result.exact = std::move(positions.exact);
  return result;
}

}  // namespace exactcsg
