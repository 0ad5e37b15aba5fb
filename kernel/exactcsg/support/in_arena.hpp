// SPDX-License-Identifier: Apache-2.0
#pragma once

// Where tasks of oneTBB run. Private to the kernel.

#include <tbb/task_arena.h>

#include "exactcsg/support/hand_over.hpp"

namespace exactcsg::detail {

// Runs `work`, which takes no tasks of others while it waits for its own: in the arena that the
// thread is in, if that has `threads` places, or in one of its own. In the former, threads that
// have just helped with something else are still awake: in a new arena they are woken up first,
// which takes as long as many a short loop. An exception of `work` is thrown on.
template <class Work>
void in_arena(int threads, const Work& work) {
  if (tbb::this_task_arena::max_concurrency() == threads) {
    tbb::this_task_arena::isolate(work);
    return;
  }
  tbb::task_arena arena(threads);
  const TakeOverAtEnd before_unwinding(&arena);
  hand_over(&arena);
  arena.execute([&] {  // perhaps by another thread, if all places of the arena are taken
    take_over(&arena);
    const HandOverAtEnd done(&arena);
    work();
  });
}

}  // namespace exactcsg::detail
