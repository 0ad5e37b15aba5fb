// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/face_loops.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>
#include <tuple>

#include "exactcsg/number/bucket_sort.hpp"
#include "exactcsg/support/error.hpp"
#include "exactcsg/support/give_up.hpp"
#include "exactcsg/support/in_parallel.hpp"

namespace exactcsg {

namespace {

using Loop = std::vector<std::uint32_t>;

[[noreturn]] void unbalanced() {
  throw Error(ErrorId::InternalError, {"a face whose boundary is not closed", ""});
}

// The loop rotated so that it starts at its smallest vertex; where that occurs several times, at
// the occurrence that makes the loop least.
void start_at_smallest(std::span<std::uint32_t> loop) {
  auto best = std::min_element(loop.begin(), loop.end());
  const std::uint32_t smallest = *best;
  const auto rotated_less = [&](auto a, auto b) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const std::uint32_t p = loop[(static_cast<std::size_t>(a - loop.begin()) + i) % loop.size()];
      const std::uint32_t q = loop[(static_cast<std::size_t>(b - loop.begin()) + i) % loop.size()];
      if (p != q) return p < q;
    }
    return false;
  };
  for (auto it = std::next(best); it != loop.end(); ++it) {
    if (*it == smallest && rotated_less(it, best)) best = it;
  }
  std::rotate(loop.begin(), best, loop.end());
}

class LoopLinker {
 public:
  LoopLinker(const Geometry& geometry, const ExactPoints& vertices, std::span<FaceEdge> edges)
      : geometry_(geometry), vertices_(vertices), edges_(edges), used_(edges.size(), false) {
    std::sort(edges_.begin(), edges_.end(), [](const FaceEdge& a, const FaceEdge& b) {
      return std::tie(a.from, a.to) < std::tie(b.from, b.to);
    });
  }

  std::vector<Loop> link() {
    std::vector<Loop> loops;
    for (std::size_t first = 0; first < edges_.size(); ++first) {
      if (used_[first]) continue;
      Loop loop;
      std::size_t edge = first;
      do {
        used_[edge] = true;
        loop.push_back(edges_[edge].from);
        edge = next(edge);
      } while (edge != first && !used_[edge]);
      if (edge != first) unbalanced();
      start_at_smallest(loop);
      loops.push_back(std::move(loop));
    }
    std::sort(loops.begin(), loops.end());
    return loops;
  }

 private:
  // Of the edges that leave where this one arrives, the first one clockwise from its reverse.
  std::size_t next(std::size_t edge) const {
    const std::uint32_t at = edges_[edge].to;
    const auto first = std::lower_bound(
        edges_.begin(), edges_.end(), at,
        [](const FaceEdge& candidate, std::uint32_t vertex) { return candidate.from < vertex; });
    if (first == edges_.end() || first->from != at) unbalanced();
    auto best = first;
    if (std::next(first) == edges_.end() || std::next(first)->from != at) {
      return static_cast<std::size_t>(best - edges_.begin());
    }
    const Vector3 back = vertices_[edges_[edge].from] - vertices_[at];
    for (auto it = std::next(first); it != edges_.end() && it->from == at; ++it) {
      if (clockwise_before(back, vertices_[it->to] - vertices_[at],
                           vertices_[best->to] - vertices_[at])) {
        best = it;
      }
    }
    return static_cast<std::size_t>(best - edges_.begin());
  }

  int turn(const Vector3& u, const Vector3& v) const {
    const OrientedPlaneRef oriented = edges_.front().plane;
    const Plane& plane = geometry_.exact_plane(oriented.plane);
    const Vector3 w = cross(u, v);
    return oriented.sense * sgn(Rational(plane.a * w.x + plane.b * w.y + plane.c * w.z));
  }

  // 0: less than half a turn clockwise from `back`, 1: half a turn, 2: more, 3: a full turn.
  int clockwise_quarter(const Vector3& back, const Vector3& v) const {
    const int side = turn(back, v);
    if (side < 0) return 0;
    if (side > 0) return 2;
    return sgn(dot(back, v)) < 0 ? 1 : 3;
  }

  bool clockwise_before(const Vector3& back, const Vector3& v, const Vector3& w) const {
    const int p = clockwise_quarter(back, v);
    const int q = clockwise_quarter(back, w);
    if (p != q) return p < q;
    return turn(v, w) < 0;
  }

  const Geometry& geometry_;
  const ExactPoints& vertices_;
  std::span<FaceEdge> edges_;
  std::vector<bool> used_;
};

// Faces with several loops or any vertices, and single ones, under one row of numbers.
class FaceRow {
 public:
  FaceRow(std::span<const BoundaryFace> linked, SingleFaces& singles)
      : linked_(linked), singles_(singles) {}

  std::size_t count() const { return linked_.size() + singles_.count(); }
  bool is_single(std::size_t face) const { return face >= linked_.size(); }
  std::size_t single(std::size_t face) const { return face - linked_.size(); }
  std::size_t loop_count(std::size_t face) const {
    return is_single(face) ? 1 : linked_[face].loops.size();
  }
  std::span<const std::uint32_t> loop(std::size_t face, std::size_t i) const {
    if (is_single(face)) return singles_.loop(single(face));
    return linked_[face].loops[i];
  }
  bool less(std::size_t face, std::size_t other) const {
    const std::size_t in_both = std::min(loop_count(face), loop_count(other));
    for (std::size_t i = 0; i < in_both; ++i) {
      const auto p = loop(face, i);
      const auto q = loop(other, i);
      if (!std::ranges::equal(p, q)) return std::ranges::lexicographical_compare(p, q);
    }
    return loop_count(face) < loop_count(other);
  }

 private:
  std::span<const BoundaryFace> linked_;
  SingleFaces& singles_;
};

// A face to be sorted, which moves in one piece.
struct FaceToSort {
  std::uint32_t smallest_vertex;
  std::uint32_t face;
};

std::vector<FaceToSort> sorted(const FaceRow& faces, std::size_t vertex_count, unsigned threads) {
  std::vector<FaceToSort> order(faces.count());
  in_parallel_parts(threads, order.size(), [&](std::size_t i) {
    order[i] = {faces.loop(i, 0).front(), static_cast<std::uint32_t>(i)};
  });
  sort_in_buckets(
      order, vertex_count, [](const FaceToSort& face) { return face.smallest_vertex; },
      [&](const FaceToSort& a, const FaceToSort& b) { return faces.less(a.face, b.face); },
      threads);
  return order;
}

void number_planes_by_first_face(std::uint32_t planes, std::vector<BoundaryFace>& faces) {
  constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> number(planes, none);
  std::uint32_t used = 0;
  for (BoundaryFace& face : faces) {
    if (number[face.plane] == none) number[face.plane] = used++;
    face.plane = number[face.plane];
  }
}

}  // namespace

void link_faces(const Geometry& geometry, std::vector<FaceEdge> edges, SingleFaces singles,
                Boundary& boundary, unsigned threads) {
  // No face lies in a wall.
  sort_in_buckets(
      edges, geometry.plane_count(), [](const FaceEdge& edge) { return edge.plane.table_index(); },
      [](const FaceEdge& a, const FaceEdge& b) {
        return std::tie(a.plane, a.face) < std::tie(b.plane, b.face);
      },
      threads);
  const auto is_new_plane = [&](std::size_t i) {
    return i == 0 || edges[i].plane != edges[i - 1].plane;
  };
  const auto is_new_face = [&](std::size_t i) {
    return is_new_plane(i) || edges[i].face != edges[i - 1].face;
  };
  const Parts linked(edges.size(), is_new_face);
  std::vector<std::vector<BoundaryFace>> faces_of_parts(linked.count());
  // How many planes begin in each part, then before it.
  std::vector<std::uint32_t> planes(linked.count() + 1, 0);
  // Whether a part begins with a new plane: not to be asked later, when the part before is sorted.
  std::vector<unsigned char> begins_plane(linked.count());
  in_parallel(threads, linked, [&](std::size_t part, std::size_t part_begin, std::size_t part_end) {
    begins_plane[part] = is_new_plane(part_begin) ? 1 : 0;
    std::uint32_t begun = 0;
    for (std::size_t i = part_begin; i < part_end; ++i) begun += is_new_plane(i) ? 1 : 0;
    planes[part + 1] = begun;
  });
  std::partial_sum(planes.begin(), planes.end(), planes.begin());
  in_parallel(threads, linked, [&](std::size_t part, std::size_t part_begin, std::size_t part_end) {
    std::uint32_t begun = planes[part];
    for (std::size_t begin = part_begin; begin < part_end;) {
      std::size_t end = begin + 1;
      while (end < part_end && !is_new_face(end)) ++end;
      const bool is_new = begin == part_begin ? begins_plane[part] != 0 : is_new_plane(begin);
      if (is_new) ++begun;
      LoopLinker linker(geometry, boundary.vertices, std::span(edges).subspan(begin, end - begin));
      faces_of_parts[part].push_back({begun - 1, linker.link()});
      begin = end;
    }
  });
  in_parallel_parts(threads, singles.count(),
                    [&](std::size_t i) { start_at_smallest(singles.loop(i)); });
  give_up(edges);
  std::vector<BoundaryFace> linked_faces = joined(threads, std::move(faces_of_parts));
  const FaceRow faces(linked_faces, singles);
  const std::vector<FaceToSort> order = sorted(faces, boundary.vertices.size(), threads);
  boundary.plane_count = planes.back() + static_cast<std::uint32_t>(singles.count());
  // Loops that are made in the order of the faces lie in it, as far as the allocator allows.
  boundary.faces.resize(order.size());
  in_parallel_parts(threads, order.size(), [&](std::size_t i) {
    const std::size_t face = order[i].face;
    BoundaryFace& result = boundary.faces[i];
    if (!faces.is_single(face)) {
      result = std::move(linked_faces[face]);
      return;
    }
    result.plane = planes.back() + static_cast<std::uint32_t>(faces.single(face));
    const auto loop = faces.loop(face, 0);
    result.loops.emplace_back(loop.begin(), loop.end());
  });
  number_planes_by_first_face(boundary.plane_count, boundary.faces);
}

}  // namespace exactcsg
