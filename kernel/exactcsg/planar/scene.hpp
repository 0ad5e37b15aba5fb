// SPDX-License-Identifier: Apache-2.0
#pragma once

// The edges of a tree of planar figures under numbers, and every question that the planar evaluator
// asks of them. Private to the kernel. [Exact]
//
// Equal points have one number. Signs: by 128-bit integers if all coordinates have a short common
// denominator, otherwise by certified doubles, and by rationals where these do not tell.
//
// Walls are displaced by infinitesimals, x = c + epsilon and y = d + epsilon', where epsilon' is
// far smaller than epsilon; so no point, no meeting of edges and no edge lies in a wall, and no
// edge passes through the corner of a cell.

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "exactcsg/csg/flat_tree.hpp"
#include "exactcsg/number/certified_double.hpp"
#include "exactcsg/planar/figure.hpp"

namespace exactcsg::planar {

using PointIndex = std::uint32_t;
using EdgeIndex = std::uint32_t;
using SegmentIndex = std::uint32_t;
using FigureIndex = std::uint32_t;
using FigureTree = csg::FlatTree<FigureIndex, csg::BooleanOperator>;

constexpr std::size_t x_axis = 0;
constexpr std::size_t y_axis = 1;

using CertifiedPoint = std::array<CertifiedDouble, 2>;

struct Edge {
  PointIndex from = 0;
  PointIndex to = 0;
  FigureIndex figure = 0;
  SegmentIndex segment = 0;         // the same of edges with the same end points
  std::array<Sign, 2> direction{};  // signs of to - from
  unsigned char long_axis = 0;      // along which the edge extends; direction is not Zero there
  CertifiedPoint vector;            // to - from
};

// What is known of a figure's edges.
enum class Shape : unsigned char { Any, ConvexCounterClockwise, ConvexClockwise };

struct Figure {
  EdgeIndex first_edge = 0;
  std::uint32_t edge_count = 0;
  Shape shape = Shape::Any;
};

struct Wall {
  std::size_t axis = x_axis;  // the coordinate that is constant
  double position = 0;
  friend bool operator==(const Wall&, const Wall&) = default;
};

class Scene {
 public:
  // REQUIRES the tree's figures outlive the scene.
  explicit Scene(const PlanarTree& tree);

  const FigureTree& tree() const { return tree_; }
  const std::vector<Figure>& figures() const { return figures_; }
  const std::vector<Edge>& edges() const { return edges_; }
  std::size_t segment_count() const { return segment_count_; }
  std::size_t point_count() const { return points_.size(); }
  const CertifiedPoint& point(PointIndex p) const { return points_[p]; }
  const Point2& exact_point(PointIndex p) const { return *exact_points_[p]; }

  // Positive: the point is to the left of the edge's directed line.
  Sign orientation(EdgeIndex edge, PointIndex point) const;
  Sign orientation(EdgeIndex edge, const CertifiedPoint& near, const Point2& point) const;
  // Positive: g's direction is less than half a turn counter-clockwise from e's.
  Sign turn(EdgeIndex e, EdgeIndex g) const;

  Sign compare(PointIndex p, std::size_t axis, double position) const;
  Sign compare(PointIndex p, PointIndex q, std::size_t axis) const;

  // Where the edge's line meets the wall: the other coordinate.
  // REQUIRES the direction along the wall's axis is not Zero.
  CertifiedDouble at_wall(EdgeIndex edge, const Wall& wall) const;
  Rational exact_at_wall(EdgeIndex edge, const Wall& wall) const;
  // Whether the crossing with a wall, `near` without displacement, lies above (Positive) or below
  // a wall of the other axis. Both are displaced; never Zero.
  Sign compare_at_wall(EdgeIndex edge, const Wall& wall, CertifiedDouble near,
                       double position) const;
  // The order of two crossings of a wall; Zero: the edges are collinear.
  Sign order_at_wall(EdgeIndex e, CertifiedDouble near_e, EdgeIndex g, CertifiedDouble near_g,
                     const Wall& wall) const;

  // REQUIRES the edges are not parallel.
  CertifiedPoint crossing(EdgeIndex e, EdgeIndex g) const;
  Point2 exact_crossing(EdgeIndex e, EdgeIndex g) const;

  // All points here are those of the tree times a power of two: of a point, what it is there.
  Point2 given(Point2 point) const;

 private:
  struct Builder;

  static Point2 multiplied(const Point2& point, long exponent);

  Sign exact_orientation(EdgeIndex edge, const Point2& point) const;
  // The change of the coordinate that is not the wall's, along the wall's axis.
  Sign slope(EdgeIndex edge) const {
    return edges_[edge].direction[x_axis] * edges_[edge].direction[y_axis];
  }

  std::vector<const Point2*> exact_points_;
  std::deque<Point2> magnified_;  // where they are not the tree's own
  long magnification_ = 0;
  std::vector<CertifiedPoint> points_;
  std::vector<std::array<std::int64_t, 2>> scaled_;  // times denominator_, or none
  Integer denominator_ = 1;
  std::vector<Edge> edges_;  // those of one figure are adjacent
  std::size_t segment_count_ = 0;
  std::vector<Figure> figures_;
  FigureTree tree_;
};

inline std::optional<Sign> certain_sign(CertifiedDouble value) {
  if (value.value > value.error) return Sign::Positive;
  if (-value.value > value.error) return Sign::Negative;
  return std::nullopt;
}

// nullopt: too close to tell, or equal unless both are known exactly.
inline std::optional<Sign> certain_order(CertifiedDouble a, CertifiedDouble b) {
  if (a.error == 0 && b.error == 0) {
    return a.value < b.value ? Sign::Negative : a.value > b.value ? Sign::Positive : Sign::Zero;
  }
  return certain_sign(a - b);
}

}  // namespace exactcsg::planar
