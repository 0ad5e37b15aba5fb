// SPDX-License-Identifier: Apache-2.0
#pragma once

// What every CSG tree of this library can be asked, whatever its memory layout: the one interface
// that traverse, prune, flatten and walk are written against. [Exact]
//
// A cursor is a small value that points at one node of a tree that outlives it.
// LAW cursor.1  the children of a composed node are first_child(), first_child().next_sibling(),
// ...
//               up to and without children_end(); there is at least one.
// LAW cursor.2  every operation of a cursor is O(1) and allocates nothing.

#include <concepts>
#include <cstdint>
#include <functional>
#include <type_traits>
#include <utility>

namespace exactcsg::csg {

// Davy and Dew, section 3.2: Emptysolid, Fullsolid, Primitive(rho), Compose(...).
enum class NodeKind : std::uint8_t { Empty, Full, Primitive, Compose };

// How cursors hand out operators: small ones by value, which is quicker; others, say with an
// attribute, by reference.
template <class O>
using OperationResult =
    std::conditional_t<std::is_trivially_copyable_v<O> && sizeof(O) <= sizeof(void*), O, const O&>;

template <class C, class P, class O>
concept TreeCursor = std::copyable<C> && std::equality_comparable<C> && requires(const C cursor) {
  { cursor.kind() } -> std::same_as<NodeKind>;
  // REQUIRES kind() == Primitive
  { cursor.primitive() } -> std::convertible_to<const P&>;
  // REQUIRES kind() == Compose, these three
  { cursor.operation() } -> std::convertible_to<const O&>;
  { cursor.first_child() } -> std::same_as<C>;
  { cursor.children_end() } -> std::same_as<C>;
  // REQUIRES the node is a child
  { cursor.next_sibling() } -> std::same_as<C>;
};

template <class T>
concept ReadableTree = requires(const T& tree) {
  typename T::Primitive;
  typename T::Operator;
  typename T::Cursor;
  { tree.root() } -> std::same_as<typename T::Cursor>;
}
&&TreeCursor<typename T::Cursor, typename T::Primitive, typename T::Operator>;

// The operator of a node whose cursor is gone: a value, or a reference into the tree.
template <class Cursor, class O>
using KeptOperation = std::conditional_t<
    std::is_lvalue_reference_v<decltype(std::declval<const Cursor&>().operation())>,
    std::reference_wrapper<const O>, O>;

}  // namespace exactcsg::csg
