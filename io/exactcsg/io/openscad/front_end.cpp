// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/openscad/front_end.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "exactcsg/support/error.hpp"

extern char** environ;  // NOLINT: POSIX names it so

namespace exactcsg::io::openscad {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail_to_run(const std::string& why) {
  throw Error(ErrorId::OracleUnavailable, {why, "the program 'openscad' on the PATH"});
}

class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::error_code error;
    const fs::path base = fs::temp_directory_path(error);
    std::string name = ((error ? fs::path("/tmp") : base) / "exactcsg-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) {
      throw Error(ErrorId::FileNotReadable, {"no temporary folder: " + name, ""});
    }
    path_ = name;
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

class FileDescriptor {
 public:
  explicit FileDescriptor(int value) : value_(value) {}
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  ~FileDescriptor() { reset(); }
  int get() const { return value_; }
  void reset() {
    if (value_ >= 0) close(value_);
    value_ = -1;
  }

 private:
  int value_;
};

// A child process that is killed if it is left behind.
class Child {
 public:
  explicit Child(pid_t id) : id_(id) {}
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    if (id_ <= 0) return;
    kill(id_, SIGKILL);
    wait();
  }
  int wait() {
    int status = 0;
    while (waitpid(id_, &status, 0) < 0 && errno == EINTR) {
    }
    id_ = 0;
    return status;
  }

 private:
  pid_t id_;
};

class SpawnActions {
 public:
  SpawnActions() { posix_spawn_file_actions_init(&actions_); }
  SpawnActions(const SpawnActions&) = delete;
  SpawnActions& operator=(const SpawnActions&) = delete;
  ~SpawnActions() { posix_spawn_file_actions_destroy(&actions_); }
  posix_spawn_file_actions_t* get() { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_;
};

// Everything the child writes until it closes its end.
std::string read_messages(const FileDescriptor& from, const Progress* progress) {
  constexpr std::size_t longest = 16U << 20U;
  std::string text;
  std::array<char, 4096> buffer;
  for (;;) {
    if (progress != nullptr) progress->check();
    pollfd ready{from.get(), POLLIN, 0};
    constexpr int milliseconds = 200;
    if (poll(&ready, 1, milliseconds) <= 0) continue;
    const ssize_t count = read(from.get(), buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return text;
    if (text.size() < longest) text.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

std::string first_error(const std::string& messages) {
  std::istringstream lines(messages);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("ERROR")) return line;
  }
  return {};
}

}  // namespace

FrontEndResult run_openscad(const fs::path& source, Progress* progress) {
  const TemporaryFolder folder;
  const std::string output = (folder.path() / "model.csg").string();
  // Absolute, so that no name is taken for an option.
  const std::string input = fs::absolute(source).string();

  std::array<int, 2> ends{-1, -1};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) fail_to_run(std::strerror(errno));
  FileDescriptor reading(ends[0]);
  FileDescriptor writing(ends[1]);
  SpawnActions actions;
  posix_spawn_file_actions_addopen(actions.get(), 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(actions.get(), 1, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(actions.get(), writing.get(), 2);

  std::array<std::string, 5> words{"openscad", "--render", "-o", output, input};
  std::array<char*, 6> arguments{};
  for (std::size_t i = 0; i < words.size(); ++i) arguments[i] = words[i].data();
  pid_t id = 0;
  const int failure =
      posix_spawnp(&id, "openscad", actions.get(), nullptr, arguments.data(), environ);
  if (failure != 0) fail_to_run(std::strerror(failure));
  Child child(id);
  writing.reset();

  FrontEndResult result;
  result.messages = read_messages(reading, progress);
  const int status = child.wait();
  constexpr int command_not_found = 127;  // how some C libraries report a failed exec
  if (WIFEXITED(status) && WEXITSTATUS(status) == command_not_found) fail_to_run("no such program");
  if (std::string error = first_error(result.messages); !error.empty()) {
    throw Error(ErrorId::OracleFailed, {"openscad: " + error, "", SourcePosition{source.string()}});
  }
  std::ifstream file(output, std::ios::binary);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || !file) {
    throw Error(ErrorId::OracleFailed,
                {"openscad: " + (result.messages.empty() ? "no message" : result.messages), "",
                 SourcePosition{source.string()}});
  }
  result.csg.assign(std::istreambuf_iterator<char>(file), {});
  return result;
}

}  // namespace exactcsg::io::openscad
