// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The truth value of a tree of planar figures, kept up to date while a walker steps from cell to
// cell of the figures' overlay and single figures switch between In and Out. [Exact]
//
// Why not one csg::traverse per cell: a union of n figures has at least n cells, and a step into
// the next cell changes one figure or two. LAW network.1  value() is what csg::traverse with
// csg::combine gives for the present figures.

#include <cstdint>
#include <queue>
#include <vector>

#include "exactcsg/planar/figure.hpp"

namespace exactcsg::test {

class MembershipNetwork {
 public:
  // Every figure Out. Figures are numbered in the order of figures().
  explicit MembershipNetwork(const PlanarTree& tree);

  // Distinct nodes only: a figure that occurs several times under one handle is one figure.
  const std::vector<const PlanarFigure*>& figures() const { return figures_; }
  bool value() const { return nodes_.back().value; }
  // COST: the nodes above the figure whose value changes, a logarithm each.
  void toggle(std::uint32_t figure);

 private:
  struct ParentLink {
    std::uint32_t node;
    bool first_operand;
  };
  struct Node {
    csg::NodeKind kind = csg::NodeKind::Empty;
    csg::BooleanOperator operation = csg::BooleanOperator::Union;
    bool value = false;
    bool first_value = false;       // of the first operand
    std::uint32_t operands = 0;     // all
    std::uint32_t operands_in = 0;  // without the first
    bool queued = false;
    std::vector<ParentLink> parents;
  };

  static bool evaluate(const Node& node);
  void flip(std::uint32_t node);

  std::vector<Node> nodes_;  // operands before their operators, the root last
  std::vector<const PlanarFigure*> figures_;
  std::vector<std::uint32_t> node_of_figure_;
  std::priority_queue<std::uint32_t, std::vector<std::uint32_t>, std::greater<>> pending_;
};

}  // namespace exactcsg::test
