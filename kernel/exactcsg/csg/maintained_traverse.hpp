// SPDX-License-Identifier: Apache-2.0
#pragma once

// The result of a traverse, kept up to date while the results of primitives change. [Exact]
//
// A traverse visits the whole tree; here a change visits the way to the root, and only as far as
// results change. For algorithms that decide one primitive after the other, and take that back.
//
// LAW maintained.1  value() == traverse(tree, result_of, combine, full_and_empty), where
// result_of(p) is the result that p was given last.

#include <concepts>
#include <cstdint>
#include <limits>
#include <vector>

#include "exactcsg/csg/flat_tree.hpp"
#include "exactcsg/csg/traverse.hpp"

namespace exactcsg::csg {

// Combine: R x O x R -> R. Absorbs: R x O -> bool, as in traverse.hpp.
// REQUIRES primitives are numbers below the `primitive_count` given
template <std::unsigned_integral P, std::semiregular O, std::equality_comparable R, class Combine,
          class Absorbs>
requires std::is_invocable_r_v<R, const Combine&, const R&, O, const R&> &&
    std::predicate<const Absorbs&, const R&, O>
class MaintainedTraverse {
 public:
  MaintainedTraverse(std::size_t primitive_count, Combine combine, Absorbs absorbs,
                     FullEmptyResult<R, R> full_and_empty)
      : combine_(std::move(combine)),
        absorbs_(std::move(absorbs)),
        full_and_empty_(std::move(full_and_empty)),
        first_leaf_(primitive_count, none) {}

  // Every primitive has the result `initial`. COST: O(nodes); allocates nothing as long as no
  // earlier tree was smaller.
  void assign(const FlatTree<P, O>& tree, const R& initial) {
    for (const Node& node : nodes_) {
      if (node.kind == NodeKind::Primitive) first_leaf_[node.primitive] = none;
    }
    nodes_.clear();
    open_.clear();
    auto cursor = tree.root();
    for (std::uint32_t i = 0; i < tree.node_count(); ++i, cursor = cursor.first_child()) {
      append(i, cursor, initial);
    }
    for (std::size_t i = nodes_.size(); i > 0; --i) {
      if (nodes_[i - 1].kind == NodeKind::Compose) nodes_[i - 1].value = folded(i - 1);
    }
  }

  // A primitive that does not occur in the tree changes nothing. COST: O(way to the root) operands
  // for each of its occurrences
  void change(P primitive, const R& value) {
    for (std::uint32_t leaf = first_leaf_[primitive]; leaf != none; leaf = nodes_[leaf].next_leaf) {
      if (nodes_[leaf].value == value) continue;
      nodes_[leaf].value = value;
      update_above(leaf);
    }
  }

  // REQUIRES assign was called
  const R& value() const { return nodes_.front().value; }

 private:
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

  struct Node {
    NodeKind kind;
    O operation;
    P primitive;
    std::uint32_t extent;     // nodes of the subtree, this one included
    std::uint32_t parent;     // none: the root
    std::uint32_t next_leaf;  // the next leaf of the same primitive, or none
    R value;
  };
  struct OpenNode {
    std::uint32_t index;
    std::uint32_t end;
  };

  template <class Cursor>
  void append(std::uint32_t index, const Cursor& cursor, const R& initial) {
    while (!open_.empty() && open_.back().end == index) open_.pop_back();
    const auto extent = static_cast<std::uint32_t>(cursor.extent());
    const std::uint32_t parent = open_.empty() ? none : open_.back().index;
    Node node{cursor.kind(), {}, {}, extent, parent, none, initial};
    switch (node.kind) {
      case NodeKind::Primitive:
        node.primitive = cursor.primitive();
        node.next_leaf = std::exchange(first_leaf_[node.primitive], index);
        break;
      case NodeKind::Compose:
        node.operation = cursor.operation();
        open_.push_back({index, index + extent});
        break;
      case NodeKind::Full:
        node.value = full_and_empty_.full;
        break;
      case NodeKind::Empty:
        node.value = full_and_empty_.empty;
        break;
    }
    nodes_.push_back(std::move(node));
  }

  R folded(std::size_t index) const {
    const Node& node = nodes_[index];
    const std::size_t end = index + node.extent;
    std::size_t child = index + 1;
    R value = nodes_[child].value;
    for (child += nodes_[child].extent; child < end; child += nodes_[child].extent) {
      if (absorbs_(value, node.operation)) break;
      value = combine_(value, node.operation, nodes_[child].value);
    }
    return value;
  }

  void update_above(std::uint32_t index) {
    for (std::uint32_t i = nodes_[index].parent; i != none; i = nodes_[i].parent) {
      R value = folded(i);
      if (value == nodes_[i].value) return;
      nodes_[i].value = std::move(value);
    }
  }

  Combine combine_;
  Absorbs absorbs_;
  FullEmptyResult<R, R> full_and_empty_;
  std::vector<std::uint32_t> first_leaf_;  // of each primitive, or none
  std::vector<Node> nodes_;                // in pre-order
  std::vector<OpenNode> open_;
};

}  // namespace exactcsg::csg
