// SPDX-License-Identifier: Apache-2.0
#pragma once

// The polymorphic CSG tree: a value that shares its nodes. [Exact]
//
// A tree over primitives P and operators O is Empty, Full, Primitive(P) or Compose(O, children)
// with at least one child; n-ary operators fold from the left. Trees are immutable, a copy is a
// counted reference, and a subtree may occur many times. What O means is said by the algorithms
// (traverse's combine, prune's reactions), as in the source.
//
// LAW tree.1  nothing recurses on the depth of a tree: a chain of a million nodes is built, copied,
//             compared, mapped and destroyed.
// LAW tree.2  trees with equal identity() are equal; a copy has the identity of the original.
// LAW tree.3  compose costs O(children), copy and move O(1), destruction O(nodes that die).
// LAW tree.4  different threads may copy, read and destroy handles of the same nodes.
// A default-constructed and a moved-from tree is Empty.
//
// Source: Davy and Dew, "A polymorphic library for constructive solid geometry", section 3.2; n-ary
// nodes and shared handles are ours.

#include <atomic>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <unordered_map>
#include <utility>
#include <variant>
#include <vector>

#include "exactcsg/csg/boolean_operator.hpp"
#include "exactcsg/csg/tree_concept.hpp"
#include "exactcsg/csg/walk.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg::csg {

template <class P, class O>
class Tree {
 public:
  using Primitive = P;
  using Operator = O;

  class Cursor {
   public:
    Cursor() = default;
    explicit Cursor(const Tree* at) noexcept : at_(at) {}
    NodeKind kind() const noexcept { return at_->kind(); }
    const P& primitive() const noexcept { return at_->primitive(); }
    O operation() const noexcept { return at_->operation(); }
    Cursor first_child() const noexcept { return Cursor(at_->children().data()); }
    Cursor next_sibling() const noexcept { return Cursor(at_ + 1); }
    Cursor children_end() const noexcept {
      return Cursor(at_->children().data() + at_->children().size());
    }
    const Tree& tree() const noexcept { return *at_; }
    friend bool operator==(Cursor, Cursor) = default;

   private:
    const Tree* at_ = nullptr;
  };

  Tree() noexcept = default;
  Tree(const Tree& other) noexcept : node_(other.node_) { retain(); }
  Tree(Tree&& other) noexcept : node_(std::exchange(other.node_, nullptr)) {}
  Tree& operator=(Tree other) noexcept {
    std::swap(node_, other.node_);
    return *this;
  }
  ~Tree() { release(std::exchange(node_, nullptr)); }

  static Tree empty() noexcept { return {}; }
  static Tree full() noexcept { return Tree(&full_node); }
  static Tree primitive(P value) { return Tree(new Node(std::move(value))); }
  // THROWS Error(BadArgument) if there are no children.
  static Tree compose(O operation, std::vector<Tree> children) {
    if (children.empty()) throw Error(ErrorId::BadArgument, {"an operator without operands", ""});
    return Tree(new Node(operation, std::move(children)));
  }

  NodeKind kind() const noexcept { return node_ == nullptr ? NodeKind::Empty : node_->kind(); }
  bool is_empty() const noexcept { return node_ == nullptr; }
  bool is_full() const noexcept { return node_ == &full_node; }
  bool is_primitive() const noexcept { return kind() == NodeKind::Primitive; }
  bool is_compose() const noexcept { return kind() == NodeKind::Compose; }

  // REQUIRES is_primitive()
  const P& primitive() const noexcept { return *std::get_if<P>(&node_->content); }
  // REQUIRES is_compose(), these two
  O operation() const noexcept { return std::get_if<Composition>(&node_->content)->operation; }
  std::span<const Tree> children() const noexcept {
    return std::get_if<Composition>(&node_->content)->children;
  }

  // The number of nodes and of primitives, every occurrence counted; 2^64 - 1 if there are at least
  // so many (a tree with sharing may stand for more than that). COST: O(1)
  std::uint64_t node_count() const noexcept { return is_empty() ? 1 : node_->nodes; }
  std::uint64_t primitive_count() const noexcept { return is_empty() ? 0 : node_->primitives; }

  // A key for tables of results; valid as long as some handle of the node lives.
  const void* identity() const noexcept { return node_; }
  friend bool same_handle(const Tree& a, const Tree& b) noexcept { return a.node_ == b.node_; }
  // True if other handles of this node exist (at the time of asking).
  bool is_shared() const noexcept {
    return node_ != nullptr && node_->references.load(std::memory_order_relaxed) > 1;
  }

  Cursor root() const noexcept { return Cursor(this); }

 private:
  struct FullNode {};
  struct Composition {
    O operation;
    std::vector<Tree> children;
  };

  struct Node {
    constexpr Node() noexcept : content(FullNode{}) {}
    explicit Node(P value) : content(std::move(value)), primitives(1) {}
    Node(O operation, std::vector<Tree> trees) : content(Composition{operation, std::move(trees)}) {
      for (const Tree& child : std::get_if<Composition>(&content)->children) {
        nodes = add(nodes, child.node_count());
        primitives = add(primitives, child.primitive_count());
      }
    }
    NodeKind kind() const noexcept {
      constexpr NodeKind kinds[] = {NodeKind::Full, NodeKind::Primitive, NodeKind::Compose};
      return kinds[content.index()];
    }
    static std::uint64_t add(std::uint64_t a, std::uint64_t b) noexcept {
      return a > std::numeric_limits<std::uint64_t>::max() - b
                 ? std::numeric_limits<std::uint64_t>::max()
                 : a + b;
    }

    std::variant<FullNode, P, Composition> content;
    std::uint64_t nodes = 1;
    std::uint64_t primitives = 0;
    mutable std::atomic<std::size_t> references{1};
    Node* next_dead = nullptr;
  };

  explicit Tree(Node* node) noexcept : node_(node) {}

  // Full is one static node, never counted, so that is_full() is a comparison.
  static inline Node full_node{};

  void retain() const noexcept {
    if (node_ != nullptr && node_ != &full_node) {
      node_->references.fetch_add(1, std::memory_order_relaxed);
    }
  }
  // True if that was the last reference.
  static bool drop(Node* node) noexcept {
    return node != nullptr && node != &full_node &&
           node->references.fetch_sub(1, std::memory_order_acq_rel) == 1;
  }
  // The dead nodes are chained through themselves: no recursion, and no allocation that could fail.
  static void release(Node* node) noexcept {
    if (!drop(node)) return;
    for (Node* dead = node; dead != nullptr;) {
      Node* const current = dead;
      dead = dead->next_dead;
      if (auto* composition = std::get_if<Composition>(&current->content)) {
        for (Tree& child : composition->children) {
          Node* const below = std::exchange(child.node_, nullptr);
          if (drop(below)) below->next_dead = std::exchange(dead, below);
        }
      }
      delete current;
    }
  }

  Node* node_ = nullptr;
};

// The same tree: equal kinds, operators, primitives and children, in order.
// COST: O(occurrences of nodes); subtrees with the same handle are equal at once.
template <std::equality_comparable P, class O>
bool operator==(const Tree<P, O>& first, const Tree<P, O>& second) {
  using Pair = std::pair<const Tree<P, O>*, const Tree<P, O>*>;
  std::vector<Pair> pending{{&first, &second}};
  while (!pending.empty()) {
    const auto [a, b] = pending.back();
    pending.pop_back();
    if (same_handle(*a, *b)) continue;
    if (a->kind() != b->kind()) return false;
    if (a->is_primitive() && !(a->primitive() == b->primitive())) return false;
    if (!a->is_compose()) continue;
    const auto left = a->children();
    const auto right = b->children();
    if (a->operation() != b->operation() || left.size() != right.size()) return false;
    for (std::size_t i = 0; i < left.size(); ++i) pending.push_back({&left[i], &right[i]});
  }
  return true;
}

// The same tree with function(primitive) in place of every primitive.
// LAW map.1  function is called once for every distinct node, and what was shared is shared again.
// COST: O(distinct nodes).
template <class P, class O, std::invocable<const P&> F>
auto map(const Tree<P, O>& tree, F&& function)
    -> Tree<std::remove_cvref_t<std::invoke_result_t<F&, const P&>>, O> {
  using Source = Tree<P, O>;
  using Target = Tree<std::remove_cvref_t<std::invoke_result_t<F&, const P&>>, O>;
  std::unordered_map<const void*, Target> known;
  std::vector<Target> results;
  const auto recall = [&](const Source& source) {
    if (!source.is_shared()) return false;
    const auto found = known.find(source.identity());
    if (found == known.end()) return false;
    results.push_back(found->second);
    return true;
  };
  const auto remember = [&](const Source& source) {
    if (source.is_shared()) known.emplace(source.identity(), results.back());
  };
  walk(
      tree.root(), [&](auto node) { return !recall(node.tree()); },
      [&](auto node) {
        if (node.kind() == NodeKind::Empty) {
          results.push_back(Target::empty());
        } else if (node.kind() == NodeKind::Full) {
          results.push_back(Target::full());
        } else if (!recall(node.tree())) {
          results.push_back(Target::primitive(function(node.primitive())));
          remember(node.tree());
        }
      },
      [&](auto node) {
        const auto first =
            results.end() - static_cast<std::ptrdiff_t>(node.tree().children().size());
        std::vector<Target> children(std::make_move_iterator(first),
                                     std::make_move_iterator(results.end()));
        results.erase(first, results.end());
        results.push_back(Target::compose(node.operation(), std::move(children)));
        remember(node.tree());
      });
  return std::move(results.back());
}

// The Boolean operators by name. Nothing is simplified: that is prune's work.
template <class P>
using BooleanTree = Tree<P, BooleanOperator>;

template <class P>
BooleanTree<P> unite(BooleanTree<P> a, BooleanTree<P> b) {
  return BooleanTree<P>::compose(BooleanOperator::Union, {std::move(a), std::move(b)});
}
template <class P>
BooleanTree<P> intersect(BooleanTree<P> a, BooleanTree<P> b) {
  return BooleanTree<P>::compose(BooleanOperator::Intersection, {std::move(a), std::move(b)});
}
template <class P>
BooleanTree<P> subtract(BooleanTree<P> a, BooleanTree<P> b) {
  return BooleanTree<P>::compose(BooleanOperator::Difference, {std::move(a), std::move(b)});
}
template <class P>
BooleanTree<P> symmetric_difference(BooleanTree<P> a, BooleanTree<P> b) {
  return BooleanTree<P>::compose(BooleanOperator::SymmetricDifference,
                                 {std::move(a), std::move(b)});
}
template <class P>
BooleanTree<P> complement(BooleanTree<P> a) {
  return subtract(BooleanTree<P>::full(), std::move(a));
}

}  // namespace exactcsg::csg
