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

}  // namespace exactcsg::bench
