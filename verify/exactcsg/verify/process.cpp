// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/verify/process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <new>

#include "exactcsg/support/error.hpp"
#include "exactcsg/support/sanitizer.hpp"

namespace exactcsg::verify {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int not_found_status = 127;
constexpr int poll_milliseconds = 50;
constexpr std::size_t longest_output = std::size_t{2} << 30U;

class Pipe {
 public:
  Pipe() {
    if (pipe2(ends_.data(), O_CLOEXEC) != 0) {
      throw Error(ErrorId::OracleFailed, {std::strerror(errno), "a pipe"});
    }
  }
  ~Pipe() {
    close_end(0);
    close_end(1);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  int read_end() const { return ends_[0]; }
  int write_end() const { return ends_[1]; }
  void close_end(std::size_t i) {
    if (ends_[i] >= 0) close(ends_[i]);
    ends_[i] = -1;
  }

 private:
  std::array<int, 2> ends_{-1, -1};
};

void limit_memory(std::size_t bytes) {
  const rlimit limit{bytes, bytes};
  if (!has_shadow_memory) setrlimit(RLIMIT_AS, &limit);
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
}

void write_all(int file, const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t n = write(file, data, size);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return;
    data += n;
    size -= static_cast<std::size_t>(n);
  }
}

// False at the end of the file.
bool read_some(int file, std::string& into) {
  std::array<char, 65536> buffer;
  const ssize_t n = read(file, buffer.data(), buffer.size());
  if (n < 0) return errno == EINTR || errno == EAGAIN;
  if (n > 0 && into.size() < longest_output)
    into.append(buffer.data(), static_cast<std::size_t>(n));
  return n > 0;
}

int wait_for(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

void kill_group(pid_t child) {
  kill(-child, SIGKILL);
  kill(child, SIGKILL);
}

// Reads both pipes to their ends, or kills the child's process group when time is over.
ProcessResult collect(pid_t child, Pipe& output, Pipe& messages, const ProcessLimits& limits) {
  output.close_end(1);
  messages.close_end(1);
  ProcessResult result;
  const auto start = Clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
  std::array<pollfd, 2> files{pollfd{output.read_end(), POLLIN, 0},
                              pollfd{messages.read_end(), POLLIN, 0}};
  bool killed = false;
  bool cancelled = false;
  while (files[0].fd >= 0 || files[1].fd >= 0) {
    cancelled = limits.progress != nullptr && limits.progress->cancelled();
    if (cancelled || elapsed() > limits.seconds) {
      kill_group(child);
      killed = true;
      break;
    }
    if (poll(files.data(), files.size(), poll_milliseconds) <= 0) continue;
    if (files[0].revents != 0 && !read_some(files[0].fd, result.output)) files[0].fd = -1;
    if (files[1].revents != 0 && !read_some(files[1].fd, result.messages)) files[1].fd = -1;
  }
  // A child may close its ends and go on working.
  int status = 0;
  while (!killed && waitpid(child, &status, WNOHANG) == 0) {
    if (elapsed() > limits.seconds) {
      kill_group(child);
      killed = true;
      break;
    }
    usleep(1000);
  }
  if (killed) status = wait_for(child);
  result.seconds = elapsed();
  if (cancelled) limits.progress->check();
  if (killed) {
    result.end = ProcessEnd::OverTime;
  } else if (WIFSIGNALED(status)) {
    result.end = ProcessEnd::Signalled;
    result.status = WTERMSIG(status);
  } else {
    result.status = WEXITSTATUS(status);
  }
  return result;
}

pid_t fork_or_throw() {
  const pid_t child = fork();
  if (child < 0) throw Error(ErrorId::OracleFailed, {std::strerror(errno), "a child process"});
  return child;
}

}  // namespace

ProcessResult run_program(const std::vector<std::string>& command,
                          const std::filesystem::path& folder, const ProcessLimits& limits) {
  std::vector<char*> arguments;
  arguments.reserve(command.size() + 1);
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  Pipe output;
  Pipe messages;
  Pipe started;  // closed by a successful exec
  const pid_t child = fork_or_throw();
  if (child == 0) {
    // Between fork and exec only calls that are safe in a copy of a process with threads.
    setpgid(0, 0);
    const int nothing = open("/dev/null", O_RDONLY);
    dup2(nothing, STDIN_FILENO);
    dup2(output.write_end(), STDOUT_FILENO);
    dup2(messages.write_end(), STDERR_FILENO);
    limit_memory(limits.memory);
    if (folder.empty() || chdir(folder.c_str()) == 0) execvp(arguments[0], arguments.data());
    const char failed = 1;
    write_all(started.write_end(), &failed, 1);
    _exit(not_found_status);
  }
  setpgid(child, child);
  started.close_end(1);
  std::string exec_failed;
  while (read_some(started.read_end(), exec_failed) && exec_failed.empty()) {
  }
  ProcessResult result = collect(child, output, messages, limits);
  if (!exec_failed.empty()) result.end = ProcessEnd::NotFound;
  return result;
}

ProcessResult run_forked(const std::function<std::string()>& work, const ProcessLimits& limits) {
  Pipe output;
  Pipe messages;
  const pid_t child = fork_or_throw();
  if (child == 0) {
    setpgid(0, 0);
    dup2(messages.write_end(), STDERR_FILENO);
    limit_memory(limits.memory);
    int status = 0;
    try {
      const std::string text = work();
      write_all(output.write_end(), text.data(), text.size());
    } catch (const std::bad_alloc&) {
      const char text[] = "out of memory";
      write_all(messages.write_end(), text, sizeof(text) - 1);
      status = 1;
    } catch (const std::exception& e) {
      write_all(messages.write_end(), e.what(), std::strlen(e.what()));
      status = 1;
    }
    _exit(status);  // no destructors, no handlers: they belong to the parent
  }
  setpgid(child, child);
  return collect(child, output, messages, limits);
}

TemporaryFolder::TemporaryFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "exactcsg-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) {
    throw Error(ErrorId::FileNotWritable, {std::strerror(errno), "a temporary folder"});
  }
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace exactcsg::verify
