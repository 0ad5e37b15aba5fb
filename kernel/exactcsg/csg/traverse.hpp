// SPDX-License-Identifier: Apache-2.0
#pragma once

// The evaluation of a CSG tree: solve its primitives, combine the results upwards. [Exact]
//
//   traverse(tree, solve, combine, special, absorbs, scratch)
//   traverse(tree, query, solve, combine, special, absorbs, scratch)
//
// solve(primitive) or solve(primitive, query) -> R; combine(R, operator, R) -> R. The last three
// arguments may be left out, from the right.
//
// LAW traverse.1  a primitive yields solve; Full and Empty yield the special results; a composed
//                 node folds the results of its children from the left with combine; a single child
//                 passes its result through.
// LAW traverse.2  if absorbs(partial, operator) says that no right-hand argument changes partial,
//                 the remaining children are not visited; the result is the same as without.
// LAW traverse.3  solve is called from left to right, once for every occurrence visited.
// LAW traverse.4  of trees with attributes: CutOff{solve, decide} in place of solve asks
//                 decide(attribute) or decide(attribute, query) -> optional<R> at every node that
//                 has an attribute, before anything else; if it has a value, that is the result of
//                 the node, and what is below it is not visited. Where that value is what the node
//                 yields anyway, the result is that without the cut-off.
// LAW traverse.5  with a scratch that has seen a tree as deep, traverse itself allocates nothing.
// R needs only be movable. No recursion.
// THROWS Error(NoSpecialResult) if the tree has Full or Empty and no result for it was given, and
// what the callbacks throw.
// COST: O(nodes visited) calls; memory O(depth).
//
// Source: Davy and Dew, section 3.2, with the SpecialSolve argument of section 7.2 in place of six
// overloads, and the early out that section 7.3 misses.

#include <concepts>
#include <functional>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "exactcsg/csg/tree_concept.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg::csg {

// What traverse yields at Full and Empty: a value of R, or a function that makes one.
struct NoSpecial {};
template <class F>
struct FullResult {
  F full;
};
template <class F, class E>
struct FullEmptyResult {
  F full;
  E empty;
};
template <class F>
FullResult(F) -> FullResult<F>;
template <class F, class E>
FullEmptyResult(F, E) -> FullEmptyResult<F, E>;

struct NeverAbsorbs {
  template <class R, class O>
  constexpr bool operator()(const R&, const O&) const noexcept {
    return false;
  }
};

// A solve that looks at the attributes of attributed.hpp first.
template <class Solve, class Decide>
struct CutOff {
  Solve solve;
  Decide decide;

  template <class... Arguments>
  requires std::invocable<Solve&, Arguments...>
  decltype(auto) operator()(Arguments&&... arguments) {
    return std::invoke(solve, std::forward<Arguments>(arguments)...);
  }
  template <class... Arguments>
  requires std::invocable<const Solve&, Arguments...>
  decltype(auto) operator()(Arguments&&... arguments) const {
    return std::invoke(solve, std::forward<Arguments>(arguments)...);
  }
};
template <class Solve, class Decide>
CutOff(Solve, Decide) -> CutOff<Solve, Decide>;

namespace detail {

// A result that may not be there yet: as std::optional, but what costs nothing to make is always
// made, which is faster.
template <class R>
class PlainPartial {
 public:
  PlainPartial(std::nullopt_t) noexcept {}
  PlainPartial& operator=(R value) noexcept {
    value_ = value;
    has_value_ = true;
    return *this;
  }
  explicit operator bool() const noexcept { return has_value_; }
  R& operator*() noexcept { return value_; }

 private:
  R value_{};
  bool has_value_ = false;
};
template <class R>
using Partial = std::conditional_t<std::is_trivially_copyable_v<R> && sizeof(R) <= sizeof(void*) &&
                                       std::is_default_constructible_v<R>,
                                   PlainPartial<R>, std::optional<R>>;

}  // namespace detail

// The stack of traverse, kept by the caller between calls. REQUIRES not used by two calls at once.
template <ReadableTree T, class R>
class TraverseScratch {
 public:
  struct Frame {
    typename T::Cursor child;
    typename T::Cursor end;
    KeptOperation<typename T::Cursor, typename T::Operator> operation;
    detail::Partial<R> partial;
    const typename T::Operator& op() const noexcept { return operation; }
  };
  std::vector<Frame>& frames() noexcept { return frames_; }

 private:
  std::vector<Frame> frames_;
};

namespace detail {

template <class R, class S>
R special_value(const S& special) {
  if constexpr (std::convertible_to<const S&, R>) {
    return special;
  } else {
    return special();
  }
}

template <class R>
[[noreturn]] R no_special(const char* what) {
  throw Error(ErrorId::NoSpecialResult, {what, ""});
}

template <class R>
R full_result(const NoSpecial&) {
  return no_special<R>("Full");
}
template <class R, class F>
R full_result(const FullResult<F>& special) {
  return special_value<R>(special.full);
}
template <class R, class F, class E>
R full_result(const FullEmptyResult<F, E>& special) {
  return special_value<R>(special.full);
}
template <class R, class S>
R empty_result(const S&) {
  return no_special<R>("Empty");
}
template <class R, class F, class E>
R empty_result(const FullEmptyResult<F, E>& special) {
  return special_value<R>(special.empty);
}

template <class R, class Cursor, class Solve, class Special>
R leaf_result(Cursor node, Solve& solve, const Special& special) {
  switch (node.kind()) {
    case NodeKind::Primitive:
      return solve(node.primitive());
    case NodeKind::Full:
      return full_result<R>(special);
    default:
      return empty_result<R>(special);
  }
}

template <class Solve>
constexpr bool is_cut_off = false;
template <class Solve, class Decide>
constexpr bool is_cut_off<CutOff<Solve, Decide>> = true;
template <class Solve>
constexpr bool is_cut_off<const Solve> = is_cut_off<Solve>;

template <class Cursor, class CutOff>
auto decided(Cursor node, CutOff& cut_off) -> decltype(cut_off.decide(node.primitive().attribute)) {
  switch (node.kind()) {
    case NodeKind::Primitive:
      return cut_off.decide(node.primitive().attribute);
    case NodeKind::Compose:
      return cut_off.decide(node.operation().attribute);
    default:
      return {};
  }
}

// Opens composed nodes down to the first that has a result by itself.
template <class R, class Cursor, class Frames, class Solve, class Special>
R descend(Cursor node, Frames& frames, Solve& solve, const Special& special) {
  for (;;) {
    if constexpr (is_cut_off<Solve>) {
      if (std::optional<R> known = decided(node, solve)) return std::move(*known);
    }
    if (node.kind() != NodeKind::Compose) return leaf_result<R>(node, solve, special);
    frames.push_back({node.first_child(), node.children_end(), node.operation(), std::nullopt});
    node = node.first_child();
  }
}

}  // namespace detail

template <class Solve, class P>
using SolveResult = std::remove_cvref_t<std::invoke_result_t<Solve&, const P&>>;

template <class Combine, class R, class O>
concept CombinesResults = std::movable<R> && std::is_invocable_r_v<R, Combine&, R&&, const O&, R&&>;

template <ReadableTree T, std::invocable<const typename T::Primitive&> Solve, class Combine,
          class Special, class Absorbs, class R = SolveResult<Solve, typename T::Primitive>>
requires CombinesResults<Combine, R, typename T::Operator> &&
    std::predicate<Absorbs&, const R&, const typename T::Operator&>
        R traverse(const T& tree, Solve&& solve, Combine&& combine, const Special& special,
                   Absorbs&& absorbs, TraverseScratch<T, R>& scratch) {
  auto& frames = scratch.frames();
  frames.clear();
  typename T::Cursor node = tree.root();
  for (;;) {
    R value = detail::descend<R>(node, frames, solve, special);
    for (;;) {
      if (frames.empty()) return value;
      auto& top = frames.back();
      if (top.partial) value = combine(std::move(*top.partial), top.op(), std::move(value));
      top.child = top.child.next_sibling();
      if (!(top.child == top.end) && !absorbs(std::as_const(value), top.op())) {
        top.partial = std::move(value);
        node = top.child;
        break;
      }
      frames.pop_back();
    }
  }
}

template <ReadableTree T, std::invocable<const typename T::Primitive&> Solve, class Combine,
          class Special = NoSpecial, class Absorbs = NeverAbsorbs,
          class R = SolveResult<Solve, typename T::Primitive>>
requires CombinesResults<Combine, R, typename T::Operator> &&
    std::predicate<Absorbs&, const R&, const typename T::Operator&>
        R traverse(const T& tree, Solve&& solve, Combine&& combine, const Special& special = {},
                   Absorbs&& absorbs = {}) {
  TraverseScratch<T, R> scratch;
  return traverse(tree, solve, combine, special, absorbs, scratch);
}

// With a query, the thing that is classified against the tree.
template <ReadableTree T, class Query,
          std::invocable<const typename T::Primitive&, const Query&> Solve, class Combine,
          class... Rest>
auto traverse(const T& tree, const Query& query, Solve&& solve, Combine&& combine, Rest&&... rest) {
  const auto about_query = [&](const typename T::Primitive& primitive) {
    return solve(primitive, query);
  };
  if constexpr (detail::is_cut_off<std::remove_reference_t<Solve>>) {
    const auto decide = [&](const auto& attribute) { return solve.decide(attribute, query); };
    return traverse(tree, CutOff{about_query, decide}, combine, std::forward<Rest>(rest)...);
  } else {
    return traverse(tree, about_query, combine, std::forward<Rest>(rest)...);
  }
}

}  // namespace exactcsg::csg
