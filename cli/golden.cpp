// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/verify/golden.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>

#include "cli/command.hpp"
#include "cli/output_file.hpp"
#include "cli/report.hpp"
#include "exactcsg/support/version.hpp"
#include "exactcsg/verify/verify.hpp"

namespace exactcsg::cli {

namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string golden;
  std::vector<std::string> models;
  std::string source;
  double budget = 60;
};

std::string entry_name(const fs::path& model) { return model.stem().string(); }

// The models named, or all .csg files in the golden file's folder.
std::vector<fs::path> models_of(const Arguments& arguments) {
  std::vector<fs::path> models(arguments.models.begin(), arguments.models.end());
  if (models.empty()) {
    const fs::path file(arguments.golden);
    const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    std::error_code trouble;
    for (const auto& entry : fs::directory_iterator(folder, trouble)) {
      if (entry.path().extension() == ".csg") models.push_back(entry.path());
    }
    if (trouble) {
      throw Error(ErrorId::FileNotReadable,
                  {trouble.message(), "a folder", SourcePosition{folder.string()}});
    }
    std::ranges::sort(models);
  }
  return models;
}

// How the value is known: the oracles that confirmed it with exactly equal values. A value that
// none confirmed is not recorded unless the caller says how it is known.
std::string confirmed_by(const io::Model& model, const Boundary& boundary, const fs::path& file,
                         const Arguments& arguments, Context& context) {
  verify::VerifyOptions options;
  options.source = file;
  options.budget_seconds = arguments.budget;
  options.threads = context.common().threads;
  options.progress = &context.progress();
  const verify::Report report = verify::verify_boundary(model, boundary, options);
  std::vector<std::string> confirming;
  for (const verify::Check& check : report.checks) {
    if (check.verdict == verify::Verdict::Failed) {
      throw Error(ErrorId::GoldenFile, {fmt::format("'{}' failed: ours {}, theirs {}", check.name,
                                                    check.ours, check.theirs),
                                        "a model that verifies", SourcePosition{file.string()}});
    }
    if (check.verdict == verify::Verdict::Passed &&
        (check.oracle == "nef" || check.oracle == "openscad")) {
      confirming.push_back(check.name);
    }
  }
  if (confirming.empty()) {
    throw Error(ErrorId::GoldenFile,
                {"no oracle that confirmed the model", "--source to say how the values are known",
                 SourcePosition{file.string()}});
  }
  return fmt::format("confirmed by {}", fmt::join(confirming, "; "));
}

Answer record(Context& context, const Arguments& arguments) {
  verify::GoldenFile golden;
  if (fs::exists(arguments.golden)) golden = verify::read_golden(arguments.golden);
  for (const fs::path& file : models_of(arguments)) {
    const io::Model model = read(context, file);
    const Boundary boundary = evaluate(model.solid, context.evaluate_options());
    const std::string source = arguments.source.empty()
                                   ? confirmed_by(model, boundary, file, arguments, context)
                                   : arguments.source;
    golden.models[entry_name(file)] = verify::golden_entry(boundary, source);
    context.print(fmt::format("{}: recorded ({})\n", entry_name(file), source));
    // After every model: an hour of oracles is not lost to the last of them.
    write_file(arguments.golden,
               [&](const fs::path& temporary) { verify::write_golden(golden, temporary); });
  }
  return Answer::Yes;
}

Answer check(Context& context, const Arguments& arguments) {
  const verify::GoldenFile golden = verify::read_golden(arguments.golden);
  verify::Report report;
  report.model = arguments.golden;
  report.library = std::string(version);
  std::set<std::string> seen;
  for (const fs::path& file : models_of(arguments)) {
    const io::Model model = read(context, file);
    const Boundary boundary = evaluate(model.solid, context.evaluate_options());
    verify::Check found = verify::check_golden(golden, entry_name(file), boundary);
    found.name = entry_name(file);
    report.checks.push_back(std::move(found));
    seen.insert(entry_name(file));
  }
  // Checking all: an entry whose model is gone is a failure too.
  for (const auto& [name, entry] : golden.models) {
    if (!arguments.models.empty() || seen.contains(name)) continue;
    verify::Check missing;
    missing.oracle = "golden";
    missing.name = name;
    missing.ours = "no model";
    missing.theirs = entry.digest.substr(0, 16);
    missing.verdict = verify::Verdict::Failed;
    missing.explanation = fmt::format("{} has no {}.csg beside it", arguments.golden, name);
    report.checks.push_back(std::move(missing));
  }
  return print_report(context, report);
}

}  // namespace

std::vector<Command> add_golden(CLI::App& app) {
  CLI::App* group = app.add_subcommand(
      "golden", "Record the digests and figures of models, or check them against a record.");
  group->require_subcommand(1);
  auto arguments = std::make_shared<Arguments>();
  const auto add = [&](const char* name, const char* text) {
    CLI::App* command = group->add_subcommand(name, text);
    command->add_option("FILE", arguments->golden, "the golden file (.json)")->required();
    command->add_option("MODEL", arguments->models,
                        "the models (default: every .csg in the file's folder)");
    return command;
  };
  CLI::App* recording = add("record", "Record values, once an oracle has confirmed them.");
  recording
      ->add_option("--source", arguments->source, "how the values are known, instead of oracles")
      ->type_name("TEXT");
  recording->add_option("--budget", arguments->budget, "seconds for each slow oracle")
      ->type_name("S")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  CLI::App* checking = add("check", "Exit 0 if every model is as recorded; a missing entry fails.");
  return {{recording, [arguments](Context& context) { return record(context, *arguments); }, 0},
          {checking, [arguments](Context& context) { return check(context, *arguments); }, 0}};
}

}  // namespace exactcsg::cli
