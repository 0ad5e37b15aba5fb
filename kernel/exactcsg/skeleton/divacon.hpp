// SPDX-License-Identifier: Apache-2.0
#pragma once

// Divide and conquer. [Exact]
//
//   divacon(data, leaf, divide, solve, combine [, executor]) -> R
//   divacon(data, expand, combine [, executor]) -> R
//
// leaf(const D&) -> bool            is it small enough to be solved directly?
// divide(D) -> range of D           the subproblems, in order; there may be none
// solve(D) -> R                     the result of a leaf
// expand(D) -> Expansion<R, range>  all three at once: Solved{result}, or Divided{subproblems}, so
//                                   that what was found out to know a leaf need not be found again
// combine(span<R>) -> R             the result from those of the subproblems, in their order, or
// combine(span<R>, D) -> R          the same, from the original data as well
//
// The results in the span belong to combine, which may move them out. divide, solve and expand may
// take their argument by value, const D&, D& or D&&. In the second form of combine, divide and
// expand get an lvalue: what they move out, combine does not see.
//
// An early out: with EarlyOut{combine, enough} in place of combine, where enough(const R&) or
// enough(const R&, const D& parent) says of the result of a subproblem that those after it do not
// matter.
//
// LAW divacon.1  divacon(x) == solve(x) if leaf(x), else combine([divacon(y) : y in divide(x)]), or
//                combine([...], x).
// LAW divacon.2  leaf, divide and solve or combine are called once for every problem.
// LAW divacon.3  D and R need only be movable.
// LAW divacon.4  divacon(x, leaf, divide, solve, combine) == divacon(x, expand, combine) where
//                expand(y) is Solved{solve(y)} if leaf(y), else Divided{divide(y)}.
// LAW divacon.5  an EarlyOut gives combine the results up to and with the first, in their order,
//                that is enough, on every executor; enough is asked once for a result. Where the
//                results after such a one do not change what combine returns, the result is that
//                without the early out. See LAW executor.4 for what is then not done.
// See executor.hpp for LAW executor.1 to .4: order, exceptions, depth.
// REQUIRES the division ends.
// COST: O(problems) calls, and memory for the subproblems that wait (sequential).
//
// Source: Davy and Dew, section 3.1 (both forms of combine), section 3.4 (expand ends its
// leaf/solve problem), section 7.3 (early outs, which it misses); executors are ours.

#include <concepts>
#include <functional>
#include <optional>
#include <ranges>
#include <span>
#include <type_traits>
#include <utility>
#include <variant>

#include "exactcsg/skeleton/executor.hpp"

namespace exactcsg::skeleton {

// What expand returns.
template <class R>
struct Solved {
  R result;
};
template <class Parts>
struct Divided {
  Parts parts;
};
template <class R>
Solved(R) -> Solved<R>;
template <class Parts>
Divided(Parts) -> Divided<Parts>;
template <class R, class Parts>
using Expansion = std::variant<Solved<R>, Divided<Parts>>;

// A combine that may stop the siblings of a result.
template <class Combine, class Enough>
struct EarlyOut {
  Combine combine;
  Enough enough;

  template <class... Arguments>
  requires std::invocable<Combine&, Arguments...>
  decltype(auto) operator()(Arguments&&... arguments) {
    return std::invoke(combine, std::forward<Arguments>(arguments)...);
  }
  template <class... Arguments>
  requires std::invocable<const Combine&, Arguments...>
  decltype(auto) operator()(Arguments&&... arguments) const {
    return std::invoke(combine, std::forward<Arguments>(arguments)...);
  }
};
template <class Combine, class Enough>
EarlyOut(Combine, Enough) -> EarlyOut<Combine, Enough>;

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

template <class Combine, class R>
concept StopsByResult = requires(Combine& combine, const R& result) {
  { combine.enough(result) } -> std::convertible_to<bool>;
};
template <class Combine, class R, class D>
concept StopsByResultAndData = requires(Combine& combine, const R& result, const D& data) {
  { combine.enough(result, data) } -> std::convertible_to<bool>;
};

template <class Divide, class D, bool keeps_data>
decltype(auto) call_divide(Divide& divide, D& data) {
  if constexpr (keeps_data) {
    return lend(divide, data);
  } else {
    return give(divide, data);
  }
}

template <class D, class Parts, class Receive>
void hand_out(Parts&& parts, Receive& receive) {
  // A range handed over by value is ours to move from; a view of somebody's elements is not.
  constexpr bool ours =
      !std::is_lvalue_reference_v<Parts> && !std::ranges::view<std::remove_cvref_t<Parts>>;
  if constexpr (ours && requires { receive.all(parts); }) {
    if constexpr (std::same_as<std::ranges::range_reference_t<Parts>, D&>) {
      return receive.all(parts);
    }
  }
  for (auto&& part : parts) {
    if constexpr (ours && std::same_as<decltype(part), D&>) {
      receive(std::move(part));
    } else if constexpr (ours && std::constructible_from<D, decltype(std::move(part))>) {
      receive(D(std::move(part)));
    } else {
      receive(D(part));
    }
  }
}

// What combine decides, whichever form the rest has.
template <class D, class R, class Combine>
struct Combiner {
  using Problem = D;
  using Result = R;
  static constexpr bool keeps_data =
      !CombinesResults<Combine, R> || StopsByResultAndData<Combine, R, D>;

  R combine(std::span<R> results) requires(!keeps_data) { return std::invoke(combine_, results); }
  R combine(std::span<R> results, D&& problem) {
    if constexpr (CombinesResults<Combine, R>) {
      return std::invoke(combine_, results);
    } else if constexpr (std::is_invocable_r_v<R, Combine&, std::span<R>, D&&>) {
      return std::invoke(combine_, results, std::move(problem));
    } else {
      return std::invoke(combine_, results, problem);
    }
  }

  bool enough(const R& result) requires StopsByResult<Combine, R> {
    return static_cast<bool>(combine_.enough(result));
  }
  bool enough(const R& result, const D&) requires(StopsByResult<Combine, R> &&
                                                  !StopsByResultAndData<Combine, R, D>) {
    return static_cast<bool>(combine_.enough(result));
  }
  bool enough(const R& result, const D& problem) requires StopsByResultAndData<Combine, R, D> {
    return static_cast<bool>(combine_.enough(result, problem));
  }

  Combine& combine_;
};

template <class D, class R, class Leaf, class Divide, class Solve, class Combine>
struct FromCallbacks : Combiner<D, R, Combine> {
  template <class Receive>
  std::optional<R> expand(D& problem, Receive&& receive) {
    if (static_cast<bool>(std::invoke(leaf, std::as_const(problem)))) return give(solve, problem);
    using Base = Combiner<D, R, Combine>;
    hand_out<D>(call_divide<Divide, D, Base::keeps_data>(divide, problem), receive);
    return std::nullopt;
  }

  Leaf& leaf;
  Divide& divide;
  Solve& solve;
};

template <class D, class R, class Expand, class Combine>
struct FromExpand : Combiner<D, R, Combine> {
  template <class Receive>
  std::optional<R> expand(D& problem, Receive&& receive) {
    using Base = Combiner<D, R, Combine>;
    auto step = call_divide<Expand, D, Base::keeps_data>(expand_, problem);
    if (auto* solved = std::get_if<0>(&step)) return std::move(solved->result);
    hand_out<D>(std::move(std::get_if<1>(&step)->parts), receive);
    return std::nullopt;
  }

  Expand& expand_;
};

template <class T>
struct ExpansionResult {};
template <class R, class Parts>
struct ExpansionResult<Expansion<R, Parts>> {
  using Type = R;
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
  Algorithm algorithm{{combine}, leaf, divide, solve};
  return executor.run(std::move(data), algorithm);
}

template <std::movable D, detail::Takes<D> Expand, class Combine, class E = SequentialExecutor,
          class R =
              typename detail::ExpansionResult<std::remove_cvref_t<detail::Given<Expand, D>>>::Type>
requires std::movable<R> &&
    (detail::CombinesResults<Combine, R> || detail::CombinesResultsAndData<Combine, R, D>)R
    divacon(D data, Expand&& expand, Combine&& combine, const E& executor = {}) {
  using Algorithm =
      detail::FromExpand<D, R, std::remove_reference_t<Expand>, std::remove_reference_t<Combine>>;
  static_assert(DivideAndConquer<Algorithm> && Executor<E, Algorithm>);
  Algorithm algorithm{{combine}, expand};
  return executor.run(std::move(data), algorithm);
}

}  // namespace exactcsg::skeleton
