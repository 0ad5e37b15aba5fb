// SPDX-License-Identifier: Apache-2.0
#pragma once

// Loops for several threads that fail as loops of one thread do.

#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>

#include "exactcsg/support/in_parallel.hpp"

namespace exactcsg {

// As in_parallel, for rounds that may fail: what is thrown on is the exception of the first round
// that throws one, as if the rounds were run in their order. Rounds after that need not be run.
template <class Round>
void in_parallel_to_first_error(unsigned threads, std::size_t count, const Round& round) {
  std::atomic<std::size_t> first_failed = count;
  std::mutex mutex;
  std::exception_ptr error;
  in_parallel(threads, count, [&](std::size_t i) {
    if (i > first_failed.load(std::memory_order_relaxed)) return;
    try {
      round(i);
    } catch (...) {
      const std::scoped_lock lock(mutex);
      if (i > first_failed.load(std::memory_order_relaxed)) return;
      first_failed.store(i, std::memory_order_relaxed);
      error = std::current_exception();
    }
  });
  const std::scoped_lock lock(mutex);
  if (error) std::rethrow_exception(error);
}

}  // namespace exactcsg
