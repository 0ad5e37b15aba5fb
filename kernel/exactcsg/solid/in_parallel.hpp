// SPDX-License-Identifier: Apache-2.0
#pragma once

// A loop whose rounds do not depend on each other, run on one or several threads.

#include <algorithm>
#include <cstddef>

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace exactcsg {

// round(i) for every i below count, each once. threads: as in EvaluateOptions.
// An exception of a round is thrown on.
template <class Round>
void in_parallel(unsigned threads, std::size_t count, const Round& round) {
  if (threads == 1) {
    for (std::size_t i = 0; i < count; ++i) round(i);
    return;
  }
  const std::size_t allowed =
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  const std::size_t used = threads == 0 ? allowed : std::min<std::size_t>(threads, allowed);
  tbb::task_arena arena(static_cast<int>(used));
  arena.execute([&] { tbb::parallel_for(std::size_t{0}, count, round); });
}

}  // namespace exactcsg
