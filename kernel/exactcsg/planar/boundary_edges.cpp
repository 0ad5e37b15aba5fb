// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/planar/boundary_edges.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <map>
#include <tuple>
#include <unordered_map>

#include "exactcsg/support/error.hpp"

namespace exactcsg::planar {

namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

std::size_t mixed(std::uint64_t a, std::uint64_t b) {
  const std::uint64_t product = (a * 0x9e3779b97f4a7c15U) ^ b;
  return static_cast<std::size_t>((product ^ product >> 29U) * 0xbf58476d1ce4e5b9U);
}

// A line meets a wall once.
struct WallCrossing {
  SegmentIndex segment;
  Wall wall;
  friend bool operator==(const WallCrossing&, const WallCrossing&) = default;
};
struct WallCrossingHash {
  std::size_t operator()(const WallCrossing& crossing) const noexcept {
    return mixed(std::bit_cast<std::uint64_t>(crossing.wall.position),
                 crossing.segment * std::uint64_t{2} + crossing.wall.axis);
  }
};

bool is_at_wall(const PieceEnd& end) { return end.kind == PieceEnd::Kind::Wall; }

class Joiner {
 public:
  Joiner(const Scene& scene, const std::vector<Piece>& pieces) : scene_(scene), pieces_(pieces) {}

  BoundaryEdges join() {
    find_next();
    vertex_of_point_.assign(scene_.point_count(), none);
    for (std::uint32_t first = 0; first < pieces_.size(); ++first) {
      if (is_at_wall(pieces_[first].start)) continue;
      std::uint32_t last = first;
      while (is_at_wall(pieces_[last].end)) last = next_[last];
      BoundaryEdge& edge = result_.edges.emplace_back();
      edge.edge = pieces_[first].edge;
      edge.way = pieces_[first].way;
      edge.from = vertex(pieces_[first].start);
      edge.to = vertex(pieces_[last].end);
    }
    return std::move(result_);
  }

 private:
  // On both sides of a wall the same line is boundary; edges with the same ends, unless a
  // coincident lower one is of a figure that the tree has lost on one side.
  void find_next() {
    next_.assign(pieces_.size(), none);
    std::unordered_map<WallCrossing, std::uint32_t, WallCrossingHash> starts;
    for (std::uint32_t i = 0; i < pieces_.size(); ++i) {
      if (!is_at_wall(pieces_[i].start)) continue;
      starts.emplace(WallCrossing{segment(pieces_[i]), pieces_[i].start.wall}, i);
    }
    std::vector<std::uint32_t> open_ends;
    for (std::uint32_t i = 0; i < pieces_.size(); ++i) {
      if (!is_at_wall(pieces_[i].end)) continue;
      const auto start = starts.find({segment(pieces_[i]), pieces_[i].end.wall});
      if (start == starts.end()) {
        open_ends.push_back(i);
      } else {
        next_[i] = start->second;
        starts.erase(start);
      }
    }
    if (open_ends.size() != starts.size()) fail();
    if (open_ends.empty()) return;
    std::vector<std::uint32_t> open_starts;
    open_starts.reserve(starts.size());
    for (const auto& [crossing, piece] : starts) open_starts.push_back(piece);
    sort(open_ends, &Piece::end);
    sort(open_starts, &Piece::start);
    for (std::size_t i = 0; i < open_ends.size(); ++i) {
      const Piece& before = pieces_[open_ends[i]];
      const Piece& after = pieces_[open_starts[i]];
      if (before.end.wall != after.start.wall ||
          order(before, before.end, after, after.start) != Sign::Zero) {
        fail();
      }
      next_[open_ends[i]] = open_starts[i];
    }
  }

  SegmentIndex segment(const Piece& piece) const { return scene_.edges()[piece.edge].segment; }

  Sign order(const Piece& a, const PieceEnd& a_end, const Piece& b, const PieceEnd& b_end) const {
    return scene_.order_at_wall(a.edge, a_end.along, b.edge, b_end.along, a_end.wall);
  }

  // By wall, and along it.
  void sort(std::vector<std::uint32_t>& indices, PieceEnd Piece::*end) const {
    std::sort(indices.begin(), indices.end(), [&](std::uint32_t i, std::uint32_t j) {
      const Piece& a = pieces_[i];
      const Piece& b = pieces_[j];
      const Wall& left = (a.*end).wall;
      const Wall& right = (b.*end).wall;
      if (left != right) {
        return std::tie(left.axis, left.position) < std::tie(right.axis, right.position);
      }
      return order(a, a.*end, b, b.*end) == Sign::Negative;
    });
  }

  [[noreturn]] static void fail() {
    throw Error(ErrorId::InternalError, {"planar pieces that do not meet at a wall", ""});
  }

  VertexIndex vertex(const PieceEnd& end) {
    VertexIndex* known = nullptr;
    VertexIndex none_yet = none;
    switch (end.kind) {
      case PieceEnd::Kind::Point:
        known = &vertex_of_point_[end.first];
        break;
      case PieceEnd::Kind::Crossing: {
        const std::uint64_t key = std::uint64_t{end.first} << 32U | end.second;
        known = &vertex_of_crossing_.try_emplace(key, none).first->second;
        break;
      }
      case PieceEnd::Kind::SharedCrossing: {
        Point2 point = exact_vertex(scene_, end);
        auto& candidates = shared_[nearest_double(point.x)];
        for (const auto& [other, index] : candidates) {
          if (other == point) return index;
        }
        known = &candidates.emplace_back(std::move(point), none).second;
        break;
      }
      case PieceEnd::Kind::Wall:
        known = &none_yet;
        break;
    }
    if (*known == none) {
      *known = static_cast<VertexIndex>(result_.vertices.size());
      result_.vertices.push_back(end);
    }
    return *known;
  }

  const Scene& scene_;
  const std::vector<Piece>& pieces_;
  std::vector<std::uint32_t> next_;  // piece beyond the wall at the end
  std::vector<VertexIndex> vertex_of_point_;
  std::unordered_map<std::uint64_t, VertexIndex> vertex_of_crossing_;
  std::map<double, std::vector<std::pair<Point2, VertexIndex>>> shared_;
  BoundaryEdges result_;
};

}  // namespace

BoundaryEdges join_pieces(const Scene& scene, const std::vector<Piece>& pieces) {
  return Joiner(scene, pieces).join();
}

Point2 exact_vertex(const Scene& scene, const PieceEnd& vertex) {
  if (vertex.kind == PieceEnd::Kind::Point) return scene.exact_point(vertex.first);
  return scene.exact_crossing(vertex.first, vertex.second);
}

}  // namespace exactcsg::planar
