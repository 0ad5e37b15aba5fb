// SPDX-License-Identifier: Apache-2.0
#pragma once

// Any executor, watched: how far the computation has come, and a way to stop it. [Exact]
//
//   divacon(..., ProgressExecutor(ParallelExecutor<>(), progress, "decompose"))
//
// The whole counts as progress.total() units; every subproblem has an equal share of its problem's
// (to a unit), and the share of a leaf is done when the leaf is.
//
// LAW progress.1  the result is that of the executor within.
// LAW progress.2  done() never decreases and never exceeds total(); when run has returned, it is
//                 total().
// LAW progress.3  after progress.cancel(reason), run throws Error(reason), and no problem is begun
//                 that had not begun when the cancellation was seen.
// progress outlives the call and may be read and cancelled by any thread meanwhile.
// COST: for every problem one load of an atomic, and an atomic addition at leaves.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "exactcsg/skeleton/executor.hpp"
#include "exactcsg/support/progress.hpp"

namespace exactcsg::skeleton {

namespace detail {

template <DivideAndConquer A>
class Watched {
 public:
  struct Problem {
    typename A::Problem problem;
    std::uint64_t share;
    // What asks whether a problem is worth a task asks about the problem alone.
    operator const typename A::Problem &() const noexcept { return problem; }
  };
  using Result = typename A::Result;

  Watched(A& algorithm, Progress& progress) : algorithm_(algorithm), progress_(progress) {}

  template <class Receive>
  std::optional<Result> expand(Problem& problem, Receive&& receive) {
    progress_.check();
    std::vector<typename A::Problem> parts;
    auto solved = skeleton::expand(algorithm_, problem.problem, [&](typename A::Problem&& part) {
      parts.push_back(std::move(part));
    });
    if (solved || parts.empty()) progress_.advance(problem.share);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const std::uint64_t share =
          problem.share / parts.size() + (i < problem.share % parts.size() ? 1 : 0);
      receive(Problem{std::move(parts[i]), share});
    }
    return solved;
  }

  Result combine(std::span<Result> results, Problem&& problem) {
    return algorithm_.combine(results, std::move(problem.problem));
  }

  bool enough(const Result& result, const Problem& parent) requires StopsEarly<A> {
    return algorithm_.enough(result, parent.problem);
  }

 private:
  A& algorithm_;
  Progress& progress_;
};

}  // namespace detail

template <class E = SequentialExecutor>
class ProgressExecutor {
 public:
  static constexpr std::uint64_t units = std::uint64_t{1} << 40;

  // stage: a string literal.
  ProgressExecutor(E executor, Progress& progress, const char* stage = "divide and conquer")
      : executor_(std::move(executor)), progress_(&progress), stage_(stage) {}

  template <DivideAndConquer A>
  typename A::Result run(typename A::Problem problem, A& algorithm) const {
    detail::Watched<A> watched(algorithm, *progress_);
    progress_->begin(stage_, units);
    auto result = executor_.run({std::move(problem), units}, watched);
    progress_->advance(units - progress_->done());  // the share of what an early out dropped
    return result;
  }

 private:
  E executor_;
  Progress* progress_;
  const char* stage_;
};

}  // namespace exactcsg::skeleton
