// SPDX-License-Identifier: Apache-2.0
#pragma once

// The boundary in one cell, as directed pieces of edges. Private to the kernel. [Exact]
//
// Along every edge that reaches the cell, whether a point just to its left and one just to its
// right are inside is known of every figure, and kept up to date from meeting to meeting: a ray
// that leaves the edge to the left changes it on the left. Where the tree's values differ, the
// piece is boundary. No case distinction for coincident edges: they change neither side.
//
// LAW planar_piece.1  a piece has the set on its left.
// LAW planar_piece.2  of coincident edges, those pieces are of the lowest.
// LAW planar_piece.3  a piece's ends are all points where boundary pieces may meet, and crossings
// of walls. A point that is no wall's belongs to one cell (scene.hpp), and in it has one name.

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "exactcsg/planar/decomposition.hpp"
#include "exactcsg/planar/scene.hpp"

namespace exactcsg::planar {

struct PieceEnd {
  enum class Kind : unsigned char {
    Point,           // first is a point's number
    Crossing,        // of the edges first < second, and of edges coincident with them
    SharedCrossing,  // of first and second, and of further lines
    Wall             // wall and along say where
  };
  Kind kind = Kind::Point;
  std::uint32_t first = 0;
  std::uint32_t second = 0;
  Wall wall;
  CertifiedDouble along;
};

struct Piece {
  EdgeIndex edge = 0;
  Sign way = Sign::Positive;  // Negative: against the edge's direction
  PieceEnd start, end;
};

class CellEvaluator {
 public:
  explicit CellEvaluator(const Scene& scene);
  // Of a cell whose figures are one convex figure.
  void emit_convex(const Cell& cell, std::vector<Piece>& pieces);
  // COST: of s segments, O(s (s + edges)), and the tree for every piece.
  void evaluate(const Cell& cell, std::vector<Piece>& pieces);

 private:
  // Something that happens at a point in the interior of an edge.
  struct Event {
    CertifiedDouble at;               // coordinate along the edge's long axis
    std::optional<PointIndex> point;  // if it is one
    std::uint32_t other = 0;          // the segment that is met
    bool left = false;                // a ray of it leaves to the left
    bool right = false;
    signed char cover = 0;  // a coincident edge begins or ends, along the direction
  };
  struct Start {
    PieceEnd end;
    Sign way = Sign::Positive;
    std::uint32_t covering = 0;  // lower coincident edges
  };

  // The edges of the cell with the same end points, under the number of the lowest.
  struct Segment {
    std::uint32_t lowest;  // in the cell, as are all
    std::uint32_t last;    // of which the others follow by next_
  };

  const ClippedEdge& clipped(std::uint32_t i) const { return cell_->edges[segments_[i].lowest]; }
  EdgeIndex edge_at(std::uint32_t i) const { return clipped(i).edge; }
  const Edge& data(std::uint32_t i) const { return scene_.edges()[edge_at(i)]; }
  bool has_end(std::uint32_t i, PointIndex p) const;
  void find_segments();
  // Crosses all edges of the segment.
  void flip(std::vector<unsigned char>& sides, std::uint32_t i) const;

  void relate(std::uint32_t i, std::uint32_t j);
  void relate_collinear(std::uint32_t i, std::uint32_t j);
  void add_touch(std::uint32_t i, std::uint32_t j, bool at_from, Sign side_of_other_end);
  void add_crossing(std::uint32_t i, std::uint32_t j);
  bool is_in_cell(std::uint32_t i, std::uint32_t j, const CertifiedPoint& near) const;

  void reset_sides();
  Start start(std::uint32_t i);
  Start start_at_wall(std::uint32_t i, bool at_from);
  Start start_at_point(std::uint32_t i);
  Sign compare_crossing(std::uint32_t i, const Wall& wall, const CertifiedDouble& along,
                        PointIndex p) const;
  void walk(std::uint32_t i, std::vector<Piece>& pieces);
  Sign order(std::uint32_t i, const Event& a, const Event& b) const;
  Rational exact_position(std::uint32_t i, const Event& event) const;
  PieceEnd name(std::uint32_t i, const Event* begin, const Event* end) const;
  bool is_inside(const std::vector<unsigned char>& sides);

  const Scene& scene_;
  const Cell* cell_ = nullptr;
  std::vector<Segment> segments_;
  std::vector<std::uint32_t> next_;       // of an edge of the cell, in its segment
  std::vector<std::uint32_t> number_of_;  // of a segment of the scene; reset after use
  std::vector<std::vector<Event>> events_;
  std::vector<unsigned char> left_, right_;  // by figure: whether it is inside there
  struct Ray {
    std::uint32_t segment;
    Sign way;
  };
  std::vector<Ray> rays_;
  csg::TraverseScratch<FigureTree, bool> traverse_;
};

}  // namespace exactcsg::planar
