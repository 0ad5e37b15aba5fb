// SPDX-License-Identifier: Apache-2.0
#pragma once

// CSG trees with an attribute at every primitive and operator: bounding boxes, names, materials,
// numbers of nodes. [Exact]
//
//   AttributedTree<P, O, A>                                the tree over P with A and O with A
//   attribute(tree, solve, combine [, special]) -> that    computed upwards
//   inherit(tree, root_attribute, descend) -> that         computed downwards
//   without_attributes(attributed) -> Tree<P, O>
//
// An attributed tree is the same Tree over other primitives and operators, so every operation on
// trees is one on attributed trees, and functions of P and O serve for them as they are: Attributed
// turns into a const reference of what it holds. CutOff (traverse.hpp) makes use of attributes.
// Empty and Full have none, as in the source.
//
// LAW attribute.1  the attribute of every node is what traverse(its subtree, solve, combine,
//                  special) yields; without_attributes gives the tree back.
// LAW attribute.2  the functions are called once for every distinct node and operand, and what was
//                  shared is shared again.
// LAW attribute.3  what an operator's laws (operator_laws.hpp) say does not depend on its
//                  attribute; equality does.
// LAW inherit.1    the root has descend(root_attribute, its own attribute); the i-th child of a
// node
//                  with operator o and new attribute a has descend(a, o, i, the child's own).
// COST: attribute, without_attributes O(distinct nodes); inherit O(occurrences of nodes), since a
// subtree that is used twice inherits twice. No recursion.
// THROWS attribute: as traverse does. inherit: Error(TooLarge), before any work, above `limit`
// nodes.
//
// Source: Davy and Dew, section 3.6.1; S. Cameron, Efficient intersection tests for objects defined
// constructively (boxes upwards and downwards). docs/decisions/0030: why composition.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "exactcsg/csg/node_limit.hpp"
#include "exactcsg/csg/operator_laws.hpp"
#include "exactcsg/csg/traverse.hpp"
#include "exactcsg/csg/tree.hpp"
#include "exactcsg/csg/walk.hpp"

namespace exactcsg::csg {

template <class T, class A>
struct Attributed {
  T value;
  A attribute;

  constexpr operator const T&() const noexcept { return value; }
  friend bool operator==(const Attributed&, const Attributed&) = default;
};

template <class P, class O, class A>
using AttributedTree = Tree<Attributed<P, A>, Attributed<O, A>>;

template <PrunableOperator O, class A>
constexpr Reaction react(const Attributed<O, A>& op, Position position, Constant operand) {
  return react(op.value, position, operand);
}
template <PrunableOperator O, class A>
constexpr Constant neutral(const Attributed<O, A>& op) {
  return neutral(op.value);
}
template <PrunableOperator O, class A>
constexpr bool splices(const Attributed<O, A>& op, Position position,
                       const Attributed<O, A>& inner) {
  return splices(op.value, position, inner.value);
}
// Of a tree that is neither Empty nor Full.
// REQUIRES that.
template <class P, class O, class A>
const A& attribute_of(const Tree<Attributed<P, A>, Attributed<O, A>>& tree) noexcept {
  return tree.is_primitive() ? tree.primitive().attribute : tree.operation().attribute;
}

namespace detail {

// The attribute of a child, or the special result.
template <class P, class O, class A, class Special, class Use>
A with_attribute(const Tree<Attributed<P, A>, Attributed<O, A>>& child, const Special& special,
                 Use&& use) {
  switch (child.kind()) {
    case NodeKind::Full:
      return use(full_result<A>(special));
    case NodeKind::Empty:
      return use(empty_result<A>(special));
    default:
      return use(attribute_of(child));
  }
}

}  // namespace detail

template <std::copyable P, std::copyable O, std::invocable<const P&> Solve, class Combine,
          class Special = NoSpecial, class A = SolveResult<Solve, P>>
requires std::copyable<A> && std::is_invocable_r_v<A, Combine&, A&&, const O&, const A&>
    AttributedTree<P, O, A> attribute(const Tree<P, O>& tree, Solve&& solve, Combine&& combine,
                                      const Special& special = {}) {
  using Target = AttributedTree<P, O, A>;
  return detail::rebuild<Target>(
      tree,
      [&](auto node) {
        return Target::primitive({node.primitive(), solve(node.primitive())});
      },
      [&](auto node, std::span<Target> children) {
        const O& operation = node.operation();
        A sum = detail::with_attribute(children[0], special, [](const A& a) { return a; });
        for (const Target& child : children.subspan(1)) {
          sum = detail::with_attribute(child, special, [&](const A& a) -> A {
            return combine(std::move(sum), operation, a);
          });
        }
        return Target::compose_from({operation, std::move(sum)}, children);
      });
}

template <std::copyable P, std::copyable O, class A>
Tree<P, O> without_attributes(const Tree<Attributed<P, A>, Attributed<O, A>>& tree) {
  return map(
      tree, [](const Attributed<P, A>& primitive) { return primitive.value; },
      [](const Attributed<O, A>& operation) { return operation.value; });
}

// descend(const A& of_root, const A& own) -> A;
// descend(const A& parent, const O&, size_t index, const A& own) -> A
template <std::copyable P, std::copyable O, std::copyable A, class Descend>
requires std::is_invocable_r_v<A, Descend&, const A&, const A&> &&
    std::is_invocable_r_v<A, Descend&, const A&, const O&, std::size_t, const A&>
        AttributedTree<P, O, A> inherit(const Tree<Attributed<P, A>, Attributed<O, A>>& tree,
                                        const A& root_attribute, Descend&& descend,
                                        std::uint64_t limit = default_node_limit) {
  using T = AttributedTree<P, O, A>;
  require_node_limit(tree.node_count(), limit);
  struct Open {
    Attributed<O, A> operation;
    std::size_t first_result;
    std::size_t next_child = 0;
  };
  std::vector<Open> open;
  std::vector<T> results;
  const auto inherited = [&](const A& own) -> A {
    if (open.empty()) return descend(root_attribute, own);
    Open& parent = open.back();
    return descend(parent.operation.attribute, parent.operation.value, parent.next_child, own);
  };
  const auto finish = [&](T result) {
    results.push_back(std::move(result));
    if (!open.empty()) ++open.back().next_child;
  };
  walk(
      tree.root(),
      [&](auto node) {
        const Attributed<O, A>& operation = node.operation();
        open.push_back({{operation.value, inherited(operation.attribute)}, results.size()});
        return true;
      },
      [&](auto node) {
        if (node.kind() != NodeKind::Primitive) return finish(node.tree());
        const Attributed<P, A>& primitive = node.primitive();
        finish(T::primitive({primitive.value, inherited(primitive.attribute)}));
      },
      [&](auto) {
        Open closed = std::move(open.back());
        open.pop_back();
        const auto first = results.begin() + static_cast<std::ptrdiff_t>(closed.first_result);
        T composed =
            T::compose_from(std::move(closed.operation), std::span<T>(first, results.end()));
        results.erase(first, results.end());
        finish(std::move(composed));
      });
  return std::move(results.back());
}

}  // namespace exactcsg::csg
