// SPDX-License-Identifier: Apache-2.0
#pragma once

// Where a divide-and-conquer computation runs: in this thread, or on the threads of oneTBB. [Exact]
//
// An executor runs a DivideAndConquer: a problem type, a result type, and
//   is_leaf(const Problem&) -> bool
//   divide(Problem&, receive)       gives every subproblem, in order, to receive(Problem&&)
//   solve(Problem&&) -> Result
//   combine(span<Result>, Problem&&) -> Result
// divacon.hpp makes one from the five arguments of the source. An executor for other machines (MPI,
// say) models the same concept.
//
// LAW executor.1  the result does not depend on the executor, the number of threads or the schedule
//                 if the callbacks compute the same for the same arguments: results are combined in
//                 the order of their subproblems.
// LAW executor.2  an exception of a callback comes out of run; of several, one. Work that has not
//                 begun is then dropped, and nothing of the computation runs on after run returned.
// LAW executor.3  no stack is used in proportion to the depth of the division.

#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <boost/container/vector.hpp>
#include <concepts>
#include <cstddef>
#include <iterator>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "exactcsg/skeleton/hand_over.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg::skeleton {

template <class A>
concept DivideAndConquer = std::movable<typename A::Problem> && std::movable<typename A::Result> &&
    requires(A& algorithm, typename A::Problem& problem, std::span<typename A::Result> results,
             void (*receive)(typename A::Problem&&)) {
  { algorithm.is_leaf(std::as_const(problem)) } -> std::convertible_to<bool>;
  algorithm.divide(problem, receive);
  { algorithm.solve(std::move(problem)) } -> std::same_as<typename A::Result>;
  { algorithm.combine(results, std::move(problem)) } -> std::same_as<typename A::Result>;
};

namespace detail {

// A vector whose elements are in one array: std::vector<bool> is none.
template <class T>
using Array =
    std::conditional_t<std::same_as<T, bool>, boost::container::vector<T>, std::vector<T>>;

struct NeverInterrupted {
  void operator()() const noexcept {}
};

// An explicit stack of what is still to do, and one of the results not yet combined.
template <DivideAndConquer A, class Interrupt = NeverInterrupted>
typename A::Result run_sequentially(typename A::Problem root, A& algorithm,
                                    Interrupt interrupt = {}) {
  using Problem = typename A::Problem;
  struct Join {
    Problem problem;
    std::size_t first_result;
  };
  std::vector<std::variant<Problem, Join>> pending;
  Array<typename A::Result> results;
  std::vector<Problem> parts;
  pending.emplace_back(std::in_place_index<0>, std::move(root));
  while (!pending.empty()) {
    interrupt();
    if (auto* join = std::get_if<1>(&pending.back())) {
      const auto first = results.begin() + static_cast<std::ptrdiff_t>(join->first_result);
      auto result = algorithm.combine(
          std::span(results.data() + join->first_result, results.size() - join->first_result),
          std::move(join->problem));
      results.erase(first, results.end());
      results.push_back(std::move(result));
      pending.pop_back();
      continue;
    }
    Problem problem = std::move(*std::get_if<0>(&pending.back()));
    pending.pop_back();
    if (algorithm.is_leaf(std::as_const(problem))) {
      results.push_back(algorithm.solve(std::move(problem)));
      continue;
    }
    const std::size_t join = pending.size();
    pending.emplace_back(std::in_place_index<1>, Join{std::move(problem), results.size()});
    parts.clear();
    algorithm.divide(std::get_if<1>(&pending[join])->problem,
                     [&](Problem&& part) { parts.push_back(std::move(part)); });
    for (auto part = parts.rbegin(); part != parts.rend(); ++part) {
      pending.emplace_back(std::in_place_index<0>, std::move(*part));
    }
  }
  return std::move(results.back());
}

// Thrown in a task whose group another task has failed: oneTBB drops it for the other's exception.
struct Interrupted {};

inline void throw_if_cancelled() {
  if (tbb::is_current_task_group_canceling()) throw Interrupted{};
}

template <DivideAndConquer A, class WorthATask>
class ParallelRun {
 public:
  using Problem = typename A::Problem;
  using Result = typename A::Result;

  ParallelRun(A& algorithm, const WorthATask& worth_a_task)
      : algorithm_(algorithm), worth_a_task_(worth_a_task) {}

  Result operator()(Problem problem, unsigned levels) const {
    throw_if_cancelled();
    if (levels == 0 || !worth_a_task_(std::as_const(problem))) {
      return run_sequentially(std::move(problem), algorithm_, throw_if_cancelled);
    }
    if (algorithm_.is_leaf(std::as_const(problem))) return algorithm_.solve(std::move(problem));
    std::vector<Problem> parts;
    algorithm_.divide(problem, [&](Problem&& part) { parts.push_back(std::move(part)); });
    Array<Result> results = all(parts, levels - 1);
    return algorithm_.combine(std::span(results.data(), results.size()), std::move(problem));
  }

 private:
  Array<Result> all(std::vector<Problem>& parts, unsigned levels) const {
    std::vector<std::optional<Result>> slots(parts.size());
    const TakeOverAtEnd before_unwinding(&slots);
    tbb::task_group group;
    for (std::size_t i = 1; i < parts.size(); ++i) {
      const auto work = [&, i] { slots[i].emplace((*this)(std::move(parts[i]), levels)); };
      group.run(HandedOver(work, &slots));
    }
    const auto first = [&] {
      if (!parts.empty()) slots[0].emplace((*this)(std::move(parts[0]), levels));
    };
    if (group.run_and_wait(first) == tbb::canceled) throw Interrupted{};
    take_over(&slots);
    Array<Result> results;
    results.reserve(slots.size());
    for (std::optional<Result>& slot : slots) results.push_back(std::move(*slot));
    return results;
  }

  A& algorithm_;
  const WorthATask& worth_a_task_;
};

}  // namespace detail

class SequentialExecutor {
 public:
  template <DivideAndConquer A>
  typename A::Result run(typename A::Problem problem, A& algorithm) const {
    return detail::run_sequentially(std::move(problem), algorithm);
  }
};

struct AlwaysWorthATask {
  template <class Problem>
  constexpr bool operator()(const Problem&) const noexcept {
    return true;
  }
};

// Every subproblem of the first `levels` levels that is worth_a_task is a task of its own; what is
// below is solved by that task alone.
// REQUIRES the callbacks may be called from several threads at once.
template <class WorthATask = AlwaysWorthATask>
class ParallelExecutor {
 public:
  // threads == 0: as many as oneTBB may use (of this machine, or as limited by a global_control);
  // never more than that. One thread runs the same algorithm as more do.
  explicit ParallelExecutor(unsigned threads = 0, unsigned levels = 16,
                            WorthATask worth_a_task = {})
      : threads_(threads), levels_(levels), worth_a_task_(std::move(worth_a_task)) {}

  template <DivideAndConquer A>
  requires std::predicate<const WorthATask&, const typename A::Problem&>
  typename A::Result run(typename A::Problem problem, A& algorithm) const {
    const detail::ParallelRun<A, WorthATask> parallel(algorithm, worth_a_task_);
    std::optional<typename A::Result> result;
    tbb::task_arena arena(concurrency());
    const detail::TakeOverAtEnd before_unwinding(&result);
    detail::hand_over(&arena);
    arena.execute([&] {  // perhaps by another thread, if all places of the arena are taken
      detail::take_over(&arena);
      const detail::HandOverAtEnd done(&result);
      tbb::task_group group;  // so that an outer computation's cancellation is not taken for ours
      group.run_and_wait([&] { result.emplace(parallel(std::move(problem), levels_)); });
    });
    detail::take_over(&result);
    if (!result) throw Error(ErrorId::Cancelled, {"an enclosing group of tasks", ""});
    return std::move(*result);
  }

 private:
  // oneTBB prints a warning when asked for more threads than it may use.
  int concurrency() const {
    const auto allowed =
        tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    return static_cast<int>(threads_ == 0 ? allowed : std::min<std::size_t>(threads_, allowed));
  }

  unsigned threads_;
  unsigned levels_;
  WorthATask worth_a_task_;
};

template <class E, class A>
concept Executor = DivideAndConquer<A> &&
    requires(const E& executor, typename A::Problem problem, A& algorithm) {
  { executor.run(std::move(problem), algorithm) } -> std::same_as<typename A::Result>;
};

}  // namespace exactcsg::skeleton
