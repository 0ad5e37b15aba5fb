// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Time and memory of this process.

#include <sys/resource.h>

#include <chrono>

namespace exactcsg::bench {

class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

inline long peak_kilobytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

// The least time of so many runs in one process is shown: of short ones the machine's noise is
// large, and the first run of a long one also waits for memory that the process has never touched.
inline int runs_if_one_takes(double seconds) { return seconds < 1 ? 5 : seconds < 20 ? 2 : 1; }

}  // namespace exactcsg::bench
