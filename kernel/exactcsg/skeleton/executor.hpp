// SPDX-License-Identifier: Apache-2.0
#pragma once

// Where a divide-and-conquer computation runs: in this thread, or on the threads of oneTBB. [Exact]
//
// An executor runs a DivideAndConquer: a problem type, a result type, and
//   expand(Problem&, receive) -> optional<Result>   the result of a leaf; or none, and then every
//                                                   subproblem went, in order, to
//                                                   receive(Problem&&)
// or, in place of expand, is_leaf(const Problem&) -> bool, solve(Problem&&) -> Result and
// divide(Problem&, receive); further
//   combine(span<Result>, Problem&&) -> Result
// and, where a result may make those to its right superfluous (StopsEarly),
//   enough(const Result&, const Problem&) -> bool   of a subproblem's result, and its parent
// divacon.hpp makes one from the arguments of the source. An executor for other machines (MPI, say)
// models the same concept; simulated_executor.hpp and progress_executor.hpp have two more.
//
// LAW executor.1  the result does not depend on the executor, the number of threads or the schedule
//                 if the callbacks compute the same for the same arguments: results are combined in
//                 the order of their subproblems.
// LAW executor.2  an exception of a callback comes out of run; of several, one. Work that has not
//                 begun is then dropped, and nothing of the computation runs on after run returned.
// LAW executor.3  no stack is used in proportion to the depth of the division.
// LAW executor.4  combine of a StopsEarly receives the results up to and with the first, in the
//                 order of the subproblems, that is enough; on every executor. In one thread the
//                 subproblems after it are not begun; with several, what has begun of them is
//                 dropped, and so is what they throw: an exception comes out if, and only if, it
//                 does in one thread.

#include <tbb/global_control.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <atomic>
#include <boost/container/vector.hpp>
#include <concepts>
#include <cstddef>
#include <exception>
#include <iterator>
#include <optional>
#include <ranges>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "exactcsg/support/error.hpp"
#include "exactcsg/support/hand_over.hpp"
#include "exactcsg/support/in_arena.hpp"

namespace exactcsg::skeleton {

template <class A>
concept ExpandsAtOnce = requires(A& algorithm, typename A::Problem& problem,
                                 void (*receive)(typename A::Problem&&)) {
  { algorithm.expand(problem, receive) } -> std::same_as<std::optional<typename A::Result>>;
};
template <class A>
concept ExpandsInSteps = requires(A& algorithm, typename A::Problem& problem,
                                  void (*receive)(typename A::Problem&&)) {
  { algorithm.is_leaf(std::as_const(problem)) } -> std::convertible_to<bool>;
  algorithm.divide(problem, receive);
  { algorithm.solve(std::move(problem)) } -> std::same_as<typename A::Result>;
};

template <class A>
concept DivideAndConquer = std::movable<typename A::Problem> && std::movable<typename A::Result> &&
    (ExpandsAtOnce<A> || ExpandsInSteps<A>)&&requires(A& algorithm, typename A::Problem& problem,
                                                      std::span<typename A::Result> results) {
  { algorithm.combine(results, std::move(problem)) } -> std::same_as<typename A::Result>;
};

// What an executor calls, whichever form the algorithm has.
template <DivideAndConquer A, class Receive>
std::optional<typename A::Result> expand(A& algorithm, typename A::Problem& problem,
                                         Receive&& receive) {
  if constexpr (ExpandsAtOnce<A>) {
    return algorithm.expand(problem, receive);
  } else {
    if (algorithm.is_leaf(std::as_const(problem))) return algorithm.solve(std::move(problem));
    algorithm.divide(problem, receive);
    return std::nullopt;
  }
}

template <class A>
concept StopsEarly = DivideAndConquer<A> &&
    requires(A& algorithm, const typename A::Result& result, const typename A::Problem& problem) {
  { algorithm.enough(result, problem) } -> std::convertible_to<bool>;
};

namespace detail {

// A vector whose elements are in one array: std::vector<bool> is none.
template <class T>
using Array =
    std::conditional_t<std::same_as<T, bool>, boost::container::vector<T>, std::vector<T>>;

struct NeverInterrupted {
  void operator()() const noexcept {}
};

// False if neither combine nor enough looks at the problem; they can then be called without it.
template <class A>
constexpr bool keeps_data = true;
template <class A>
requires requires { A::keeps_data; }
constexpr bool keeps_data<A> = A::keeps_data;

// An explicit stack of the problems not yet solved, and one of the results not yet combined.
template <DivideAndConquer A, class Interrupt>
class SequentialRun {
 public:
  using Problem = typename A::Problem;
  using Result = typename A::Result;

  SequentialRun(A& algorithm, Interrupt& interrupt)
      : algorithm_(algorithm), interrupt_(interrupt) {}

  Result operator()(Problem root) {
    pending_.push_back(std::move(root));
    divided_.push_back({1, 0});  // of which the root is the only subproblem
    while (true) {
      interrupt_();
      if (divided_.back().unsolved != 0) {
        expand_last();
      } else if (divided_.size() > 1) {
        combine_last();
      } else {
        return std::move(results_.back());
      }
    }
  }

 private:
  // A divided problem. The subproblems without a result are the last of pending_, the first of them
  // on top; below them is the problem itself if it is kept.
  struct Divided {
    std::size_t unsolved;
    std::size_t first_result;
  };

  // What expand gives the subproblems to: one after the other, or all in a range that is ours to
  // move from. The latter is the last that expand does, so that no place of their own is needed.
  struct Receiver {
    SequentialRun& run;
    bool has_all = false;

    void operator()(Problem&& part) { run.parts_.push_back(std::move(part)); }
    template <std::ranges::bidirectional_range Parts>
    requires std::ranges::common_range<Parts>
    void all(Parts& parts) {
      run.divide_last_into(parts);
      has_all = true;
    }
  };

  // A problem stays where it is until it is solved or divided: it is moved in once, and lent.
  void expand_last() {
    Receiver receiver{*this};
    if (auto solved = expand(algorithm_, pending_.back(), receiver)) {
      pending_.pop_back();
      return receive_result(std::move(*solved));
    }
    if (receiver.has_all) return;
    divide_last_into(parts_);
    parts_.clear();
  }

  template <class Parts>
  void divide_last_into(Parts& parts) {
    if constexpr (!keeps_data<A>) pending_.pop_back();
    const std::size_t before = pending_.size();
    for (auto part = std::ranges::end(parts); part != std::ranges::begin(parts);) {
      pending_.push_back(std::move(*--part));
    }
    divided_.push_back({pending_.size() - before, results_.size()});
  }

  void combine_last() {
    const std::size_t first = divided_.back().first_result;
    const std::span<Result> results(results_.data() + first, results_.size() - first);
    auto result = [&] {
      if constexpr (keeps_data<A>) {
        return algorithm_.combine(results, std::move(pending_.back()));
      } else {
        return algorithm_.combine(results);
      }
    }();
    if constexpr (keeps_data<A>) pending_.pop_back();
    divided_.pop_back();
    results_.erase(results_.begin() + static_cast<std::ptrdiff_t>(first), results_.end());
    receive_result(std::move(result));
  }

  void receive_result(Result&& result) {
    std::size_t& unsolved = divided_.back().unsolved;
    --unsolved;
    if constexpr (StopsEarly<A>) {
      if (divided_.size() > 1 && is_enough(result)) {
        pending_.erase(pending_.end() - static_cast<std::ptrdiff_t>(unsolved), pending_.end());
        unsolved = 0;
      }
    }
    results_.push_back(std::move(result));
  }

  bool is_enough(const Result& result) requires StopsEarly<A> {
    if constexpr (keeps_data<A>) {
      const Problem& parent =
          *(pending_.end() - static_cast<std::ptrdiff_t>(divided_.back().unsolved) - 1);
      return algorithm_.enough(result, parent);
    } else {
      return algorithm_.enough(result);
    }
  }

  A& algorithm_;
  Interrupt& interrupt_;
  std::vector<Problem> pending_;
  std::vector<Divided> divided_;
  Array<Result> results_;
  std::vector<Problem> parts_;
};

template <DivideAndConquer A, class Interrupt = NeverInterrupted>
typename A::Result run_sequentially(typename A::Problem root, A& algorithm,
                                    Interrupt interrupt = {}) {
  return SequentialRun<A, Interrupt>(algorithm, interrupt)(std::move(root));
}

// Thrown in a task after another has failed, or an enclosing group of tasks was cancelled, or where
// its result is not wanted any more. It does not leave the run.
struct Interrupted {};

// Which of several siblings, in their order, is the last that counts.
class LastThatCounts {
 public:
  explicit LastThatCounts(std::size_t siblings) : index_(siblings) {}
  std::size_t index() const noexcept { return index_.load(std::memory_order_relaxed); }
  void lower_to(std::size_t index) noexcept {
    std::size_t before = this->index();
    while (index < before &&
           !index_.compare_exchange_weak(before, index, std::memory_order_relaxed)) {
    }
  }

 private:
  std::atomic<std::size_t> index_;
};

// Where a task stands among its siblings, and its ancestors among theirs.
struct Place {
  const LastThatCounts* siblings = nullptr;
  std::size_t index = 0;
  const Place* above = nullptr;

  bool is_superfluous() const noexcept {
    for (const Place* place = this; place != nullptr; place = place->above) {
      if (place->siblings != nullptr && place->index > place->siblings->index()) return true;
    }
    return false;
  }
};

template <DivideAndConquer A, class WorthATask>
class ParallelRun {
 public:
  using Problem = typename A::Problem;
  using Result = typename A::Result;

  ParallelRun(A& algorithm, const WorthATask& worth_a_task)
      : algorithm_(algorithm), worth_a_task_(worth_a_task) {}

  // None if it was interrupted. THROWS what a callback threw, or one of several.
  std::optional<Result> run(Problem problem, unsigned levels) {
    try {
      return solved(std::move(problem), levels, Place{});
    } catch (const Interrupted&) {
      if (failure_) std::rethrow_exception(failure_);
      return std::nullopt;
    }
  }

 private:
  struct Slot {
    std::optional<Result> result;
    std::exception_ptr failure;
  };

  // Asked before every step. What oneTBB knows costs more to ask, and is asked less often.
  class Interrupt {
   public:
    Interrupt(const ParallelRun& run, const Place& place) : run_(run), place_(place) {}
    void operator()() {
      if (run_.has_failed_.load(std::memory_order_relaxed)) throw Interrupted{};
      if (steps_++ % 64 == 0 && tbb::is_current_task_group_canceling()) throw Interrupted{};
      if constexpr (StopsEarly<A>) {
        if (place_.is_superfluous()) throw Interrupted{};
      }
    }

   private:
    const ParallelRun& run_;
    const Place& place_;
    unsigned steps_ = 0;
  };

  Result solved(Problem problem, unsigned levels, const Place& place) {
    Interrupt interrupt(*this, place);
    interrupt();
    if (levels == 0 || !worth_a_task_(std::as_const(problem))) {
      return run_sequentially(std::move(problem), algorithm_, interrupt);
    }
    std::vector<Problem> parts;
    if (auto solved = expand(algorithm_, problem,
                             [&](Problem&& part) { parts.push_back(std::move(part)); })) {
      return std::move(*solved);
    }
    Array<Result> results = all(parts, problem, levels - 1, place);
    return algorithm_.combine(std::span(results.data(), results.size()), std::move(problem));
  }

  Array<Result> all(std::vector<Problem>& parts, [[maybe_unused]] const Problem& problem,
                    unsigned levels, const Place& place) {
    std::vector<Slot> slots(parts.size());
    LastThatCounts last(parts.size());
    const auto solve = [&](std::size_t i) {
      if constexpr (StopsEarly<A>) {
        solve_unless_superfluous(parts[i], problem, levels, Place{&last, i, &place}, slots[i],
                                 last);
      } else {
        solve_or_fail(parts[i], levels, place, slots[i]);
      }
    };
    const exactcsg::detail::TakeOverAtEnd before_unwinding(&slots);
    tbb::task_group group;
    for (std::size_t i = 1; i < parts.size(); ++i) {
      const auto work = [&solve, i] { solve(i); };
      group.run(exactcsg::detail::HandedOver(work, &slots));
    }
    const auto first = [&] {
      if (!parts.empty()) solve(0);
    };
    if (group.run_and_wait(first) == tbb::canceled) throw Interrupted{};
    exactcsg::detail::take_over(&slots);
    return results_of(slots, last.index());
  }

  // The first exception ends the run; it comes out even if those that it interrupts are seen first.
  void solve_or_fail(Problem& part, unsigned levels, const Place& place, Slot& slot) {
    try {
      slot.result.emplace(solved(std::move(part), levels, place));
    } catch (const Interrupted&) {
      throw;
    } catch (...) {
      if (!has_failed_.exchange(true)) failure_ = std::current_exception();
      throw Interrupted{};
    }
  }

  // Exceptions wait in the slots: whether they come out is known when all siblings to the left are
  // done.
  void solve_unless_superfluous(Problem& part, const Problem& problem, unsigned levels,
                                const Place& place, Slot& slot, LastThatCounts& last) {
    try {
      slot.result.emplace(solved(std::move(part), levels, place));
      if (algorithm_.enough(std::as_const(*slot.result), problem)) last.lower_to(place.index);
    } catch (const Interrupted&) {
    } catch (...) {
      slot.failure = std::current_exception();
      last.lower_to(place.index);
    }
  }

  static Array<Result> results_of(std::vector<Slot>& slots, std::size_t last) {
    Array<Result> results;
    results.reserve(slots.size());
    for (std::size_t i = 0; i < slots.size() && i <= last; ++i) {
      if (slots[i].failure) std::rethrow_exception(slots[i].failure);
      if (!slots[i].result) throw Interrupted{};
      results.push_back(std::move(*slots[i].result));
    }
    return results;
  }

  A& algorithm_;
  const WorthATask& worth_a_task_;
  std::atomic<bool> has_failed_ = false;
  std::exception_ptr failure_;
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
    detail::ParallelRun<A, WorthATask> parallel(algorithm, worth_a_task_);
    std::optional<typename A::Result> result;
    const exactcsg::detail::TakeOverAtEnd before_unwinding(&result);
    exactcsg::detail::in_arena(concurrency(), [&] {
      const exactcsg::detail::HandOverAtEnd done(&result);
      tbb::task_group group;  // so that an outer computation's cancellation is not taken for ours
      group.run_and_wait([&] { result = parallel.run(std::move(problem), levels_); });
    });
    exactcsg::detail::take_over(&result);
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
