// SPDX-License-Identifier: GPL-3.0-or-later
// The command exactcsg. Exit codes: 0 answered yes, 1 answered no, 2 usage or input trouble, 3 a
// fault of ours.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <iterator>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "cli/memory_limit.hpp"
#include "cli/supervisor.hpp"
#include "cli/terminal.hpp"
#include "exactcsg/support/version.hpp"

namespace exactcsg::cli {

namespace {

constexpr std::size_t default_memory_limit = std::size_t{4} << 30U;

// The options that every subcommand takes. A limit stands by default because models come from
// anywhere: a pipeline gets an answer or a refusal by name within a minute, not a machine that
// swaps.
struct ParsedCommon {
  CommonOptions options;
  std::optional<double> time_limit;
  std::string fill;
};

// CLI11's own validator copies its table of units into every option, at every start: this one makes
// the table when a size is given.
CLI::Validator as_size() {
  const auto parse = [](std::string& text) {
    static const CLI::AsSizeValue parse_size(false);
    return parse_size(text);
  };
  return {parse, "SIZE [b, kb(=1024b), ...]"};
}

std::optional<FillRule> fill_rule_of(std::string_view name) {
  for (const FillRule rule : {FillRule::NonZero, FillRule::Positive, FillRule::EvenOdd}) {
    if (name == name_of(rule)) return rule;
  }
  return std::nullopt;
}

// As above, by hand: CLI11's transformers make their tables at every start.
CLI::Validator as_fill_rule() {
  const auto check = [](std::string& text) -> std::string {
    if (fill_rule_of(text)) return {};
    return fmt::format("'{}' is no rule: nonzero, positive, even-odd", text);
  };
  return {check, "nonzero|positive|even-odd"};
}

void add_fill_option(CLI::App& arguments, std::string& fill) {
  arguments
      .add_option("--fill", fill,
                  "what is inside of a mesh that meets itself or is inside out, by its winding "
                  "numbers (default: it is refused)")
      ->type_name("RULE")
      ->check(as_fill_rule());
}

void add_common_options(CLI::App& arguments, ParsedCommon& parsed, double default_time_limit) {
  parsed.options.memory_limit = default_memory_limit;
  arguments.add_option("--threads", parsed.options.threads, "threads to use (default: all cores)")
      ->type_name("N");
  arguments
      .add_option("--time-limit", parsed.time_limit,
                  fmt::format("seconds until the work is given up, 0 for none (default: {:g})",
                              default_time_limit))
      ->type_name("S")
      ->check(CLI::NonNegativeNumber);
  arguments
      .add_option("--memory-limit", parsed.options.memory_limit,
                  "memory to use at most, like 512M or 8G, 0 for no limit (default: 4G)")
      ->type_name("SIZE")
      ->transform(as_size());
  arguments.add_flag("--quiet", parsed.options.quiet, "no warnings and no progress line");
}

int usage_error(const CLI::App& app, const CLI::ParseError& error) {
  print_error(Error(ErrorId::Usage, {error.what(), ""}).what());
  const auto chosen = app.get_subcommands();
  print_message(chosen.empty()
                    ? "exactcsg --help lists the commands"
                    : fmt::format("exactcsg {} --help says more", chosen.front()->get_name()));
  return describe(ErrorId::Usage).exit_code;
}

int run(int argc, char** argv) {
  CLI::App app{"Exact answers about solids of constructive solid geometry.", "exactcsg"};
  app.set_version_flag("--version", fmt::format("exactcsg {}", version));
  app.require_subcommand(1);
  app.failure_message(CLI::FailureMessage::simple);

  std::vector<Command> commands{add_verify(app), add_measure(app),      add_classify(app),
                                add_equal(app),  add_interference(app), add_contains(app),
                                add_check(app),  add_boundary(app),     add_edges(app)};
  std::ranges::move(add_golden(app), std::back_inserter(commands));
  commands.push_back(add_info(app));
  std::vector<ParsedCommon> common(commands.size());
  for (std::size_t i = 0; i < commands.size(); ++i) {
    add_common_options(*commands[i].arguments, common[i], commands[i].default_time_limit_seconds);
    if (commands[i].reads_meshes) add_fill_option(*commands[i].arguments, common[i].fill);
  }

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    return usage_error(app, error);
  }
  for (std::size_t i = 0; i < commands.size(); ++i) {
    if (!commands[i].arguments->parsed()) continue;
    CommonOptions options = common[i].options;
    options.time_limit_seconds = common[i].time_limit.value_or(
        commands[i].default_time_limit_seconds * static_cast<double>(commands[i].models()));
    options.fill = fill_rule_of(common[i].fill);
    limit_memory(options.memory_limit);
    Context context(options);
    return supervise(commands[i], context);
  }
  return describe(ErrorId::InternalError).exit_code;
}

}  // namespace

}  // namespace exactcsg::cli

int main(int argc, char** argv) {
  using namespace exactcsg;
  // What reaches this place happened before or after the work itself.
  try {
    return cli::run(argc, argv);
  } catch (const Error& error) {
    cli::print_error(error.what());
    return describe(error.id()).exit_code;
  } catch (const std::bad_alloc&) {
    cli::print_error(Error(ErrorId::OutOfMemory, {"no memory left", ""}).what());
    return describe(ErrorId::OutOfMemory).exit_code;
  } catch (const std::exception& error) {
    cli::print_error(Error(ErrorId::InternalError, {error.what(), ""}).what());
    return describe(ErrorId::InternalError).exit_code;
  }
}
