// SPDX-License-Identifier: Apache-2.0
#pragma once

// Divide and conquer. [Exact]
//
//   divacon(data, leaf, divide, solve, combine [, executor]) -> R
//
// leaf(const D&) -> bool            is it small enough to be solved directly?
// divide(D) -> range of D           the subproblems, in order; there may be none
// solve(D) -> R                     the result of a leaf
// combine(span<R>) -> R             the result from those of the subproblems, in their order, or
// combine(span<R>, D) -> R          the same, from the original data as well
//
// The results in the span belong to combine, which may move them out. divide and solve may take
// their argument by value, const D&, D& or D&&. In the second form, divide gets an lvalue: what it
// moves out, combine does not see.
//
// LAW divacon.1  divacon(x) == solve(x) if leaf(x), else combine([divacon(y) : y in divide(x)]), or
//                combine([...], x).
// LAW divacon.2  leaf, divide and solve or combine are called once for every problem.
// LAW divacon.3  D and R need only be movable.
// See executor.hpp for LAW executor.1 to .3: order, exceptions, depth.
// REQUIRES the division ends.
// COST: O(problems) calls, and memory for the subproblems that wait (sequential).
//
// Source: Davy and Dew, section 3.1 (both forms); executors are ours.

#include <concepts>
#include <functional>
#include <ranges>
#include <span>
#include <type_traits>
#include <utility>

#include "exactcsg/skeleton/executor.hpp"

namespace exactcsg::skeleton {

namespace detail {

// Calls with an rvalue if the function takes one, else with an lvalue.
template <class F, class T>
decltype(auto) give(F& function, T& value) {
  if constexpr (std::invocable<F&, T&&>) {
    return std::invoke(function, std::move(value));
  } else {
    return std::invoke(function, value);
  }
}
// The same, but keeps the value for later.
template <class F, class T>
decltype(auto) lend(F& function, T& value) {
  return std::invoke(function, value);
}

template <class F, class T>
concept Takes = std::invocable<F&, T&&> || std::invocable<F&, T&>;

template <class F, class T>
using Given = decltype(give(std::declval<F&>(), std::declval<T&>()));

template <class Combine, class R>
concept CombinesResults = std::is_invocable_r_v<R, Combine&, std::span<R>>;
template <class Combine, class R, class D>
concept CombinesResultsAndData = std::is_invocable_r_v<R, Combine&, std::span<R>, D &&> ||
                                 std::is_invocable_r_v<R, Combine&, std::span<R>, D&>;

template <class Divide, class D, bool keeps_data>
decltype(auto) call_divide(Divide& divide, D& data) {
  if constexpr (keeps_data) {
    return lend(divide, data);
  } else {
    return give(divide, data);
  }
}

template <class D, class R, class Leaf, class Divide, class Solve, class Combine>
struct FromCallbacks {
  using Problem = D;
  using Result = R;
  static constexpr bool keeps_data = !CombinesResults<Combine, R>;

  bool is_leaf(const D& problem) { return static_cast<bool>(std::invoke(leaf, problem)); }

  template <class Receive>
  void divide(D& problem, Receive&& receive) {
    auto&& parts = call_divide<Divide, D, keeps_data>(divide_, problem);
    using Parts = std::remove_reference_t<decltype(parts)>;
    // A range handed over by value is ours to move from; a view of somebody's elements is not.
    constexpr bool ours =
        !std::is_lvalue_reference_v<decltype(parts)> && !std::ranges::view<std::remove_cv_t<Parts>>;
    for (auto&& part : parts) {
      if constexpr (ours && std::constructible_from<D, decltype(std::move(part))>) {
        receive(D(std::move(part)));
      } else {
        receive(D(part));
      }
    }
  }

  R solve(D&& problem) { return give(solve_, problem); }

  R combine(std::span<R> results, D&& problem) {
    if constexpr (!keeps_data) {
      return std::invoke(combine_, results);
    } else if constexpr (std::is_invocable_r_v<R, Combine&, std::span<R>, D&&>) {
      return std::invoke(combine_, results, std::move(problem));
    } else {
      return std::invoke(combine_, results, problem);
    }
  }

  Leaf& leaf;
  Divide& divide_;
  Solve& solve_;
  Combine& combine_;
};

}  // namespace detail

template <std::movable D, std::predicate<const D&> Leaf, detail::Takes<D> Divide,
          detail::Takes<D> Solve, class Combine, class E = SequentialExecutor,
          class R = std::remove_cvref_t<detail::Given<Solve, D>>>
requires std::movable<R> &&
    (detail::CombinesResults<Combine, R> || detail::CombinesResultsAndData<Combine, R, D>)R
    divacon(D data, Leaf&& leaf, Divide&& divide, Solve&& solve, Combine&& combine,
            const E& executor = {}) {
  using Algorithm =
      detail::FromCallbacks<D, R, std::remove_reference_t<Leaf>, std::remove_reference_t<Divide>,
                            std::remove_reference_t<Solve>, std::remove_reference_t<Combine>>;
  static_assert(DivideAndConquer<Algorithm> && Executor<E, Algorithm>);
  Algorithm algorithm{leaf, divide, solve, combine};
  return executor.run(std::move(data), algorithm);
}

}  // namespace exactcsg::skeleton
