// SPDX-License-Identifier: Apache-2.0
#pragma once

// The decomposition of the plane that the planar evaluator works in: what a cell knows, when it is
// small enough, how it is divided. Private to the kernel. [Exact]
//
// LAW planar_decomposition.1  in a cell, the edges are exactly those of the tree's figures that
// reach it, with what cuts them off; every figure of the tree has one.
// LAW planar_decomposition.2  for every point of the cell, its tree classifies it as the scene's
// tree does.
// LAW planar_decomposition.3  corner_inside says of every figure whether the lower left corner of
// the cell is inside it. No edge passes through a corner (scene.hpp), and a figure without an edge
// in the cell is all inside or all outside, as that corner is.

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "exactcsg/csg/prune.hpp"
#include "exactcsg/planar/outline.hpp"
#include "exactcsg/planar/scene.hpp"

namespace exactcsg::planar {

// Where an edge ends in a cell: at its own end point, which is in the cell, or at a wall.
struct ClipEnd {
  std::optional<Wall> wall;
  CertifiedDouble along;  // the coordinate that the wall leaves free
};

struct ClippedEdge {
  EdgeIndex edge = 0;
  ClipEnd from, to;
  std::array<double, 2> lower, upper;  // bounds of the part in the cell
  bool is_whole() const { return !from.wall && !to.wall; }
};

struct CellFigure {
  FigureIndex figure = 0;
  bool corner_inside = false;
  std::uint32_t first_edge = 0;
  std::uint32_t edge_count = 0;
};

struct Cell {
  std::array<double, 2> lower{}, upper{};  // walls
  std::vector<CellFigure> figures;
  std::vector<ClippedEdge> edges;  // those of one figure are adjacent
  FigureTree tree;
  std::uint32_t depth = 0;
};

class Decomposition {
 public:
  Decomposition(const Scene& scene, const OutlineOptions& options);

  Cell root() const;
  bool is_one_convex_figure(const Cell& cell) const {
    return cell.figures.size() == 1 && scene_.figures()[cell.figures[0].figure].shape != Shape::Any;
  }
  // Cells that together are this one, without those whose tree is a constant; nullopt: it is to be
  // evaluated as it is, since its edges are few, or of one convex figure, or because dividing it
  // some levels deep does not make evaluation cheaper. (Edges that share a point cannot be
  // separated; nor can narrow bundles of slanted edges, which fill as many cells as they are long.)
  std::optional<std::vector<Cell>> divide(const Cell& cell);

 private:
  class Divider;

  bool is_small(const Cell& cell);
  std::size_t count_segments(const Cell& cell);
  double cost(const Cell& cell);
  std::optional<Wall> choose_wall(const Cell& cell) const;
  std::vector<Cell> divide(const Cell& cell, const Wall& wall);

  const Scene& scene_;
  std::size_t edges_per_cell_;
  // By figure; reset after use.
  std::vector<csg::Membership> status_;
  std::vector<unsigned char> in_tree_;
  csg::PruneScratch<FigureTree> prune_;
  std::vector<std::uint64_t> counted_;  // by segment: when it was last
  std::uint64_t count_ = 0;
  std::vector<std::array<bool, 2>> ends_above_;  // of the cell's edges: from, to
};

}  // namespace exactcsg::planar
