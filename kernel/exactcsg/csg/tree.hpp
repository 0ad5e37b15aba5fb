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
// LAW tree.5  a tree of n primitives and n - 1 operators of two operands takes at most 48 bytes a
//             node besides the primitives, the allocator's part included, if an operator has a byte
//             and an allocation costs at most 8 bytes and rounding to 16 (as glibc's does).
// A default-constructed and a moved-from tree is Empty.
//
// Source: Davy and Dew, "A polymorphic library for constructive solid geometry", section 3.2; n-ary
// nodes and shared handles are ours.

#include <array>
#include <atomic>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <new>
#include <set>
#include <span>
#include <type_traits>
#include <unordered_map>
#include <utility>
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
    OperationResult<O> operation() const noexcept { return at_->operation(); }
    Cursor first_child() const noexcept { return Cursor(at_->children().data()); }
    Cursor next_sibling() const noexcept { return Cursor(at_ + 1); }
    Cursor children_end() const noexcept {
      const std::span<const Tree> children = at_->children();
      return Cursor(children.data() + children.size());
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
  static Tree primitive(P value) { return Tree(new PrimitiveNode(std::move(value))); }
  // THROWS Error(BadArgument) if there are no children, Error(TooLarge) if there are 2^32.
  static Tree compose(O operation, std::vector<Tree> children) {
    return compose_from(std::move(operation), std::span(children));
  }
  // The same; leaves the children Empty.
  static Tree compose_from(O operation, std::span<Tree> children) {
    if (children.empty()) throw Error(ErrorId::BadArgument, {"an operator without operands", ""});
    if (children.size() > std::numeric_limits<std::uint32_t>::max()) {
      throw Error(ErrorId::TooLarge, {"more than 2^32 - 1 operands of one operator", ""});
    }
    return Tree(new (Room{children.size()}) Composition(std::move(operation), children));
  }

  NodeKind kind() const noexcept { return node_ == nullptr ? NodeKind::Empty : node_->kind; }
  bool is_empty() const noexcept { return node_ == nullptr; }
  bool is_full() const noexcept { return node_ == &full_node; }
  bool is_primitive() const noexcept { return kind() == NodeKind::Primitive; }
  bool is_compose() const noexcept { return kind() == NodeKind::Compose; }

  // REQUIRES is_primitive()
  const P& primitive() const noexcept { return static_cast<PrimitiveNode*>(node_)->value; }
  // REQUIRES is_compose(), these two
  OperationResult<O> operation() const noexcept { return composition().operation; }
  std::span<const Tree> children() const noexcept { return composition().children(); }

  // The number of nodes and of primitives, every occurrence counted; 2^64 - 1 if there are at least
  // so many (a tree with sharing may stand for more than that). COST: O(1)
  std::uint64_t node_count() const noexcept { return is_compose() ? composition().nodes : 1; }
  std::uint64_t primitive_count() const noexcept {
    if (is_compose()) return composition().primitives;
    return is_primitive() ? 1 : 0;
  }

  // A key for tables of results; valid as long as some handle of the node lives.
  const void* identity() const noexcept { return node_; }
  friend bool same_handle(const Tree& a, const Tree& b) noexcept { return a.node_ == b.node_; }
  // True if other handles of this node exist (at the time of asking).
  bool is_shared() const noexcept {
    return node_ != nullptr && node_->references.load(std::memory_order_relaxed) > 1;
  }

  Cursor root() const noexcept { return Cursor(this); }

 private:
  // What every node begins with. A node is small because a model may have millions (LAW tree.5):
  // its kind takes the place of a pointer to functions, its children are behind it in the same
  // piece of memory, only compositions count their nodes, and references are counted in 32 bits.
  struct Node {
    explicit constexpr Node(NodeKind k, std::uint32_t count = 1) noexcept
        : references(count), kind(k) {}
    mutable std::atomic<std::uint32_t> references;
    const NodeKind kind;
  };

  // A node of so many references is not counted any more and never dies: Full, and what is referred
  // to by 16 GiB of handles. As many threads may pass the test at the same time without harm.
  static constexpr std::uint32_t immortal = std::uint32_t{1} << 31;

  struct PrimitiveNode : Node {
    explicit PrimitiveNode(P v) : Node(NodeKind::Primitive), value(std::move(v)) {}
    P value;
  };

  struct Room {
    std::size_t children;
  };
  struct Composition : Node {
    static_assert(alignof(O) <= __STDCPP_DEFAULT_NEW_ALIGNMENT__);

    static void* operator new(std::size_t size, Room room) {
      return ::operator new(size + room.children * sizeof(Tree));
    }
    static void operator delete(void* memory, Room) noexcept { ::operator delete(memory); }
    static void operator delete(void* memory) noexcept { ::operator delete(memory); }

    // REQUIRES made with room for the children.
    Composition(O op, std::span<Tree> from)
        : Node(NodeKind::Compose),
          operation(std::move(op)),
          degree(static_cast<std::uint32_t>(from.size())),
          nodes(1) {
      static_assert(sizeof(Composition) % alignof(Tree) == 0);
      std::uninitialized_move_n(from.data(), from.size(), room_for_children());
      for (const Tree& child : children()) {
        nodes = add(nodes, child.node_count());
        primitives = add(primitives, child.primitive_count());
      }
    }
    Composition(const Composition&) = delete;
    Composition& operator=(const Composition&) = delete;
    ~Composition() { std::ranges::destroy(children()); }

    std::span<Tree> children() noexcept { return {std::launder(room_for_children()), degree}; }
    std::span<const Tree> children() const noexcept {
      return const_cast<Composition*>(this)->children();
    }

    O operation;
    std::uint32_t degree;
    union {
      std::uint64_t nodes;
      Composition* next_dead;  // of a node that nobody refers to any more
    };
    std::uint64_t primitives = 0;

   private:
    Tree* room_for_children() noexcept {
      return reinterpret_cast<Tree*>(reinterpret_cast<std::byte*>(this) + sizeof(Composition));
    }
    static std::uint64_t add(std::uint64_t a, std::uint64_t b) noexcept {
      return a > std::numeric_limits<std::uint64_t>::max() - b
                 ? std::numeric_limits<std::uint64_t>::max()
                 : a + b;
    }
  };

  // REQUIRES is_compose()
  const Composition& composition() const noexcept { return *static_cast<Composition*>(node_); }

  explicit Tree(Node* node) noexcept : node_(node) {}

  // Full is one static node, so that is_full() is a comparison.
  static inline Node full_node{NodeKind::Full, immortal};

  static bool is_counted(const Node* node) noexcept {
    return node != nullptr && node->references.load(std::memory_order_relaxed) < immortal;
  }
  void retain() const noexcept {
    if (is_counted(node_)) node_->references.fetch_add(1, std::memory_order_relaxed);
  }
  // True if that was the last reference.
  static bool drop(Node* node) noexcept {
    return is_counted(node) && node->references.fetch_sub(1, std::memory_order_acq_rel) == 1;
  }
  // The dead compositions are chained through themselves: no recursion, and no allocation that
  // could fail.
  static void release(Node* node) noexcept {
    if (!drop(node)) return;
    if (node->kind == NodeKind::Primitive) return delete static_cast<PrimitiveNode*>(node);
    auto* dead = static_cast<Composition*>(node);
    dead->next_dead = nullptr;
    while (dead != nullptr) {
      Composition* const current = std::exchange(dead, dead->next_dead);
      for (Tree& child : current->children()) {
        Node* const below = std::exchange(child.node_, nullptr);
        if (!drop(below)) continue;
        if (below->kind == NodeKind::Primitive) {
          delete static_cast<PrimitiveNode*>(below);
        } else {
          auto* const composition = static_cast<Composition*>(below);
          composition->next_dead = std::exchange(dead, composition);
        }
      }
      delete current;
    }
  }

  Node* node_ = nullptr;
};

// The same tree: equal kinds, operators, primitives and children, in order.
// COST: O(pairs of nodes that stand in the same place), a pair of shared ones counting once;
// subtrees with the same handle are equal at once.
template <std::equality_comparable P, std::equality_comparable O>
bool operator==(const Tree<P, O>& first, const Tree<P, O>& second) {
  using Pair = std::pair<const Tree<P, O>*, const Tree<P, O>*>;
  std::vector<Pair> pending{{&first, &second}};
  std::set<std::pair<const void*, const void*>> known;  // one unequal pair ends it all
  while (!pending.empty()) {
    const auto [a, b] = pending.back();
    pending.pop_back();
    if (same_handle(*a, *b)) continue;
    if (a->kind() != b->kind()) return false;
    if (a->is_primitive() && !(a->primitive() == b->primitive())) return false;
    if (!a->is_compose()) continue;
    const auto left = a->children();
    const auto right = b->children();
    if (!(a->operation() == b->operation()) || left.size() != right.size() ||
        a->node_count() != b->node_count()) {
      return false;
    }
    const bool is_new =
        !a->is_shared() || !b->is_shared() || known.emplace(a->identity(), b->identity()).second;
    for (std::size_t i = 0; is_new && i < left.size(); ++i) {
      pending.push_back({&left[i], &right[i]});
    }
  }
  return true;
}

namespace detail {

// Builds a tree like another: leaf(node) -> Target at what is no composition (asked once for a
// distinct primitive), compose(node, span<Target> children) -> Target. Once for every distinct
// node.
template <class Target, class P, class O, class Leaf, class Compose>
Target rebuild(const Tree<P, O>& tree, Leaf&& leaf, Compose&& compose) {
  using Source = Tree<P, O>;
  std::unordered_map<const void*, Target> known;
  std::vector<Target> results;
  std::vector<std::size_t> begins;
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
      tree.root(),
      [&](auto node) {
        if (recall(node.tree())) return false;
        begins.push_back(results.size());
        return true;
      },
      [&](auto node) {
        if (node.kind() != NodeKind::Primitive) {
          results.push_back(node.kind() == NodeKind::Full ? Target::full() : Target::empty());
        } else if (!recall(node.tree())) {
          results.push_back(leaf(node));
          remember(node.tree());
        }
      },
      [&](auto node) {
        const auto first = results.begin() + static_cast<std::ptrdiff_t>(begins.back());
        begins.pop_back();
        Target composed = compose(node, std::span<Target>(first, results.end()));
        results.erase(first, results.end());
        results.push_back(std::move(composed));
        remember(node.tree());
      });
  return std::move(results.back());
}

}  // namespace detail

// The same tree with function(primitive) in place of every primitive, and map_operation(operator)
// in place of every operator.
// LAW map.1  the functions are called once for every distinct node, and what was shared is shared
//            again.
// LAW map.2  map(map(t, f), g) == map(t, g o f), and map(t, identity) == t.
// COST: O(distinct nodes).
template <class P, class O, std::invocable<const P&> F, std::invocable<const O&> G = std::identity>
auto map(const Tree<P, O>& tree, F&& function, G&& map_operation = {})
    -> Tree<std::remove_cvref_t<std::invoke_result_t<F&, const P&>>,
            std::remove_cvref_t<std::invoke_result_t<G&, const O&>>> {
  using Target = Tree<std::remove_cvref_t<std::invoke_result_t<F&, const P&>>,
                      std::remove_cvref_t<std::invoke_result_t<G&, const O&>>>;
  return detail::rebuild<Target>(
      tree, [&](auto node) { return Target::primitive(std::invoke(function, node.primitive())); },
      [&](auto node, std::span<Target> children) {
        const O& operation = node.operation();
        return Target::compose_from(std::invoke(map_operation, operation), children);
      });
}

// The Boolean operators by name. Nothing is simplified: that is prune's work.
template <class P>
using BooleanTree = Tree<P, BooleanOperator>;

namespace detail {
template <class P, class O>
Tree<P, O> compose_two(O operation, Tree<P, O>& a, Tree<P, O>& b) {
  std::array operands{std::move(a), std::move(b)};
  return Tree<P, O>::compose_from(std::move(operation), std::span(operands));
}
}  // namespace detail

template <class P>
BooleanTree<P> unite(BooleanTree<P> a, BooleanTree<P> b) {
  return detail::compose_two(BooleanOperator::Union, a, b);
}
template <class P>
BooleanTree<P> intersect(BooleanTree<P> a, BooleanTree<P> b) {
  return detail::compose_two(BooleanOperator::Intersection, a, b);
}
template <class P>
BooleanTree<P> subtract(BooleanTree<P> a, BooleanTree<P> b) {
  return detail::compose_two(BooleanOperator::Difference, a, b);
}
template <class P>
BooleanTree<P> symmetric_difference(BooleanTree<P> a, BooleanTree<P> b) {
  return detail::compose_two(BooleanOperator::SymmetricDifference, a, b);
}
template <class P>
BooleanTree<P> complement(BooleanTree<P> a) {
  return subtract(BooleanTree<P>::full(), std::move(a));
}

}  // namespace exactcsg::csg
