// SPDX-License-Identifier: Apache-2.0
#pragma once

// How much faster would p workers be? Runs the computation in this thread, records its task graph,
// and schedules that on any number of workers. [Approximate: the costs are measured; the schedule
// of given costs is exact]
//
//   TaskGraph graph;
//   divacon(..., SimulatedExecutor(graph));
//   schedule(graph, 8).speed_up()
//
// The graph has two tasks for every problem: expand (leaf test, and solve or divide), which needs
// the expand of the problem above, and combine, which needs the results of all subproblems. A cost
// is the difference of two readings of a clock: nanoseconds by default; CallCount makes every task
// cost 1; a clock of the user's may read what its callbacks have counted.
//
// LAW simulate.1  the result, order and number of calls are those of SequentialExecutor.
// LAW simulate.2  work() is the sum of all costs; span() the greatest sum along a path.
// LAW simulate.3  a schedule is greedy: no worker is idle while a task is ready, and of the ready
//                 tasks the first in the order of the sequential run is taken. Hence
//                 max(work / p, span) <= length <= work / p + span (Graham).
// LAW simulate.4  with one worker the length is the work; with as many as there are tasks, the
// span. What a schedule does not know of: the cost of a task itself, caches, memory that is shared.
// COST: schedule O(n log n) for n problems.
//
// Source: R. L. Graham, Bounds on multiprocessing timing anomalies (greedy schedules); R. P. Brent
// (work and span).

#include <algorithm>
#include <chrono>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <queue>
#include <span>
#include <utility>
#include <vector>

#include "exactcsg/skeleton/executor.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg::skeleton {

struct Nanoseconds {
  std::uint64_t operator()() const {
    return static_cast<std::uint64_t>(
        std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count());
  }
};
// Every task costs 1.
class CallCount {
 public:
  std::uint64_t operator()() noexcept { return readings_++; }

 private:
  std::uint64_t readings_ = 0;
};
template <class C>
concept CostClock = requires(C& clock) {
  { clock() } -> std::convertible_to<std::uint64_t>;
};

class TaskGraph {
 public:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  // In the order in which the sequential run gave birth to them: a parent before its children.
  struct Problem {
    std::size_t parent = none;
    std::uint64_t expand_cost = 0;
    std::uint64_t combine_cost = 0;
    bool is_expanded = false;  // false: an early out dropped it
    bool is_divided = false;
  };

  std::span<const Problem> problems() const noexcept { return problems_; }

  std::uint64_t work() const noexcept {
    std::uint64_t sum = 0;
    for (const Problem& problem : problems_) sum += problem.expand_cost + problem.combine_cost;
    return sum;
  }

  std::uint64_t span() const {
    std::vector<std::uint64_t> below(problems_.size(), 0);  // the longest of the subproblems
    for (std::size_t i = problems_.size(); i-- > 0;) {
      const Problem& problem = problems_[i];
      const std::uint64_t length = problem.expand_cost + below[i] + problem.combine_cost;
      if (problem.parent == none) return length;
      below[problem.parent] = std::max(below[problem.parent], length);
    }
    return 0;
  }

  // For executors, these two.
  void clear() noexcept { problems_.clear(); }
  std::size_t add(std::size_t parent) {
    problems_.push_back({parent});
    return problems_.size() - 1;
  }
  Problem& operator[](std::size_t index) noexcept { return problems_[index]; }

 private:
  std::vector<Problem> problems_;
};

struct Schedule {
  std::uint64_t work = 0;
  std::uint64_t length = 0;  // when the last task ends
  double speed_up() const noexcept {
    return length == 0 ? 1.0 : static_cast<double>(work) / static_cast<double>(length);
  }
};

namespace detail {

// An event simulation: tasks become ready, are started in order of priority, and end.
class GreedySchedule {
 public:
  GreedySchedule(const TaskGraph& graph, std::size_t workers)
      : problems_(graph.problems()), idle_(workers), awaited_(problems_.size(), 0) {
    children_begin_.assign(problems_.size() + 1, 0);
    for (const auto& problem : problems_) {
      if (problem.parent == TaskGraph::none) continue;
      ++children_begin_[problem.parent + 1];
      if (problem.is_expanded) ++awaited_[problem.parent];
    }
    for (std::size_t i = 0; i < problems_.size(); ++i) {
      children_begin_[i + 1] += children_begin_[i];
    }
    children_.resize(problems_.empty() ? 0 : problems_.size() - 1);
    std::vector<std::size_t> next(children_begin_.begin(), children_begin_.end());
    for (std::size_t i = 1; i < problems_.size(); ++i) children_[next[problems_[i].parent]++] = i;
    number_in_order();
  }

  std::uint64_t length() {
    if (!problems_.empty()) ready_.push(task(0, false));
    std::uint64_t now = 0;
    while (!ready_.empty() || !running_.empty()) {
      for (; idle_ > 0 && !ready_.empty(); --idle_) {
        running_.push({now + cost(ready_.top()), ready_.top()});
        ready_.pop();
      }
      now = running_.top().first;
      while (!running_.empty() && running_.top().first == now) {
        const Task ended = running_.top().second;
        running_.pop();
        ++idle_;
        end(ended);
      }
    }
    return now;
  }

 private:
  struct Task {
    std::size_t order;  // in the sequential run
    std::size_t problem;
    bool combines;
    friend auto operator<=>(const Task&, const Task&) = default;
  };

  // When the sequential run expands and combines every problem.
  void number_in_order() {
    expand_order_.resize(problems_.size());
    combine_order_.resize(problems_.size());
    std::vector<std::pair<std::size_t, bool>> pending;
    if (!problems_.empty()) pending.push_back({0, false});
    for (std::size_t order = 0; !pending.empty(); ++order) {
      const auto [problem, combines] = pending.back();
      pending.pop_back();
      (combines ? combine_order_ : expand_order_)[problem] = order;
      if (combines || !problems_[problem].is_divided) continue;
      pending.push_back({problem, true});
      for (std::size_t i = children_begin_[problem + 1]; i-- > children_begin_[problem];) {
        if (problems_[children_[i]].is_expanded) pending.push_back({children_[i], false});
      }
    }
  }

  Task task(std::size_t problem, bool combines) const {
    return {(combines ? combine_order_ : expand_order_)[problem], problem, combines};
  }
  std::uint64_t cost(const Task& of) const {
    const auto& problem = problems_[of.problem];
    return of.combines ? problem.combine_cost : problem.expand_cost;
  }

  void end(const Task& ended) {
    if (!ended.combines && problems_[ended.problem].is_divided) {
      if (awaited_[ended.problem] == 0) ready_.push(task(ended.problem, true));
      for (std::size_t i = children_begin_[ended.problem]; i < children_begin_[ended.problem + 1];
           ++i) {
        if (problems_[children_[i]].is_expanded) ready_.push(task(children_[i], false));
      }
      return;
    }
    const std::size_t parent = problems_[ended.problem].parent;
    if (parent != TaskGraph::none && --awaited_[parent] == 0) ready_.push(task(parent, true));
  }

  template <class T>
  using Earliest = std::priority_queue<T, std::vector<T>, std::greater<>>;

  std::span<const TaskGraph::Problem> problems_;
  std::size_t idle_;
  std::vector<std::size_t> awaited_;  // subproblems without a result
  std::vector<std::size_t> children_begin_;
  std::vector<std::size_t> children_;
  std::vector<std::size_t> expand_order_;
  std::vector<std::size_t> combine_order_;
  Earliest<Task> ready_;
  Earliest<std::pair<std::uint64_t, Task>> running_;
};

template <DivideAndConquer A, CostClock Clock>
class Recorded {
 public:
  struct Problem {
    typename A::Problem problem;
    std::size_t index;
  };
  using Result = typename A::Result;

  Recorded(A& algorithm, TaskGraph& graph, Clock& clock)
      : algorithm_(algorithm), graph_(graph), clock_(clock) {}

  template <class Receive>
  std::optional<Result> expand(Problem& problem, Receive&& receive) {
    std::vector<typename A::Problem> parts;
    const std::uint64_t begin = clock_();
    auto solved = skeleton::expand(algorithm_, problem.problem, [&](typename A::Problem&& part) {
      parts.push_back(std::move(part));
    });
    const std::uint64_t end = clock_();
    auto& record = graph_[problem.index];
    record.expand_cost = end - begin;
    record.is_expanded = true;
    record.is_divided = !solved;
    for (auto& part : parts) receive(Problem{std::move(part), graph_.add(problem.index)});
    return solved;
  }

  Result combine(std::span<Result> results, Problem&& problem) {
    const std::uint64_t begin = clock_();
    Result result = algorithm_.combine(results, std::move(problem.problem));
    graph_[problem.index].combine_cost = clock_() - begin;
    return result;
  }

  bool enough(const Result& result, const Problem& parent) requires StopsEarly<A> {
    return algorithm_.enough(result, parent.problem);
  }

 private:
  A& algorithm_;
  TaskGraph& graph_;
  Clock& clock_;
};

}  // namespace detail

// THROWS Error(BadArgument) without workers.
inline Schedule schedule(const TaskGraph& graph, std::size_t workers) {
  if (workers == 0) throw Error(ErrorId::BadArgument, {"no workers", "at least one"});
  return {graph.work(), detail::GreedySchedule(graph, workers).length()};
}

// The graph is that of the last run. REQUIRES not used by two runs at once.
template <CostClock Clock = Nanoseconds>
class SimulatedExecutor {
 public:
  explicit SimulatedExecutor(TaskGraph& graph, Clock clock = {})
      : graph_(&graph), clock_(std::move(clock)) {}

  template <DivideAndConquer A>
  typename A::Result run(typename A::Problem problem, A& algorithm) const {
    Clock clock = clock_;
    graph_->clear();
    detail::Recorded<A, Clock> recorded(algorithm, *graph_, clock);
    return detail::run_sequentially<decltype(recorded)>(
        {std::move(problem), graph_->add(TaskGraph::none)}, recorded);
  }

 private:
  TaskGraph* graph_;
  Clock clock_;
};

}  // namespace exactcsg::skeleton
