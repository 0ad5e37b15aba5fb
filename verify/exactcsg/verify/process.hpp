// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Running work in a child process with limits of time and memory. No shell is involved.

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "exactcsg/support/progress.hpp"

namespace exactcsg::verify {

struct ProcessLimits {
  double seconds = 60;
  std::size_t memory = std::size_t{6} << 30U;  // bytes of address space
  Progress* progress = nullptr;                // cancelled: the child is killed
};

enum class ProcessEnd { Exited, OverTime, Signalled, NotFound };

struct ProcessResult {
  ProcessEnd end = ProcessEnd::Exited;
  int status = 0;  // exit status or signal number
  std::string output;
  std::string messages;  // stderr
  double seconds = 0;
};

// Runs a program. Arguments go to it as they are; its standard input is empty.
ProcessResult run_program(const std::vector<std::string>& command,
                          const std::filesystem::path& folder, const ProcessLimits& limits);

// Runs a function in a forked child and returns the text it made. An exception ends the child with
// status 1 and its message in `messages`. The function must not use threads of the parent.
ProcessResult run_forked(const std::function<std::string()>& work, const ProcessLimits& limits);

// A folder of one's own under the system's temporary folder, removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace exactcsg::verify
