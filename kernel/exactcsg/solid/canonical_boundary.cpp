// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/canonical_boundary.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <tuple>

#include "exactcsg/number/bucket_sort.hpp"
#include "exactcsg/solid/disjoint_sets.hpp"
#include "exactcsg/solid/edge_contacts.hpp"
#include "exactcsg/solid/face_loops.hpp"
#include "exactcsg/solid/in_parallel_counting.hpp"
#include "exactcsg/solid/line_interning.hpp"
#include "exactcsg/solid/line_sum.hpp"
#include "exactcsg/solid/ordered_vertices.hpp"
#include "exactcsg/solid/oriented_table_plane.hpp"
#include "exactcsg/solid/per_thread.hpp"
#include "exactcsg/solid/piece_row.hpp"
#include "exactcsg/solid/settled_facets.hpp"
#include "exactcsg/solid/vertex_interning.hpp"
#include "exactcsg/solid/vertex_row.hpp"
#include "exactcsg/support/give_up.hpp"

namespace exactcsg {

namespace {

using VertexNumber = std::uint32_t;
using LineNumber = std::uint32_t;

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

[[noreturn]] void broken(const char* what) { throw Error(ErrorId::InternalError, {what, ""}); }

// A piece's edge as the face's boundary would walk it: the piece on the left, seen from outside.
struct PieceEdge {
  PlaneRef side_plane;
  OrientedTablePlane plane;
  VertexNumber from;
  VertexNumber to;
  PieceNumber piece;
};

// Part of a line that bounds pieces of one oriented plane on one side only.
struct Segment {
  OrientedTablePlane plane;
  VertexNumber from;
  VertexNumber to;
  PieceNumber piece;
};

// The segments of one line, and the vertices on it in order: where they begin among those of all
// lines, and how many there are.
struct LineContent {
  std::uint32_t first_segment = 0;
  std::uint32_t segment_count = 0;
  std::uint32_t first_station = 0;
  std::uint32_t station_count = 0;
};

// An edge between two settled facets that other edges may touch. It is no part of a numbered line:
// no other piece lies in the plane of either.
struct TouchableEdge {
  std::uint32_t first;  // planes of the table, the lower one first
  std::uint32_t second;
  VertexNumber from;
  VertexNumber to;  // from < to
  std::uint32_t
      primitive;  // of which it is a whole edge, if nothing else of it touches that; or none
};

// The only piece in its plane.
struct SettledFace {
  OrientedTablePlane plane;
  PieceNumber piece;
  std::uint32_t first_side = 0;  // among those of all settled faces
  std::uint32_t side_count = 0;
  bool all_sides_settled = true;
};

// An edge of the result, if both ends are vertices: there pieces of two planes end, and none goes
// on.
struct SimpleEdge {
  OrientedTablePlane left;  // walked from `from` to `to`
  OrientedTablePlane right;
  PieceNumber left_piece;
  PieceNumber right_piece;
  VertexNumber from;
  VertexNumber to;
};

// A corner of a settled face, and whether the side from there to the next one is settled. The face
// is on the left, seen from outside.
struct SettledSide {
  VertexNumber from;
  bool settled;
};

class Merger {
 public:
  // Buffers are given up as soon as they are read.
  Merger(const Scene& scene, std::vector<PieceBuffer> buffers, unsigned threads, Progress* progress)
      : scene_(scene),
        geometry_(scene.geometry),
        threads_(threads),
        progress_(progress),
        settled_(settled_facets(scene, buffers, threads)),
        vertices_(geometry_),
        faces_(PieceRow(buffers).size()) {
    number_vertices(std::move(buffers));
  }

  Boundary merge() {
    sum_edges();
    check();
    mark_vertices();
    touch_edges();
    check();
    return assemble();
  }

 private:
  // Sets lines_, content_, segments_, simple_edges_ and is_vertex_ of their ends.
  void sum_edges() {
    resize(threads_, is_vertex_, vertices_.size());
    mark_settled_ends();
    const std::vector<PieceEdge> edges = edges_to_sum();
    check();
    const std::vector<LineNumber> line_of_edge = number_lines(edges);
    check();
    add_up(edges, line_of_edge);
  }

  void check() const {
    if (progress_ != nullptr) progress_->check();
  }

  // Of a piece: its vertices, and the planes of the sides from each to the next.
  struct NumberedCorners {
    std::vector<VertexNumber> vertices;
    std::vector<PlaneRef> side_planes;

    std::size_t size() const { return vertices.size(); }
    VertexNumber next(std::size_t i) const { return vertices[i + 1 == size() ? 0 : i + 1]; }
  };

  // How many entries pieces make in the arrays.
  struct PieceCounts {
    std::size_t edges = 0;
    std::size_t settled_faces = 0;
    std::size_t settled_sides = 0;
  };

  // Where the next piece makes its entries.
  struct PiecePlaces {
    PieceCounts next;
    std::vector<TouchableEdge>& touchable_edges;
  };

  // Sets vertices_, edges_, touchable_edges_, settled_faces_, settled_sides_, and of pieces
  // primitive_of_piece_ and in_general_position_.
  void number_vertices(std::vector<PieceBuffer> buffers) {
    const PieceRow pieces(buffers);
    const Parts parts(pieces.size());
    std::vector<PieceCounts> counts(parts.count());
    InternedVertices interned =
        intern(geometry_, vertices_of(pieces, parts, counts), statistics_, threads_);
    vertices_ = std::move(interned.distinct);
    for (PieceBuffer& buffer : buffers) give_up(buffer.meeting_points);
    const std::vector<PieceCounts> firsts = first_entries(counts);
    resize(threads_, edges_, firsts.back().edges);
    resize(threads_, settled_faces_, firsts.back().settled_faces);
    resize(threads_, settled_sides_, firsts.back().settled_sides);
    resize(threads_, primitive_of_piece_, pieces.size());
    resize(threads_, in_general_position_, pieces.size());
    std::vector<std::vector<TouchableEdge>> touchable_edges(parts.count());
    in_parallel(threads_, parts, [&](std::size_t part, std::size_t begin, std::size_t end) {
      check();
      PiecePlaces places{firsts[part], touchable_edges[part]};
      NumberedCorners corners;
      pieces.for_each(
          begin, end,
          [&](const PieceBuffer& buffer, std::size_t first_meeting_point,
              const BoundaryPiece& piece, PieceNumber number) {
            number_corners(buffer, piece, interned, first_meeting_point, corners);
            if (settled_.is_settled(piece)) {
              add_settled_face(piece, number, corners, places);
            } else {
              for (std::size_t i = 0; i < corners.size(); ++i) {
                add_edge(piece, number, corners, i, places);
              }
            }
            primitive_of_piece_[number] = whole_primitive_of(piece);
            in_general_position_[number] = piece.in_general_position ? 1 : 0;
            if (piece.is_hole) faces_.unite(number - 1, number);
          },
          AskForFacet{*this}, AskForCorners{scene_},
          AskForPoints<VertexNumber>{*this, interned.number_of_point});
    });
    touchable_edges_ = joined(threads_, std::move(touchable_edges));
    statistics_pieces_ = pieces.size();
  }

  // Where the entries of each part begin, and how many there are.
  static std::vector<PieceCounts> first_entries(const std::vector<PieceCounts>& counts) {
    std::vector<PieceCounts> firsts(1);
    for (const PieceCounts& count : counts) {
      const PieceCounts& first = firsts.back();
      firsts.push_back({first.edges + count.edges, first.settled_faces + count.settled_faces,
                        first.settled_sides + count.settled_sides});
    }
    return firsts;
  }

  // Pieces refer to facets all over the scene.
  struct AskForFacet {
    const Merger& merger;
    void operator()(const BoundaryPiece& piece) const {
      __builtin_prefetch(&merger.scene_.facets[piece.facet]);
      merger.settled_.prefetch(piece.plane.plane);
    }
  };
  struct AskForCorners {
    const Scene& scene;
    void operator()(const BoundaryPiece& piece) const {
      if (piece.share != facet_share::whole) return;
      const SceneFacet& facet = scene.facets[piece.facet];
      if (!facet.is_half_space) __builtin_prefetch(scene.corners.data() + facet.first_corner);
    }
  };

  // of_point: what is read of each corner, by point
  template <class OfPoint>
  struct AskForPoints {
    const Merger& merger;
    const std::vector<OfPoint>& of_point;
    void operator()(const BoundaryPiece& piece) const {
      if (piece.share != facet_share::whole) return;
      for (const PointCorner& corner : merger.corners_of_facet(piece)) {
        __builtin_prefetch(&of_point[static_cast<std::uint32_t>(corner.point)]);
        merger.settled_.prefetch(PlaneRef::of_table(corner.side_plane));
      }
    }
  };

  std::span<const PointCorner> corners_of_facet(const BoundaryPiece& piece) const {
    const SceneFacet& facet = scene_.facets[piece.facet];
    return std::span(scene_.corners).subspan(facet.first_corner, facet.corner_count);
  }

  void number_corners(const PieceBuffer& buffer, const BoundaryPiece& piece,
                      const InternedVertices& interned, std::size_t first_meeting_point,
                      NumberedCorners& result) const {
    result.vertices.clear();
    result.side_planes.clear();
    if (piece.share == facet_share::whole) {
      for (const PointCorner& corner : corners_of_facet(piece)) {
        result.vertices.push_back(
            interned.number_of_point[static_cast<std::uint32_t>(corner.point)]);
        result.side_planes.push_back(PlaneRef::of_table(corner.side_plane));
      }
      return;
    }
    for (const PieceCorner& corner : buffer.corners_of(piece)) {
      result.vertices.push_back(
          corner.is_point ? interned.number_of_point[corner.vertex]
                          : interned.number_of_meeting_point[first_meeting_point + corner.vertex]);
      result.side_planes.push_back(corner.side_plane);
    }
  }

  // Meeting points in the order of the buffers, and the points that occur. In general position, a
  // cell shares with others only what its walls make. Counts the entries of each part, too: to read
  // all pieces once more takes longer.
  CornerVertices vertices_of(const PieceRow& pieces, const Parts& parts,
                             std::vector<PieceCounts>& counts) const {
    CornerVertices result;
    resize(threads_, result.point_occurs, geometry_.point_count());
    resize(threads_, result.meeting_points, pieces.meeting_point_count());
    resize(threads_, result.meeting_point_occurs, pieces.meeting_point_count());
    in_parallel(threads_, parts, [&](std::size_t part, std::size_t begin, std::size_t end) {
      PieceCounts count;
      pieces.for_each(
          begin, end,
          [&](const PieceBuffer& buffer, std::size_t first_meeting_point,
              const BoundaryPiece& piece, PieceNumber) {
            if (piece.share == facet_share::whole) {
              add_whole_facet(piece, result, count);
            } else {
              count.edges += piece.corner_count;
              add_corners(buffer, first_meeting_point, piece, result);
            }
          },
          AskForFacet{*this}, AskForCorners{scene_},
          AskForPoints<CornerOccurrence>{*this, result.point_occurs});
      counts[part] = count;
    });
    return result;
  }

  static CornerOccurrence occurrence_in(const BoundaryPiece& piece) {
    return piece.in_general_position ? CornerOccurrence::Alone : CornerOccurrence::Some;
  }

  void add_whole_facet(const BoundaryPiece& piece, CornerVertices& result,
                       PieceCounts& count) const {
    const std::span<const PointCorner> corners = corners_of_facet(piece);
    for (const PointCorner& corner : corners) {
      note(occurrence_in(piece), result.point_occurs[static_cast<std::uint32_t>(corner.point)]);
    }
    if (!settled_.is_settled(piece)) {
      count.edges += corners.size();
      return;
    }
    ++count.settled_faces;
    count.settled_sides += corners.size();
    for (const PointCorner& corner : corners) {
      count.edges += settled_.is_settled(PlaneRef::of_table(corner.side_plane)) ? 0 : 1;
    }
  }

  static void add_corners(const PieceBuffer& buffer, std::size_t first_meeting_point,
                          const BoundaryPiece& piece, CornerVertices& result) {
    const CornerOccurrence occurrence = occurrence_in(piece);
    for (const PieceCorner& corner : buffer.corners_of(piece)) {
      if (corner.is_point) {
        note(occurrence, result.point_occurs[corner.vertex]);
      } else {
        const std::size_t place = first_meeting_point + corner.vertex;
        const Vertex& vertex = buffer.meeting_points[corner.vertex];
        note(is_on_wall(vertex) ? CornerOccurrence::Some : occurrence,
             result.meeting_point_occurs[place]);
        std::atomic_ref(result.meeting_points[place]).store(&vertex, std::memory_order_relaxed);
      }
    }
  }

  static bool is_on_wall(const Vertex& meeting_point) {
    return std::ranges::any_of(meeting_point.planes,
                               [](PlaneRef plane) { return plane.is_wall(); });
  }

  // The greatest of all that is noted; several threads may do so at once.
  static void note(CornerOccurrence occurrence, CornerOccurrence& noted) {
    const std::atomic_ref shared(noted);
    CornerOccurrence known = shared.load(std::memory_order_relaxed);
    while (known < occurrence &&
           !shared.compare_exchange_weak(known, occurrence, std::memory_order_relaxed)) {
    }
  }

  // The edge from corner i to the next.
  void add_edge(const BoundaryPiece& piece, PieceNumber number, const NumberedCorners& corners,
                std::size_t i, PiecePlaces& places) {
    VertexNumber from = corners.vertices[i];
    VertexNumber to = corners.next(i);
    if (from == to) broken("a piece of boundary with two equal corners");
    if (piece.corner_sense != piece.plane.sense) std::swap(from, to);
    edges_[places.next.edges++] = {corners.side_planes[i], piece.plane, from, to, number};
  }

  void add_settled_face(const BoundaryPiece& piece, PieceNumber number,
                        const NumberedCorners& corners, PiecePlaces& places) {
    const std::size_t count = corners.size();
    SettledFace face{piece.plane, number, static_cast<std::uint32_t>(places.next.settled_sides),
                     static_cast<std::uint32_t>(count), true};
    const auto sides = std::span(settled_sides_).subspan(face.first_side, count);
    for (std::size_t i = 0; i < count; ++i) {
      const PlaneRef side_plane = corners.side_planes[i];
      const bool settled = settled_.is_settled(side_plane);
      sides[i] = {corners.vertices[i], settled};
      if (!settled) {
        face.all_sides_settled = false;
        add_edge(piece, number, corners, i, places);
        continue;
      }
      const VertexNumber from = corners.vertices[i];
      const VertexNumber to = corners.next(i);
      if (from == to) broken("a piece of boundary with two equal corners");
      // The facet on the other side walks it from `to` to `from`.
      if (from > to || settled_.is_in_general_position(piece.plane.plane) ||
          settled_.is_in_general_position(side_plane)) {
        continue;
      }
      const auto [first, second] =
          std::minmax({piece.plane.plane.table_index(), side_plane.table_index()});
      places.touchable_edges.push_back({first, second, from, to, whole_primitive_of(piece)});
    }
    if (piece.corner_sense != piece.plane.sense) {
      // Corners and the sides between them, backwards from the same corner.
      for (std::size_t i = 0; i < count; ++i) {
        sides[i].from = corners.vertices[i == 0 ? 0 : count - i];
        sides[i].settled = settled_.is_settled(corners.side_planes[count - 1 - i]);
      }
    }
    places.next.settled_sides += count;
    settled_faces_[places.next.settled_faces++] = face;
  }

  // The primitive of which the piece is a whole facet, or none. Edges of one primitive meet in
  // vertices that end both of them, unless it is a mesh that meets itself.
  std::uint32_t whole_primitive_of(const BoundaryPiece& piece) const {
    if (piece.share != facet_share::whole) return none;
    const PrimitiveIndex primitive = scene_.facets[piece.facet].primitive;
    return scene_.primitives[primitive].meets_itself ? none : primitive;
  }

  // How far ahead edges are asked for that are read in another order than they lie in memory.
  static constexpr std::size_t edges_ahead = 16;

  static bool have_same_ends(const PieceEdge& a, const PieceEdge& b) {
    return (a.from == b.from && a.to == b.to) || (a.from == b.to && a.to == b.from);
  }

  // Edges with the same two ends become neighbours, and of these, edges of one oriented plane.
  void sort_by_ends(std::vector<PieceEdge>& edges) const {
    const auto less = [](const PieceEdge& a, const PieceEdge& b) {
      const auto [a_low, a_high] = std::minmax(a.from, a.to);
      const auto [b_low, b_high] = std::minmax(b.from, b.to);
      return std::tie(a_low, a_high, a.plane, a.from, a.piece, a.side_plane) <
             std::tie(b_low, b_high, b.plane, b.from, b.piece, b.side_plane);
    };
    sort_in_buckets(
        edges, vertices_.size(),
        [](const PieceEdge& edge) { return std::size_t{std::min(edge.from, edge.to)}; }, less,
        threads_);
  }

  // Of most edges of pieces nothing needs to be summed up along lines: seams, which have the same
  // two ends on both sides, cancel, and where pieces in two planes have one edge in common, that is
  // an edge of the result. The others are returned.
  std::vector<PieceEdge> edges_to_sum() {
    sort_by_ends(edges_);
    const Parts parts(edges_.size(),
                      [&](std::size_t i) { return !have_same_ends(edges_[i], edges_[i - 1]); });
    std::vector<std::vector<PieceEdge>> left(parts.count());
    std::vector<std::vector<SimpleEdge>> simple(parts.count());
    in_parallel(threads_, parts, [&](std::size_t part, std::size_t begin, std::size_t end) {
      check();
      for (std::size_t i = begin; i < end;) {
        std::size_t group_end = i + 1;
        while (group_end < end && have_same_ends(edges_[group_end], edges_[i])) ++group_end;
        sort_out(std::span(edges_).subspan(i, group_end - i), left[part], simple[part]);
        i = group_end;
      }
    });
    give_up(edges_);
    mark_ends(simple);
    in_parallel(threads_, simple.size(), [&](std::size_t part) {
      std::erase_if(simple[part], [&](const SimpleEdge& edge) {
        if (is_vertex_[edge.from] && is_vertex_[edge.to]) return false;
        left[part].push_back({edge.right.plane(), edge.left, edge.from, edge.to, edge.left_piece});
        left[part].push_back({edge.left.plane(), edge.right, edge.to, edge.from, edge.right_piece});
        return true;
      });
    });
    simple_edges_ = joined(threads_, std::move(simple));
    return joined(threads_, std::move(left));
  }

  // Of edges with the same two ends.
  void sort_out(std::span<const PieceEdge> group, std::vector<PieceEdge>& left,
                std::vector<SimpleEdge>& simple) {
    if (group.size() == 2) {
      const PieceEdge& a = group[0];
      const PieceEdge& b = group[1];
      if (is_simple(a, b)) {
        simple.push_back({a.plane, b.plane, a.piece, b.piece, a.from, a.to});
        return;
      }
    }
    for (std::size_t i = 0; i < group.size(); ++i) {
      const PieceEdge& edge = group[i];
      if (i + 1 < group.size()) {
        const PieceEdge& other = group[i + 1];
        if (other.plane == edge.plane) {
          if (other.from == edge.from) broken("two pieces of boundary that overlap");
          faces_.unite(edge.piece, other.piece);
          ++i;
          continue;
        }
      }
      left.push_back(edge);
    }
  }

  // Of two edges with the same ends. In general position no other edge is on this stretch of the
  // line: the surface turns from the one plane to the other here.
  bool is_simple(const PieceEdge& a, const PieceEdge& b) const {
    return a.plane.plane() == b.side_plane && b.plane.plane() == a.side_plane && a.from == b.to &&
           in_general_position_[a.piece] && in_general_position_[b.piece];
  }

  // The facets on both sides have edges of other directions there.
  void mark_settled_ends() {
    in_parallel_parts(threads_, settled_faces_.size(), [&](std::size_t i) {
      const std::span<const SettledSide> sides = sides_of(settled_faces_[i]);
      for (std::size_t side = 0; side < sides.size(); ++side) {
        if (!sides[side].settled) continue;
        set_mark(is_vertex_[sides[side].from]);
        set_mark(is_vertex_[end_of(sides, side)]);
      }
    });
  }

  std::span<const SettledSide> sides_of(const SettledFace& face) const {
    return std::span(settled_sides_).subspan(face.first_side, face.side_count);
  }
  static VertexNumber end_of(std::span<const SettledSide> sides, std::size_t side) {
    return sides[side + 1 == sides.size() ? 0 : side + 1].from;
  }

  // Two lines are different if other planes meet in them, in general position: an end of two of
  // them is a vertex.
  void mark_ends(const std::vector<std::vector<SimpleEdge>>& simple) {
    constexpr std::uint64_t unknown = std::numeric_limits<std::uint64_t>::max();
    std::vector<std::uint64_t> some_line(vertices_.size(), unknown);
    in_parallel(threads_, simple.size(), [&](std::size_t part) {
      for (std::size_t i = 0; i < simple[part].size(); ++i) {
        const SimpleEdge& edge = simple[part][i];
        if (i + edges_ahead < simple[part].size()) {
          __builtin_prefetch(&some_line[simple[part][i + edges_ahead].from], 1);
          __builtin_prefetch(&some_line[simple[part][i + edges_ahead].to], 1);
        }
        const auto [first, second] =
            std::minmax({edge.left.table_index(), edge.right.table_index()});
        const std::uint64_t line = std::uint64_t{first} << 32U | second;
        for (const VertexNumber vertex : {edge.from, edge.to}) {
          std::uint64_t known = unknown;
          // Whichever line comes first, the second one marks the vertex.
          if (!std::atomic_ref(some_line[vertex])
                   .compare_exchange_strong(known, line, std::memory_order_relaxed) &&
              known != line) {
            set_mark(is_vertex_[vertex]);
          }
        }
      }
    });
  }

  std::vector<LineNumber> number_lines(const std::vector<PieceEdge>& edges) {
    struct Keyed {
      PlaneRef first;
      PlaneRef second;
      std::uint32_t edge;
    };
    std::vector<Keyed> order(edges.size());
    in_parallel_parts(threads_, edges.size(), [&](std::size_t i) {
      const auto [first, second] = std::minmax({edges[i].plane.plane(), edges[i].side_plane});
      order[i] = {first, second, static_cast<std::uint32_t>(i)};
    });
    // By the first plane, so that neighbours lie side by side, but a plane may have most of the
    // edges: those of one plane are spread over some buckets by the second plane. Walls are rare
    // and count as one plane.
    constexpr unsigned spread_bits = 10;
    const std::size_t planes = geometry_.plane_count() + 1;
    const auto bucket_of = [planes, count = edges.size()](const Keyed& keyed) {
      const std::size_t first = keyed.first.is_wall() ? planes - 1 : keyed.first.table_index();
      const std::uint64_t hash = keyed.second.bits() * 0x9e3779b97f4a7c15U;
      return first * count / planes + (hash >> (64U - spread_bits));
    };
    const auto less = [](const Keyed& a, const Keyed& b) {
      if (a.first != b.first) return a.first < b.first;
      if (a.second != b.second) return a.second < b.second;
      return a.edge < b.edge;
    };
    sort_in_buckets(order, edges.size() + (std::size_t{1} << spread_bits), bucket_of, less,
                    threads_);
    const auto is_first = [&](std::size_t i) {
      return i == 0 || order[i].first != order[i - 1].first ||
             order[i].second != order[i - 1].second;
    };
    const Parts parts(order.size());
    std::vector<std::size_t> first_sample(parts.count() + 1, 0);
    in_parallel(threads_, parts, [&](std::size_t part, std::size_t begin, std::size_t end) {
      std::size_t count = 0;
      for (std::size_t i = begin; i < end; ++i) count += is_first(i) ? 1 : 0;
      first_sample[part + 1] = count;
    });
    std::partial_sum(first_sample.begin(), first_sample.end(), first_sample.begin());
    std::vector<LineSample> samples(first_sample.back());
    std::vector<std::uint32_t> sample_of_edge(edges.size());
    const std::vector<unsigned char> touched = ends_beside_chance(edges);
    std::vector<unsigned char> may_coincide(samples.size(), 0);
    in_parallel(threads_, parts, [&](std::size_t part, std::size_t begin, std::size_t end) {
      std::size_t next = first_sample[part];
      for (std::size_t i = begin; i < end; ++i) {
        if (i + edges_ahead < end) __builtin_prefetch(&edges[order[i + edges_ahead].edge]);
        if (is_first(i)) {
          const PieceEdge& edge = edges[order[i].edge];
          samples[next++] = {order[i].first, order[i].second, edge.from, edge.to};
        }
        sample_of_edge[order[i].edge] = static_cast<std::uint32_t>(next - 1);
        const PieceEdge& edge = edges[order[i].edge];
        if (touched[edge.from] || touched[edge.to]) set_mark(may_coincide[next - 1]);
      }
    });
    check();
    const std::vector<LineNumber> number = intern_lines(samples, may_coincide);
    std::vector<LineNumber> result(edges.size());
    in_parallel_parts(threads_, edges.size(),
                      [&](std::size_t i) { result[i] = number[sample_of_edge[i]]; });
    return result;
  }

  // By vertex: where edges end that are not in general position. A cell may have cut along a line
  // in other planes than its neighbour.
  std::vector<unsigned char> ends_beside_chance(const std::vector<PieceEdge>& edges) const {
    std::vector<unsigned char> result(vertices_.size(), 0);
    in_parallel_parts(threads_, edges.size(), [&](std::size_t i) {
      if (in_general_position_[edges[i].piece]) return;
      set_mark(result[edges[i].from]);
      set_mark(result[edges[i].to]);
    });
    return result;
  }

  // Sets lines_. Lines of different planes that do not coincide with others in general position get
  // a number of their own.
  std::vector<LineNumber> intern_lines(const std::vector<LineSample>& samples,
                                       const std::vector<unsigned char>& may_coincide) {
    std::vector<LineSample> some;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (may_coincide[i]) some.push_back(samples[i]);
    }
    InternedLines interned = intern(geometry_, vertices_, some, statistics_, threads_);
    lines_ = std::move(interned.distinct);
    std::vector<LineNumber> number(samples.size());
    auto next_of_some = interned.number.begin();
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (may_coincide[i]) {
        number[i] = *next_of_some++;
      } else {
        number[i] = static_cast<LineNumber>(lines_.size());
        lines_.push_back(samples[i]);
      }
    }
    return number;
  }

  // Vertices of one line in the order of their position on it, from either end.
  void sort_along(LineNumber line, std::vector<VertexNumber>& stations,
                  TierStatistics& statistics) const {
    std::sort(stations.begin(), stations.end());
    stations.erase(std::unique(stations.begin(), stations.end()), stations.end());
    if (stations.size() <= 2) return;  // as most lines have it
    // They lie anywhere: all of them are asked for before one is waited for.
    for (const VertexNumber vertex : stations) vertices_.prefetch(vertex);
    const std::optional<Axis> axis = axis_along(geometry_, lines_[line]);
    std::sort(stations.begin(), stations.end(), [&](VertexNumber a, VertexNumber b) {
      if (a == b) return false;
      const Vertex v = vertices_[a];
      const Vertex w = vertices_[b];
      if (axis) return geometry_.compare_coordinate(v, w, *axis, statistics) == Sign::Negative;
      return geometry_.compare_position(v, w, statistics) < 0;
    });
  }

  // Sorted by line, then by oriented plane, then by number.
  std::vector<std::uint32_t> edges_by_line(const std::vector<PieceEdge>& edges,
                                           const std::vector<LineNumber>& line_of_edge) const {
    std::vector<std::uint32_t> order(edges.size());
    std::iota(order.begin(), order.end(), 0U);
    sort_in_buckets(
        order, lines_.size(), [&](std::uint32_t i) { return line_of_edge[i]; },
        [&](std::uint32_t a, std::uint32_t b) {
          if (edges[a].plane != edges[b].plane) return edges[a].plane < edges[b].plane;
          return a < b;
        },
        threads_);
    return order;
  }

  void add_up(const std::vector<PieceEdge>& edges, const std::vector<LineNumber>& line_of_edge) {
    const std::vector<std::uint32_t> order = edges_by_line(edges, line_of_edge);
    content_.resize(lines_.size());
    const auto line_at = [&](std::size_t i) { return line_of_edge[order[i]]; };
    const Parts parts(order.size(), [&](std::size_t i) { return line_at(i) != line_at(i - 1); });
    std::vector<std::vector<Segment>> segments(parts.count());
    in_parallel_counting(
        threads_, parts, statistics_,
        [&](std::size_t part, std::size_t part_begin, std::size_t part_end, TierStatistics& tiers) {
          check();
          segments[part].reserve(part_end - part_begin);
          std::vector<std::uint32_t>& rank = ranks();
          std::vector<VertexNumber> stations;
          std::vector<LineEvent> events;
          for (std::size_t begin = part_begin; begin < part_end;) {
            const LineNumber line = line_at(begin);
            std::size_t end = begin;
            for (; end < part_end && line_at(end) == line; ++end) {
              if (end + edges_ahead >= part_end) continue;
              __builtin_prefetch(&edges[order[end + edges_ahead]]);
              __builtin_prefetch(&line_of_edge[order[end + edges_ahead]]);
            }
            const auto rank_stations = [&] {
              stations.clear();
              for (std::size_t i = begin; i < end; ++i) {
                stations.push_back(edges[order[i]].from);
                stations.push_back(edges[order[i]].to);
              }
              sort_along(line, stations, tiers);
              for (std::uint32_t i = 0; i < stations.size(); ++i) rank[stations[i]] = i;
            };
            bool is_ranked = false;
            content_[line].first_segment = static_cast<std::uint32_t>(segments[part].size());
            for (std::size_t group = begin; group < end;) {
              std::size_t group_end = group;
              while (group_end < end &&
                     edges[order[group_end]].plane == edges[order[group]].plane) {
                ++group_end;
              }
              // A single edge is not added to anything.
              if (group_end - group > 1 && !is_ranked) {
                rank_stations();
                is_ranked = true;
              }
              add_up_on_plane(edges, std::span(order).subspan(group, group_end - group), stations,
                              rank, events, segments[part]);
              group = group_end;
            }
            content_[line].segment_count =
                static_cast<std::uint32_t>(segments[part].size()) - content_[line].first_segment;
            begin = end;
          }
        });
    // Every line has an edge, so that those of one part follow each other.
    const std::vector<std::size_t> firsts = first_places(segments);
    in_parallel(threads_, parts, [&](std::size_t part, std::size_t begin, std::size_t end) {
      for (LineNumber line = line_at(begin); line <= line_at(end - 1); ++line) {
        content_[line].first_segment += static_cast<std::uint32_t>(firsts[part]);
      }
    });
    segments_ = joined(threads_, std::move(segments));
  }

  // Room for a number of each vertex.
  std::vector<std::uint32_t>& ranks() {
    std::vector<std::uint32_t>& result = ranks_.local();
    result.resize(vertices_.size());
    return result;
  }

  void add_up_on_plane(const std::vector<PieceEdge>& edges, std::span<const std::uint32_t> group,
                       const std::vector<VertexNumber>& stations,
                       const std::vector<std::uint32_t>& rank, std::vector<LineEvent>& events,
                       std::vector<Segment>& result) {
    if (group.size() == 1) {
      const PieceEdge& edge = edges[group[0]];
      result.push_back({edge.plane, edge.from, edge.to, edge.piece});
      return;
    }
    events.clear();
    for (const std::uint32_t i : group) {
      add_events(rank[edges[i].from], rank[edges[i].to], edges[i].piece, events);
    }
    const OrientedTablePlane plane = edges[group[0]].plane;
    sum_along_line(events,
                   [&](const auto& left, const auto& right, std::uint32_t low, std::uint32_t high) {
                     if (left && right) {
                       faces_.unite(*left, *right);
                     } else if (left) {
                       result.push_back({plane, stations[low], stations[high], *left});
                     } else {
                       result.push_back({plane, stations[high], stations[low], *right});
                     }
                   });
  }

  // A vertex is where segments of two or more lines end.
  void mark_vertices() {
    std::vector<LineNumber> some_line(vertices_.size(), none);
    const Parts parts(content_.size());
    std::vector<std::vector<VertexNumber>> stations(parts.count());
    in_parallel_counting(
        threads_, parts, statistics_,
        [&](std::size_t part, std::size_t begin, std::size_t end, TierStatistics& tiers) {
          std::vector<VertexNumber> on_line;
          for (auto line = static_cast<LineNumber>(begin); line < end; ++line) {
            on_line.clear();
            const LineContent& content = content_[line];
            for (std::size_t i = 0; i < content.segment_count; ++i) {
              const std::size_t place = content.first_segment + i;
              const Segment& segment = segments_[place];
              if (place + edges_ahead < segments_.size()) {
                ask_for_ends(segments_[place + edges_ahead], some_line);
              }
              for (const VertexNumber vertex : {segment.from, segment.to}) {
                LineNumber known = none;
                // Whichever line comes first, the second one marks the vertex.
                if (!std::atomic_ref(some_line[vertex])
                         .compare_exchange_strong(known, line, std::memory_order_relaxed) &&
                    known != line) {
                  set_mark(is_vertex_[vertex]);
                }
                on_line.push_back(vertex);
              }
            }
            sort_along(line, on_line, tiers);
            add_stations(line, on_line, stations[part]);
          }
        });
    const std::vector<std::size_t> firsts = first_places(stations);
    in_parallel(threads_, parts, [&](std::size_t part, std::size_t begin, std::size_t end) {
      for (std::size_t line = begin; line < end; ++line) {
        content_[line].first_station += static_cast<std::uint32_t>(firsts[part]);
      }
    });
    stations_ = joined(threads_, std::move(stations));
  }

  // Asks for what marking the ends as vertices reads, and sorting them along the line.
  void ask_for_ends(const Segment& segment, const std::vector<LineNumber>& some_line) const {
    for (const VertexNumber vertex : {segment.from, segment.to}) {
      __builtin_prefetch(&some_line[vertex], 1);
      vertices_.prefetch_place(vertex);
    }
  }

  std::span<const Segment> segments_of(LineNumber line) const {
    return std::span(segments_).subspan(content_[line].first_segment, content_[line].segment_count);
  }

  // Of the lines from `begin` to `end`, of which there is one at least.
  std::size_t segment_count(std::size_t begin, std::size_t end) const {
    const LineContent& last = content_[end - 1];
    return last.first_segment + last.segment_count - content_[begin].first_segment;
  }

  std::span<const VertexNumber> stations_of(LineNumber line) const {
    return std::span(stations_).subspan(content_[line].first_station, content_[line].station_count);
  }

  // Of one line in order, appended to those of others.
  void add_stations(LineNumber line, const std::vector<VertexNumber>& stations,
                    std::vector<VertexNumber>& all) {
    content_[line].first_station = static_cast<std::uint32_t>(all.size());
    content_[line].station_count = static_cast<std::uint32_t>(stations.size());
    all.insert(all.end(), stations.begin(), stations.end());
  }

  // The parts of a line between neighbouring vertices that some segment covers, and edges between
  // settled facets, edge i of them with the line's number lines_.size() + i; only what may be
  // touched.
  std::vector<EdgeSpan> spans() {
    const Parts lines(content_.size());
    const Parts settled(touchable_edges_.size());
    std::vector<std::vector<EdgeSpan>> result(lines.count() + settled.count());
    in_parallel(threads_, lines, [&](std::size_t part, std::size_t begin, std::size_t end) {
      std::vector<std::uint32_t>& rank = ranks();
      result[part].reserve(segment_count(begin, end));
      for (auto line = static_cast<LineNumber>(begin); line < end; ++line) {
        add_spans(line, rank, result[part]);
      }
    });
    in_parallel(threads_, settled, [&](std::size_t part, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const TouchableEdge& edge = touchable_edges_[i];
        result[lines.count() + part].push_back(
            {{PlaneRef::of_table(edge.first), PlaneRef::of_table(edge.second)},
             static_cast<LineNumber>(lines_.size() + i),
             edge.from,
             edge.to,
             edge.primitive});
      }
    });
    return joined(threads_, std::move(result));
  }

  void add_spans(LineNumber line, std::vector<std::uint32_t>& rank, std::vector<EdgeSpan>& result) {
    const auto first = static_cast<std::ptrdiff_t>(result.size());
    const std::array<PlaneRef, 2> planes{lines_[line].first, lines_[line].second};
    for_each_run(line, rank, [&](const Run& run) {
      if (run.in_general_position) return;
      const auto [low, high] = std::minmax(run.from, run.to);
      result.push_back({planes, line, low, high, run.primitive});
    });
    // Any of the primitives will do; `none` sorts last.
    const auto key = [](const EdgeSpan& span) {
      return std::tuple(span.from, span.to, span.primitive);
    };
    std::ranges::sort(result.begin() + first, result.end(), {}, key);
    const auto same_ends = [](const EdgeSpan& a, const EdgeSpan& b) {
      return a.from == b.from && a.to == b.to;
    };
    result.erase(std::unique(result.begin() + first, result.end(), same_ends), result.end());
  }

  bool is_settled(const EdgeSpan& span) const { return span.line >= lines_.size(); }

  // Segments of one oriented plane, joined where they continue one another and cut at vertices.
  struct Run {
    const Segment& owner;
    VertexNumber from;
    VertexNumber to;
    std::uint32_t primitive;   // of all its segments, or none
    bool in_general_position;  // all of it
  };

  // visit(run)
  template <class Visit>
  void for_each_run(LineNumber line, std::vector<std::uint32_t>& rank, Visit visit) const {
    const std::span<const Segment> segments = segments_of(line);
    if (segments.empty()) return;
    const std::span<const VertexNumber> stations = stations_of(line);
    if (segments.size() == 1 && stations.size() == 2) {
      // As most lines have it: nothing to join or to cut.
      const Segment& segment = segments.front();
      if (!is_vertex_[segment.from] || !is_vertex_[segment.to]) {
        broken("an edge that does not end at its vertex");
      }
      visit(Run{segment, segment.from, segment.to, primitive_of_piece_[segment.piece],
                in_general_position_[segment.piece] != 0});
      return;
    }
    for (std::uint32_t i = 0; i < stations.size(); ++i) rank[stations[i]] = i;
    for (std::size_t begin = 0; begin < segments.size();) {
      std::size_t end = begin;
      while (end < segments.size() && segments[end].plane == segments[begin].plane) ++end;
      run_along(segments.subspan(begin, end - begin), stations, rank, visit);
      begin = end;
    }
  }

  // The segments of one plane are ascending along the line and do not overlap.
  template <class Visit>
  void run_along(std::span<const Segment> segments, std::span<const VertexNumber> stations,
                 const std::vector<std::uint32_t>& rank, Visit& visit) const {
    std::uint32_t start = none;  // rank where the present run began
    bool forward = true;
    const Segment* owner = nullptr;
    std::uint32_t primitive = none;
    bool general = true;
    for (const Segment& segment : segments) {
      const std::uint32_t primitive_here = primitive_of_piece_[segment.piece];
      const bool general_here = in_general_position_[segment.piece] != 0;
      const auto [low, high] = std::minmax(rank[segment.from], rank[segment.to]);
      const bool goes_forward = rank[segment.from] < rank[segment.to];
      if (is_vertex_[stations[low]]) {
        if (start != none) broken("an edge that does not end at its vertex");
        start = low;
        forward = goes_forward;
        owner = &segment;
        primitive = primitive_here;
        general = general_here;
      }
      if (primitive != primitive_here) primitive = none;
      general = general && general_here;
      if (start == none || forward != goes_forward)
        broken("an edge that ends where there is no vertex");
      for (std::uint32_t r = low + 1; r <= high; ++r) {
        if (!is_vertex_[stations[r]]) continue;
        const VertexNumber a = stations[start];
        const VertexNumber b = stations[r];
        visit(Run{*owner, forward ? a : b, forward ? b : a, primitive, general});
        start = r;
        owner = &segment;
        primitive = primitive_here;
        general = general_here;
      }
      // Ends in a vertex: the run is over unless the next segment goes on from here.
      if (start == high) start = none;
    }
    if (start != none) broken("an edge that ends where there is no vertex");
  }

  // Edges that only touch: a vertex on another edge, or two edges that cross. Edges of one
  // primitive need not be looked at.
  void touch_edges() {
    std::vector<EdgeSpan> all = spans();
    sort_by_primitive(all);
    const std::vector<EdgeContact> contacts =
        edge_contacts(geometry_, vertices_, all, statistics_, threads_, progress_);
    set_contacts(all, contacts);
    for (auto& [line, touching] : touching_) {
      const std::span<const VertexNumber> stations = stations_of(line);
      touching.insert(touching.end(), stations.begin(), stations.end());
      sort_along(line, touching, statistics_);
      add_stations(line, touching, stations_);
    }
    for (auto& [edge, cuts] : cuts_) sort_from(edge[0], edge[1], cuts);
  }

  // Those of no primitive last.
  void sort_by_primitive(std::vector<EdgeSpan>& spans) const {
    const std::size_t primitives = scene_.primitives.size();
    const std::size_t lines = lines_.size() + touchable_edges_.size();
    const std::size_t buckets_of_lines = std::max<std::size_t>(1, spans.size() / 2);
    const auto bucket_of = [=](const EdgeSpan& span) {
      if (span.primitive != none) return std::size_t{span.primitive};
      return primitives + span.line * buckets_of_lines / lines;
    };
    sort_in_buckets(
        spans, primitives + buckets_of_lines, bucket_of,
        [](const EdgeSpan& a, const EdgeSpan& b) {
          return std::tie(a.line, a.from, a.to) < std::tie(b.line, b.from, b.to);
        },
        threads_);
  }

  // Points between two others, each once, in the order in which one goes from the first to the
  // last.
  void sort_from(VertexNumber first, VertexNumber last, std::vector<VertexNumber>& between) {
    std::sort(between.begin(), between.end());
    between.erase(std::unique(between.begin(), between.end()), between.end());
    const bool ascending =
        geometry_.compare_position(vertices_[first], vertices_[last], statistics_) < 0;
    std::sort(between.begin(), between.end(), [&](VertexNumber a, VertexNumber b) {
      if (!ascending) std::swap(a, b);
      return geometry_.compare_position(vertices_[a], vertices_[b], statistics_) < 0;
    });
  }

  // States that a vertex lies on a span.
  void add_station(const EdgeSpan& span, VertexNumber vertex) {
    if (!is_settled(span)) {
      touching_[span.line].push_back(vertex);
    } else if (vertex != span.from && vertex != span.to) {
      cuts_[{span.from, span.to}].push_back(vertex);
    }
  }

  void set_contacts(std::span<const EdgeSpan> spans, std::span<const EdgeContact> contacts) {
    const std::vector<VertexNumber> numbers = numbers_of(contacts);
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      is_vertex_[numbers[i]] = 1;
      add_station(spans[contacts[i].a], numbers[i]);
      add_station(spans[contacts[i].b], numbers[i]);
    }
  }

  // Of the points of contact. One in the middle of two edges may be a station of a line that was no
  // vertex so far; or it is a new one.
  std::vector<VertexNumber> numbers_of(std::span<const EdgeContact> contacts) {
    std::vector<VertexNumber> result(contacts.size(), none);
    VertexRow middles(geometry_);
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      if (contacts[i].end) {
        result[i] = *contacts[i].end;
      } else {
        middles.push_back(contacts[i].point);
      }
    }
    if (middles.empty()) return result;
    const VertexFinder known(geometry_, vertices_);
    const VertexFinder equals(geometry_, middles);
    std::vector<VertexNumber> number(middles.size(), none);  // of those that equals finds
    std::size_t next = 0;
    for (VertexNumber& wanted : result) {
      if (wanted != none) continue;
      const Vertex point = middles[next++];
      VertexNumber& here = number[*equals.find(point, middles, statistics_)];
      if (here == none) {
        here = known.find(point, vertices_, statistics_)
                   .value_or(static_cast<VertexNumber>(vertices_.size()));
      }
      if (here == vertices_.size()) {
        vertices_.push_back(point);
        is_vertex_.push_back(0);
      }
      wanted = here;
    }
    return result;
  }

  // A settled edge as one walks it from one end to the other, which is left out.
  template <class Visit>
  void for_each_part(VertexNumber from, VertexNumber to, Visit visit) const {
    const auto cut =
        cuts_.empty() ? cuts_.end() : cuts_.find({std::min(from, to), std::max(from, to)});
    VertexNumber last = from;
    const auto go_to = [&](VertexNumber next) {
      visit(last, next);
      last = next;
    };
    if (cut != cuts_.end()) {
      if (from < to) {
        std::for_each(cut->second.begin(), cut->second.end(), go_to);
      } else {
        std::for_each(cut->second.rbegin(), cut->second.rend(), go_to);
      }
    }
    go_to(to);
  }

  // The loops of settled faces; those with sides that are not settled are left to `edges`.
  void add_single_faces(std::size_t begin, std::size_t end, std::vector<FaceEdge>& edges,
                        SingleFaces& result) const {
    if (begin < end) {
      result.ends.reserve(end - begin);
      const SettledFace& last = settled_faces_[end - 1];
      result.vertices.reserve(last.first_side + last.side_count - settled_faces_[begin].first_side);
    }
    for (const SettledFace& face : std::span(settled_faces_).subspan(begin, end - begin)) {
      const std::span<const SettledSide> sides = sides_of(face);
      const auto for_each_settled_part = [&](const auto& visit) {
        for (std::size_t i = 0; i < sides.size(); ++i) {
          if (!sides[i].settled) continue;
          for_each_part(sides[i].from, end_of(sides, i), visit);
        }
      };
      if (!face.all_sides_settled) {
        for_each_settled_part([&](VertexNumber from, VertexNumber to) {
          edges.push_back({face.plane, face.piece, from, to});
        });
        continue;
      }
      for_each_settled_part(
          [&](VertexNumber from, VertexNumber) { result.vertices.push_back(from); });
      result.ends.push_back(static_cast<std::uint32_t>(result.vertices.size()));
    }
  }

  SingleFaces joined_faces(std::vector<SingleFaces> parts) const {
    std::vector<std::vector<VertexNumber>> vertices;
    std::vector<std::vector<std::uint32_t>> ends;
    std::uint32_t first = 0;
    for (SingleFaces& part : parts) {
      for (std::uint32_t& end : part.ends) end += first;
      first += static_cast<std::uint32_t>(part.vertices.size());
      vertices.push_back(std::move(part.vertices));
      ends.push_back(std::move(part.ends));
    }
    return {joined(threads_, std::move(vertices)), joined(threads_, std::move(ends))};
  }

  // Edges of all faces that are no single ones, and those.
  struct FaceParts {
    std::vector<FaceEdge> edges;
    SingleFaces singles;
  };

  void ask_for_piece(PieceNumber piece) const {
    faces_.prefetch(piece);
    __builtin_prefetch(&primitive_of_piece_[piece]);
    __builtin_prefetch(&in_general_position_[piece]);
  }

  // Gives up what is known of lines: their memory is wanted for the result.
  FaceParts face_parts() {
    const Parts lines(content_.size());
    const Parts simple(simple_edges_.size());
    const Parts settled(settled_faces_.size());
    const std::size_t first_settled = lines.count() + simple.count();
    std::vector<std::vector<FaceEdge>> edges(first_settled + settled.count());
    std::vector<SingleFaces> singles(settled.count());
    in_parallel(threads_, lines, [&](std::size_t part, std::size_t begin, std::size_t end) {
      std::vector<std::uint32_t>& rank = ranks();
      edges[part].reserve(segment_count(begin, end));
      for (auto line = static_cast<LineNumber>(begin); line < end; ++line) {
        for (std::size_t i = 0; i < content_[line].segment_count; ++i) {
          const std::size_t ahead = content_[line].first_segment + i + edges_ahead;
          if (ahead < segments_.size()) ask_for_piece(segments_[ahead].piece);
        }
        for_each_run(line, rank, [&](const Run& run) {
          edges[part].push_back({run.owner.plane, faces_.find(run.owner.piece), run.from, run.to});
        });
      }
    });
    give_up(content_);
    give_up(segments_);
    give_up(stations_);
    give_up(lines_);
    give_up(primitive_of_piece_);
    give_up(in_general_position_);
    in_parallel(threads_, simple, [&](std::size_t part, std::size_t begin, std::size_t end) {
      std::vector<FaceEdge>& result = edges[lines.count() + part];
      result.reserve(2 * (end - begin));
      for (std::size_t i = begin; i < end; ++i) {
        const SimpleEdge& edge = simple_edges_[i];
        if (i + edges_ahead < end) {
          faces_.prefetch(simple_edges_[i + edges_ahead].left_piece);
          faces_.prefetch(simple_edges_[i + edges_ahead].right_piece);
        }
        result.push_back({edge.left, faces_.find(edge.left_piece), edge.from, edge.to});
        result.push_back({edge.right, faces_.find(edge.right_piece), edge.to, edge.from});
      }
    });
    in_parallel(threads_, settled, [&](std::size_t part, std::size_t begin, std::size_t end) {
      add_single_faces(begin, end, edges[first_settled + part], singles[part]);
    });
    give_up(simple_edges_);
    give_up(touchable_edges_);
    give_up(settled_faces_);
    give_up(settled_sides_);
    FaceParts result;
    result.edges = joined(threads_, std::move(edges));
    result.singles = joined_faces(std::move(singles));
    return result;
  }

  Boundary assemble() {
    FaceParts faces = face_parts();
    Boundary boundary;
    OrderedVertices ordered = ordered_vertices(geometry_, vertices_, is_vertex_, threads_);
    boundary.vertices = std::move(ordered.exact);
    boundary.approximate = std::move(ordered.nearest);
    const std::vector<VertexNumber>& renumbered = ordered.number;
    vertices_ = VertexRow(geometry_);
    check();
    in_parallel_parts(threads_, faces.edges.size(), [&](std::size_t i) {
      FaceEdge& edge = faces.edges[i];
      edge.from = renumbered[edge.from];
      edge.to = renumbered[edge.to];
    });
    in_parallel_parts(threads_, faces.singles.vertices.size(), [&](std::size_t i) {
      VertexNumber& vertex = faces.singles.vertices[i];
      vertex = renumbered[vertex];
    });
    set_edges(faces, boundary);
    link_faces(geometry_, std::move(faces.edges), std::move(faces.singles), boundary, threads_);
    boundary.statistics.pieces = statistics_pieces_;
    boundary.statistics.tiers = statistics_;
    return boundary;
  }

  // Every edge is walked in either direction (LAW boundary.3).
  void set_edges(const FaceParts& faces, Boundary& boundary) {
    const auto add = [](VertexNumber from, VertexNumber to, std::vector<BoundaryEdge>& result) {
      if (from < to) result.push_back({from, to});
    };
    const Parts walked(faces.edges.size());
    const Parts singles(faces.singles.ends.size());
    std::vector<std::vector<BoundaryEdge>> edges(walked.count() + singles.count());
    in_parallel(threads_, walked, [&](std::size_t part, std::size_t begin, std::size_t end) {
      edges[part].reserve((end - begin) / 2);
      for (std::size_t i = begin; i < end; ++i) {
        add(faces.edges[i].from, faces.edges[i].to, edges[part]);
      }
    });
    in_parallel(threads_, singles, [&](std::size_t part, std::size_t begin, std::size_t end) {
      std::vector<BoundaryEdge>& result = edges[walked.count() + part];
      if (begin < end) {
        result.reserve((faces.singles.ends[end - 1] - faces.singles.begin(begin)) / 2);
      }
      for (std::size_t face = begin; face < end; ++face) {
        const std::span<const VertexNumber> loop = faces.singles.loop(face);
        VertexNumber from = loop.back();
        for (const VertexNumber to : loop) {
          add(from, to, result);
          from = to;
        }
      }
    });
    boundary.edges = joined(threads_, std::move(edges));
    sort_in_buckets(
        boundary.edges, boundary.vertices.size(),
        [](const BoundaryEdge& edge) { return edge.from; }, std::less<>(), threads_);
    boundary.edges.erase(std::unique(boundary.edges.begin(), boundary.edges.end()),
                         boundary.edges.end());
  }

  const Scene& scene_;
  const Geometry& geometry_;
  unsigned threads_;
  Progress* progress_;
  TierStatistics statistics_;
  std::uint64_t statistics_pieces_ = 0;
  const SettledFacets settled_;
  std::vector<PieceEdge> edges_;
  std::vector<SimpleEdge> simple_edges_;
  std::vector<TouchableEdge> touchable_edges_;
  std::vector<SettledFace> settled_faces_;
  std::vector<SettledSide> settled_sides_;
  std::map<std::array<VertexNumber, 2>, std::vector<VertexNumber>> cuts_;  // of touchable edges
  std::map<LineNumber, std::vector<VertexNumber>> touching_;  // where other edges touch a line
  std::vector<std::uint32_t> primitive_of_piece_;
  std::vector<unsigned char> in_general_position_;  // by piece
  VertexRow vertices_;
  DisjointSets faces_;
  std::vector<LineSample> lines_;
  std::vector<LineContent> content_;  // by line
  std::vector<Segment> segments_;     // of all lines
  std::vector<VertexNumber> stations_;
  std::vector<unsigned char> is_vertex_;
  PerThread<std::vector<std::uint32_t>> ranks_{[] { return std::vector<std::uint32_t>(); }};
};

}  // namespace

Boundary merge_pieces(Scene&& scene, std::vector<PieceBuffer> buffers, unsigned threads,
                      Progress* progress) {
  Merger merger(scene, std::move(buffers), threads, progress);
  give_up(scene.facets);
  give_up(scene.corners);
  return merger.merge();
}

Boundary merge_pieces(const Scene& scene, std::vector<PieceBuffer> buffers, unsigned threads,
                      Progress* progress) {
  return Merger(scene, std::move(buffers), threads, progress).merge();
}

}  // namespace exactcsg
