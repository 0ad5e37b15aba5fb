// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/terminal.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "exactcsg/support/error.hpp"

namespace exactcsg::cli {

namespace {

bool progress_line_shown = false;  // only the main thread prints

void write_to_stderr(std::string_view text) {
  // Nothing can be done, or said, about a stderr that takes no more.
  (void)std::fwrite(text.data(), 1, text.size(), stderr);
  (void)std::fflush(stderr);
}

}  // namespace

bool is_terminal(int file_descriptor) { return isatty(file_descriptor) == 1; }

bool colour_wanted(int file_descriptor) {
  const char* const no_color = std::getenv("NO_COLOR");
  const char* const term = std::getenv("TERM");
  return is_terminal(file_descriptor) && (no_color == nullptr || *no_color == '\0') &&
         term != nullptr && std::strcmp(term, "dumb") != 0;
}

std::size_t terminal_width(int file_descriptor) {
  winsize size{};
  if (ioctl(file_descriptor, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
  return 160;  // a file or a log: wide enough that no column is cut
}

void print_data(std::string_view text) {
  clear_progress_line();
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) {
    throw Error(ErrorId::FileNotWritable, {std::strerror(errno), "a stdout that takes the answer"});
  }
}

void print_message(std::string_view text) {
  clear_progress_line();
  std::string line(text);
  if (line.empty() || line.back() != '\n') line += '\n';
  write_to_stderr(line);
}

void print_error(std::string_view text) {
  std::string line(text);
  if (colour_wanted(STDERR_FILENO)) {
    if (const auto begin = line.find("error["); begin != std::string::npos) {
      line.insert(std::min(line.find(']', begin) + 1, line.size()), "\033[0m");
      line.insert(begin, "\033[1;31m");
    }
  }
  print_message(line);
}

void show_progress_line(std::string_view text) {
  if (!is_terminal(STDERR_FILENO)) return;
  write_to_stderr(fmt::format("\r\033[K{}", text.substr(0, terminal_width(STDERR_FILENO) - 1)));
  progress_line_shown = true;
}

void clear_progress_line() {
  if (progress_line_shown) write_to_stderr("\r\033[K");
  progress_line_shown = false;
}

}  // namespace exactcsg::cli
