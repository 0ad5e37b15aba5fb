// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// What a subcommand is: its arguments, and the work it does with them.

#include <CLI/CLI.hpp>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exactcsg/io/model.hpp"
#include "exactcsg/solid/evaluate.hpp"
#include "exactcsg/support/error.hpp"
#include "exactcsg/support/progress.hpp"

namespace exactcsg::cli {

// The exit code of a question that was answered.
enum class Answer : int { Yes = 0, No = 1 };

struct CommonOptions {
  unsigned threads = 0;           // 0: as many as the machine has
  double time_limit_seconds = 0;  // 0: none
  std::size_t memory_limit = 0;   // bytes, 0: none
  bool quiet = false;
  std::optional<FillRule> fill;  // of meshes that meet themselves; nullopt: they are refused
};

// What a command's work is given. The work runs on a thread of its own; warnings may come from it
// at any time, its output is printed when it has ended without an error, or with refusals only.
class Context {
 public:
  explicit Context(const CommonOptions& common) : common_(common) {}

  const CommonOptions& common() const { return common_; }
  Progress& progress() { return progress_; }
  EvaluateOptions evaluate_options();

  // Appends to what goes to stdout.
  void print(std::string_view text) { output_ += text; }
  const std::string& output() const { return output_; }

  // One line for stderr, unless --quiet.
  void warn(std::string text);
  std::vector<std::string> take_warnings();

  // One of several models has no answer, the others have: the error's line for stderr, and in the
  // end the exit code of the first such error.
  void refuse(const Error& error);
  const std::optional<ErrorId>& first_refusal() const { return first_refusal_; }

 private:
  CommonOptions common_;
  Progress progress_;
  std::string output_;
  std::mutex mutex_;
  std::vector<std::string> warnings_;
  std::optional<ErrorId> first_refusal_;
};

struct Command {
  CLI::App* arguments = nullptr;
  std::function<Answer(Context&)> work;
  // Verification runs oracles with budgets of their own, so it has no time limit by default.
  double default_time_limit_seconds = 55;
  // How many models the arguments name, if each has that time.
  std::function<std::size_t()> models = [] { return std::size_t{1}; };
  bool reads_meshes = true;  // takes --fill
};

Command add_verify(CLI::App& app);
Command add_measure(CLI::App& app);
Command add_classify(CLI::App& app);
Command add_equal(CLI::App& app);
Command add_interference(CLI::App& app);
Command add_contains(CLI::App& app);
Command add_check(CLI::App& app);
Command add_boundary(CLI::App& app);
Command add_edges(CLI::App& app);
std::vector<Command> add_golden(CLI::App& app);
Command add_info(CLI::App& app);

// A line for each warning of a reader.
void pass_on(Context& context, const std::vector<io::Warning>& warnings);

// Reads a model and passes its warnings on.
io::Model read(Context& context, const std::filesystem::path& file);

}  // namespace exactcsg::cli
