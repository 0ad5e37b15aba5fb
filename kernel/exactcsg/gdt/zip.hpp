// SPDX-License-Identifier: Apache-2.0
#pragma once

// Divide and conquer on two decomposition trees at once, whatever way each of them is divided.
// [Exact]
//
//   zip(first, second, state, side, part, solve, combine [, executor]) -> R
//   zip(first, second, side, solve, combine [, executor]) -> R
//
// The problem is a Pair: a node of each tree, and the user's state (the region in which the two are
// compared, say); it begins with both roots.
// side(const Pair&) -> Split                    divide the first, the second, both in step, or
//                                               neither and solve the pair
// part(const Pair&, Split, size_t i) -> optional<S>   the state for the i-th part, or nothing if
//                                               that part does not matter (the regions are
//                                               disjoint)
// solve(const Pair&) -> R                       the nodes may be interior: an early out
// combine(span<R>) or combine(span<R>, const Pair&) -> R
// Without state and part, every part is kept.
//
// LAW zip.1  the result of a pair is solve's if side says Neither, else that of combine on the
//            results of the parts kept, in the order of the children: (first.child(i), second),
//            (first, second.child(i)), or (first.child(i), second.child(i)).
// LAW zip.2  side is asked once for every pair, and part once for every part.
// An instance of divide and conquer, with its laws of executors, exceptions and depth.
// THROWS Error(BadArgument) if side divides a terminal, or in step two nodes of different degree.
// COST: O(pairs) calls.
//
// Source: ours; Davy and Dew, section 6.1, miss operations on two trees (addition and subtraction
// of octrees, the intersection of two strip trees). overlay.hpp has the cell by cell ones.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>

#include "exactcsg/gdt/tree.hpp"
#include "exactcsg/skeleton/executor.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg::gdt {

enum class Split : std::uint8_t { Neither, First, Second, Both };

struct NoState {
  friend bool operator==(NoState, NoState) = default;
};

template <class A, class B, class S = NoState>
struct Pair {
  typename A::Node first;
  typename B::Node second;
  S state;
};

template <class Combine, class R, class Problem>
concept CombinesPairs =
    std::is_invocable_r_v<R, Combine&, std::span<R>> || std::is_invocable_r_v < R,
        Combine&, std::span<R>,
const Problem& > ;

namespace detail {

template <class A, class B, class S, class R, class Side, class Part, class Solve, class Combine>
struct ZipAlgorithm {
  using Both = Pair<A, B, S>;
  struct Problem {
    Both pair;
    Split split;
  };
  using Result = R;

  template <class Receive>
  std::optional<R> expand(Problem& problem, Receive&& receive) {
    const Both& pair = problem.pair;
    if (problem.split == Split::Neither) return solve(pair);
    const std::size_t parts = degree(problem);
    for (std::size_t i = 0; i < parts; ++i) {
      std::optional<S> state = part(pair, problem.split, i);
      if (!state) continue;
      receive(begin({problem.split == Split::Second ? pair.first : pair.first.child(i),
                     problem.split == Split::First ? pair.second : pair.second.child(i),
                     *std::move(state)}));
    }
    return std::nullopt;
  }

  R combine(std::span<R> results, Problem&& problem) {
    if constexpr (std::is_invocable_r_v<R, Combine&, std::span<R>>) {
      return combine_(results);
    } else {
      return combine_(results, std::as_const(problem.pair));
    }
  }

  Problem begin(Both pair) {
    const Split split = side(std::as_const(pair));
    return {std::move(pair), split};
  }

  static std::size_t degree(const Problem& problem) {
    const auto& [first, second, state] = problem.pair;
    const bool divides_first = problem.split != Split::Second;
    const bool divides_second = problem.split != Split::First;
    if ((divides_first && first.is_terminal()) || (divides_second && second.is_terminal())) {
      throw Error(ErrorId::BadArgument, {"a terminal that is to be divided", "an interior node"});
    }
    if (divides_first && divides_second && first.degree() != second.degree()) {
      throw Error(ErrorId::BadArgument, {"nodes of " + std::to_string(first.degree()) + " and " +
                                             std::to_string(second.degree()) + " children",
                                         "the same division of both"});
    }
    return divides_first ? first.degree() : second.degree();
  }

  Side& side;
  Part& part;
  Solve& solve;
  Combine& combine_;
};

}  // namespace detail

template <class T1, class N1, class T2, class N2, std::movable S, class Side, class Part,
          class Solve, class Combine, class E = skeleton::SequentialExecutor,
          class P = Pair<Tree<T1, N1>, Tree<T2, N2>, S>,
          class R = std::remove_cvref_t<std::invoke_result_t<Solve&, const P&>>>
requires std::is_invocable_r_v<Split, Side&, const P&> &&
    std::is_invocable_r_v<std::optional<S>, Part&, const P&, Split, std::size_t>&& std::movable<R>&&
        CombinesPairs<Combine, R, P>
            R zip(const Tree<T1, N1>& first, const Tree<T2, N2>& second, S state, Side&& side,
                  Part&& part, Solve&& solve, Combine&& combine, const E& executor = {}) {
  using Algorithm =
      detail::ZipAlgorithm<Tree<T1, N1>, Tree<T2, N2>, S, R, std::remove_reference_t<Side>,
                           std::remove_reference_t<Part>, std::remove_reference_t<Solve>,
                           std::remove_reference_t<Combine>>;
  static_assert(skeleton::Executor<E, Algorithm>);
  Algorithm algorithm{side, part, solve, combine};
  return executor.run(algorithm.begin({first.root(), second.root(), std::move(state)}), algorithm);
}

template <class T1, class N1, class T2, class N2, class Side, class Solve, class Combine,
          class E = skeleton::SequentialExecutor, class P = Pair<Tree<T1, N1>, Tree<T2, N2>>,
          class R = std::remove_cvref_t<std::invoke_result_t<Solve&, const P&>>>
requires std::is_invocable_r_v<Split, Side&, const P&> && CombinesPairs<Combine, R, P> R
zip(const Tree<T1, N1>& first, const Tree<T2, N2>& second, Side&& side, Solve&& solve,
    Combine&& combine, const E& executor = {}) {
  const auto keep = [](const P&, Split, std::size_t) { return std::optional(NoState{}); };
  return zip(first, second, NoState{}, side, keep, solve, combine, executor);
}

}  // namespace exactcsg::gdt
