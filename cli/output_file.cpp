// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/output_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>

#include "exactcsg/support/error.hpp"

namespace exactcsg::cli {

namespace {

namespace fs = std::filesystem;

Error not_writable(const fs::path& target, std::string_view reason) {
  return Error(ErrorId::FileNotWritable,
               {std::string(reason), "", SourcePosition{target.string()}});
}

void write_text(const fs::path& file, const fs::path& named, std::string_view text) {
  std::ofstream stream(file, std::ios::binary);
  stream.write(text.data(), static_cast<std::streamsize>(text.size()));
  stream.close();
  if (!stream) throw not_writable(named, std::strerror(errno));
}

// Removes the file when the scope is left by an exception.
struct Removal {
  fs::path file;
  bool armed = true;
  explicit Removal(fs::path path) : file(std::move(path)) {}
  Removal(const Removal&) = delete;
  Removal& operator=(const Removal&) = delete;
  ~Removal() {
    std::error_code ignored;
    if (armed) fs::remove(file, ignored);
  }
};

bool is_special(const fs::path& target) {
  std::error_code ignored;
  const fs::file_status status = fs::status(target, ignored);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

}  // namespace

void write_file(const fs::path& target, const std::function<void(const fs::path&)>& write) {
  std::error_code trouble;
  if (fs::is_directory(target, trouble)) throw not_writable(target, "a folder");
  if (is_special(target)) {
    write(target);
    return;
  }
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, trouble)) throw not_writable(target, "no such folder");
  // Tried before the long work of others begins: a writer may report this less well.
  if (access(folder.c_str(), W_OK) != 0) throw not_writable(target, std::strerror(errno));
  Removal temporary(folder / fmt::format(".{}.{}{}", target.stem().string(), getpid(),
                                         target.extension().string()));
  write(temporary.file);
  fs::rename(temporary.file, target, trouble);
  if (trouble) throw not_writable(target, trouble.message());
  temporary.armed = false;
}

void write_file(const fs::path& target, std::string_view text) {
  write_file(target, [&](const fs::path& file) { write_text(file, target, text); });
}

void expect_ending(const fs::path& target, const std::vector<std::string_view>& endings) {
  const std::string ending = target.extension().string();
  if (std::find(endings.begin(), endings.end(), ending) != endings.end()) return;
  throw Error(
      ErrorId::UnknownFormat,
      {fmt::format("'{}'", ending),
       fmt::format("{} or {}", fmt::join(endings.begin(), endings.end() - 1, ", "), endings.back()),
       SourcePosition{target.string()}});
}

}  // namespace exactcsg::cli
