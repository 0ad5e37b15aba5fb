// SPDX-License-Identifier: Apache-2.0
#pragma once

// The same solid as a binary tree, as the source has it, or with as few operators of as many
// operands as can be. [Exact]
//
//   BinaryView(tree)   every operator has at most two operands; nothing is copied
//   to_tree(readable)  a Tree of its own of any readable tree: of a view, of a flat tree
//   merge_nested(tree) operators whose result is an operand of the same kind take it apart
//
// LAW view.1  BinaryView shows op(a, b, c) as op(op(a, b), c); an operator of one operand as it is.
//             Hence traverse yields the same.
// LAW view.2  to_tree(t) has the kinds, operators, primitives and children of t, in order; of a
// Tree it
//             is equal to that.
// LAW view.3  merge_nested puts the operands of a node in its place wherever the laws of the
// operators
//             (splices) allow it, except for nodes that are shared, which stay shared; as a truth
//             function the result is the tree. merge_nested(to_tree(BinaryView(t))) ==
//             merge_nested(t) if t shares no nodes.
// LAW view.4  merge_nested hands back the same handle where nothing is merged.
// A view and its cursors are valid while the tree lives and is not assigned to.
// COST: BinaryView O(1), and every operation of its cursors; to_tree O(occurrences of nodes);
// merge_nested O(distinct nodes). No recursion.

#include <algorithm>
#include <cstddef>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "exactcsg/csg/operator_laws.hpp"
#include "exactcsg/csg/reduce.hpp"
#include "exactcsg/csg/traverse.hpp"
#include "exactcsg/csg/tree.hpp"
#include "exactcsg/csg/tree_concept.hpp"
#include "exactcsg/csg/walk.hpp"

namespace exactcsg::csg {

template <class P, class O>
class BinaryView {
 public:
  using Primitive = P;
  using Operator = O;

  // The first `operands` operands of a node, or, if that is not composed, the node.
  class Cursor {
   public:
    Cursor() = default;
    NodeKind kind() const noexcept { return at_->kind(); }
    const P& primitive() const noexcept { return at_->primitive(); }
    OperationResult<O> operation() const noexcept { return at_->operation(); }
    Cursor first_child() const noexcept {
      if (operands_ > 2) return Cursor(at_, operands_ - 1, at_, operands_, false);
      return Cursor(at_->children()[0], at_, operands_, operands_ == 1);
    }
    Cursor next_sibling() const noexcept {
      if (is_last_) return {};
      return Cursor(parent_->children()[parent_operands_ - 1], parent_, parent_operands_, true);
    }
    Cursor children_end() const noexcept { return {}; }
    friend bool operator==(Cursor, Cursor) = default;

   private:
    friend class BinaryView;
    Cursor(const Tree<P, O>* at, std::size_t operands, const Tree<P, O>* parent,
           std::size_t parent_operands, bool is_last) noexcept
        : at_(at),
          operands_(operands),
          parent_(parent),
          parent_operands_(parent_operands),
          is_last_(is_last) {}
    Cursor(const Tree<P, O>& whole, const Tree<P, O>* parent, std::size_t parent_operands,
           bool is_last) noexcept
        : Cursor(&whole, whole.is_compose() ? whole.children().size() : 0, parent, parent_operands,
                 is_last) {}

    const Tree<P, O>* at_ = nullptr;
    std::size_t operands_ = 0;
    const Tree<P, O>* parent_ = nullptr;  // and of how many of its operands this is one part
    std::size_t parent_operands_ = 0;
    bool is_last_ = false;
  };

  explicit BinaryView(const Tree<P, O>& tree) noexcept : tree_(&tree) {}
  BinaryView(Tree<P, O>&&) = delete;
  Cursor root() const noexcept { return Cursor(*tree_, nullptr, 0, true); }

 private:
  const Tree<P, O>* tree_;
};

template <ReadableTree T>
auto to_tree(const T& tree) -> Tree<typename T::Primitive, typename T::Operator> {
  using Target = Tree<typename T::Primitive, typename T::Operator>;
  return reduce(
      tree, [](const typename T::Primitive& primitive) { return Target::primitive(primitive); },
      [](const typename T::Operator& operation, std::span<Target> children) {
        return Target::compose_from(operation, children);
      },
      FullEmptyResult{Target::full(), Target::empty()});
}

template <class P, PrunableOperator O>
Tree<P, O> merge_nested(const Tree<P, O>& tree) {
  using T = Tree<P, O>;
  std::unordered_map<const void*, T> known;
  std::vector<T> results;
  struct Open {
    const T* node;
    std::size_t first_result;
    bool is_merged;  // its operands become those of the innermost that is not
  };
  std::vector<Open> open;
  std::vector<std::size_t> unmerged;  // which of `open` are not merged
  const auto splices_into_parent = [&](const T& node) {
    if (unmerged.empty() || node.is_shared()) return false;
    const Open& parent = open[unmerged.back()];
    const auto position = results.size() == parent.first_result ? Position::First : Position::Later;
    const O& outer = parent.node->operation();
    const O& inner = node.operation();
    return splices(outer, position, inner);
  };
  walk(
      tree.root(),
      [&](auto cursor) {
        const T& node = cursor.tree();
        if (node.is_shared()) {
          if (const auto found = known.find(node.identity()); found != known.end()) {
            results.push_back(found->second);
            return false;
          }
        }
        const bool merged = splices_into_parent(node);
        if (!merged) unmerged.push_back(open.size());
        open.push_back({&node, results.size(), merged});
        return true;
      },
      [&](auto cursor) { results.push_back(cursor.tree()); },
      [&](auto cursor) {
        const Open closed = open.back();
        open.pop_back();
        if (closed.is_merged) return;
        unmerged.pop_back();
        const T& node = cursor.tree();
        const auto first = results.begin() + static_cast<std::ptrdiff_t>(closed.first_result);
        const auto before = node.children();
        const bool unchanged = std::equal(first, results.end(), before.begin(), before.end(),
                                          [](const T& a, const T& b) { return same_handle(a, b); });
        T result =
            unchanged ? node : T::compose_from(node.operation(), std::span(first, results.end()));
        results.erase(first, results.end());
        if (node.is_shared()) known.emplace(node.identity(), result);
        results.push_back(std::move(result));
      });
  return std::move(results.back());
}

}  // namespace exactcsg::csg
