// SPDX-License-Identifier: Apache-2.0
#pragma once

// The cells of a decomposition, kept, with what was found in each, and changed where the solid
// changes. Internal to the incremental evaluation. [Exact]
//
// LAW cell_tree.1  the open leaf cells are disjoint and fill the root up to walls; every leaf holds
// the pieces of boundary in its open cell, and no piece of boundary lies in a wall. LAW
// cell_tree.2  a leaf's task is as LAW decomposition.1 and .2 have it, or its tree is Empty or Full
// because the solid has no boundary in the cell. LAW cell_tree.3  copies share leaves.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "exactcsg/csg/operator_laws.hpp"
#include "exactcsg/solid/box_pairs.hpp"
#include "exactcsg/solid/growing_scene.hpp"
#include "exactcsg/solid/incremental_evaluation.hpp"

namespace exactcsg {

class CellTree {
 public:
  using NodeNumber = std::uint32_t;

  struct Leaf {
    CellTask task;
    PieceBuffer pieces;
  };

  explicit CellTree(const EvaluateOptions& options) : options_(options) {}

  // All anew, of a tree over the scene's primitives.
  void begin(const WorkingScene& scene, const PrunedTree& tree, UpdateStatistics& update);

  // (tree op primitive) in every cell, for the tree that each has so far. Returns nodes that must
  // be rebuilt, because a facet of the primitive lies in one of their walls.
  std::vector<NodeNumber> apply(const WorkingScene& scene, csg::BooleanOperator operation,
                                PrimitiveIndex primitive, UpdateStatistics& update);

  // The leaves whose closed cells meet one of the boxes.
  std::vector<NodeNumber> leaves_touched(std::span<const DoubleBox> boxes) const;
  // What is below these nodes, anew, of the whole tree. REQUIRES none lies below another.
  void rebuild(const WorkingScene& scene, const PrunedTree& tree, std::vector<NodeNumber> nodes,
               UpdateStatistics& update);

  std::size_t leaf_count() const { return (nodes_.size() + 1) / 2 - free_.size(); }

  // visit(const Leaf&) of every leaf, in an order that depends on the history.
  template <class Visit>
  void for_each_leaf(Visit visit) const {
    for (const Node& node : nodes_) {
      if (node.leaf) visit(*node.leaf);
    }
  }

 private:
  static constexpr NodeNumber none = 0xffffffffU;

  struct Node {
    Cell cell;
    Division division;                 // unless a leaf
    NodeNumber parent = none;          // of the root: none
    NodeNumber children = none;        // the first of two that are neighbours; of a leaf: none
    std::shared_ptr<const Leaf> leaf;  // null unless a leaf
  };
  struct Built;
  class Builder;

  bool is_leaf(NodeNumber node) const { return nodes_[node].children == none; }
  void establish(const WorkingScene& scene, NodeNumber node, CellTask task,
                 UpdateStatistics& update);
  void place(NodeNumber node, Built built);
  NodeNumber add_children(NodeNumber parent);
  void collapse(NodeNumber node);
  std::optional<csg::Constant> constant_at(NodeNumber node) const;
  void make_constant(NodeNumber node, csg::Constant constant);
  void join_constant_leaves();

  void apply_constant(const WorkingScene& scene, NodeNumber node, csg::BooleanOperator operation,
                      csg::Constant operand, UpdateStatistics& update);
  void set_constant(NodeNumber node, csg::Constant constant, UpdateStatistics& update);
  void complement(const WorkingScene& scene, NodeNumber node, UpdateStatistics& update);
  void apply_to_leaf(const WorkingScene& scene, NodeNumber node, csg::BooleanOperator operation,
                     PrimitiveIndex primitive, const CellTask& operand, UpdateStatistics& update);
  template <class Visit>
  void for_each_leaf_below(NodeNumber node, Visit visit) const;

  std::vector<NodeNumber> rebuild_once(const WorkingScene& scene, const PrunedTree& tree,
                                       std::span<const NodeNumber> nodes, UpdateStatistics& update);

  EvaluateOptions options_;
  std::vector<Node> nodes_;          // the root is the first
  std::vector<NodeNumber> renewed_;  // by the change that is being made
  std::vector<NodeNumber> free_;     // pairs of children that are not in use: the first of each
};

}  // namespace exactcsg
