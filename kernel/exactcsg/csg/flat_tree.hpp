// SPDX-License-Identifier: Apache-2.0
#pragma once

// A CSG tree as one contiguous array of small nodes in pre-order, each with the number of nodes of
// its subtree: for inner loops that rebuild and traverse trees often. [Exact]
//
// LAW flat.1  flatten keeps kinds, operators and the order of children.
// LAW flat.2  building a tree after clear() allocates nothing while size <= capacity.
// A default-constructed or cleared tree is Empty.
// REQUIRES P default-constructible and cheap to copy (an index, say).

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "exactcsg/csg/node_limit.hpp"
#include "exactcsg/csg/tree.hpp"
#include "exactcsg/csg/tree_concept.hpp"
#include "exactcsg/csg/walk.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg::csg {

namespace detail {
template <class P, class O>
class FlatSink;
}

template <std::semiregular P, std::semiregular O>
class FlatTree {
 public:
  using Primitive = P;
  using Operator = O;

 private:
  struct Node {
    std::uint32_t extent;  // nodes of the subtree, this one included
    NodeKind kind;
    O operation;
    P primitive;
  };

 public:
  class Cursor {
   public:
    Cursor() = default;
    explicit Cursor(const Node* at) noexcept : at_(at) {}
    NodeKind kind() const noexcept { return at_->kind; }
    const P& primitive() const noexcept { return at_->primitive; }
    OperationResult<O> operation() const noexcept { return at_->operation; }
    Cursor first_child() const noexcept { return Cursor(at_ + 1); }
    Cursor next_sibling() const noexcept { return Cursor(at_ + at_->extent); }
    Cursor children_end() const noexcept { return next_sibling(); }
    // Nodes of the subtree, this one included.
    std::size_t extent() const noexcept { return at_->extent; }
    friend bool operator==(Cursor, Cursor) = default;

   private:
    const Node* at_ = nullptr;
  };

  FlatTree() = default;

  Cursor root() const noexcept { return Cursor(nodes_.empty() ? &empty_node : nodes_.data()); }
  NodeKind kind() const noexcept { return root().kind(); }
  bool is_empty() const noexcept { return kind() == NodeKind::Empty; }
  bool is_full() const noexcept { return kind() == NodeKind::Full; }
  bool is_primitive() const noexcept { return kind() == NodeKind::Primitive; }
  bool is_compose() const noexcept { return kind() == NodeKind::Compose; }
  // REQUIRES is_primitive()
  const P& primitive() const noexcept { return root().primitive(); }

  std::size_t node_count() const noexcept { return nodes_.empty() ? 1 : nodes_.size(); }
  std::size_t capacity() const noexcept { return nodes_.capacity(); }
  void reserve(std::size_t nodes) { nodes_.reserve(nodes); }

  // Building, in pre-order: append leaves, or open a node, append its children, close it.
  // REQUIRES in the end exactly one root; every open node closed, the last opened first, with at
  // least one child. THROWS Error(TooLarge) at 2^32 nodes.
  struct OpenNode {
    std::size_t index;
  };
  void clear() noexcept { nodes_.clear(); }
  void append_empty() { append(NodeKind::Empty, {}, {}); }
  void append_full() { append(NodeKind::Full, {}, {}); }
  void append_primitive(P primitive) { append(NodeKind::Primitive, {}, std::move(primitive)); }
  OpenNode open(O operation) {
    append(NodeKind::Compose, operation, {});
    return {nodes_.size() - 1};
  }
  void close(OpenNode node) noexcept {
    nodes_[node.index].extent = static_cast<std::uint32_t>(nodes_.size() - node.index);
  }

  friend bool operator==(const FlatTree& a,
                         const FlatTree& b) requires std::equality_comparable<P> {
    if (a.node_count() != b.node_count()) return false;
    Cursor left = a.root();
    Cursor right = b.root();
    for (std::size_t i = 0; i < a.node_count(); ++i) {
      if (!same_node(left, right)) return false;
      left = left.first_child();  // the next node of the array, whatever it is
      right = right.first_child();
    }
    return true;
  }

 private:
  friend class detail::FlatSink<P, O>;

  static bool same_node(Cursor a, Cursor b) noexcept {
    if (a.kind() != b.kind()) return false;
    switch (a.kind()) {
      case NodeKind::Primitive:
        return a.primitive() == b.primitive();
      case NodeKind::Compose:
        return a.operation() == b.operation() && a.extent() == b.extent();
      default:
        return true;
    }
  }

  void append(NodeKind kind, O operation, P primitive) {
    if (nodes_.size() == std::numeric_limits<std::uint32_t>::max()) {
      throw Error(ErrorId::TooLarge, {"more than 2^32 - 1 nodes in one flat tree", ""});
    }
    nodes_.push_back({1, kind, operation, std::move(primitive)});
  }

  static inline const Node empty_node{1, NodeKind::Empty, {}, {}};
  std::vector<Node> nodes_;
};

// The same tree, flat, with map_primitive(primitive) in place of every occurrence of a primitive.
// THROWS Error(TooLarge), before any work, if the tree has more than `limit` nodes.
// COST: O(occurrences of nodes).
template <class P, class O, std::invocable<const P&> MapPrimitive>
auto flatten(const Tree<P, O>& tree, MapPrimitive&& map_primitive,
             std::uint64_t limit = default_node_limit)
    -> FlatTree<std::remove_cvref_t<std::invoke_result_t<MapPrimitive&, const P&>>, O> {
  using Flat = FlatTree<std::remove_cvref_t<std::invoke_result_t<MapPrimitive&, const P&>>, O>;
  require_node_limit(tree.node_count(), limit);
  Flat flat;
  flat.reserve(tree.node_count());
  std::vector<typename Flat::OpenNode> open;
  walk(
      tree.root(),
      [&](auto node) {
        open.push_back(flat.open(node.operation()));
        return true;
      },
      [&](auto node) {
        switch (node.kind()) {
          case NodeKind::Full:
            return flat.append_full();
          case NodeKind::Primitive:
            return flat.append_primitive(map_primitive(node.primitive()));
          default:
            return flat.append_empty();
        }
      },
      [&](auto) {
        flat.close(open.back());
        open.pop_back();
      });
  return flat;
}

}  // namespace exactcsg::csg
