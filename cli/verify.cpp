// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/verify/verify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "cli/command.hpp"
#include "cli/openmc.hpp"
#include "cli/output_file.hpp"
#include "cli/report.hpp"
#include "exactcsg/support/version.hpp"
#include "exactcsg/verify/verify_geometry.hpp"

namespace exactcsg::cli {

namespace {

struct Arguments {
  std::string model;
  std::vector<std::string> against;
  std::string golden;
  std::string golden_name;
  std::vector<std::string> required;
  std::vector<std::string> without;
  std::vector<std::string> reports;
  double budget = 60;
  std::uint64_t seed = 1;
};

// A slip in a name must not wait for the end of a long verification.
void check(const Arguments& arguments) {
  const std::vector<std::string> known = verify::oracle_names();
  for (const auto* list : {&arguments.required, &arguments.without}) {
    for (const std::string& name : *list) {
      if (std::ranges::find(known, name) == known.end()) {
        throw Error(ErrorId::Usage, {fmt::format("the oracle '{}'", name),
                                     fmt::format("one of {}", fmt::join(known, ", "))});
      }
    }
  }
  for (const std::string& file : arguments.reports) expect_report_ending(file);
}

verify::Report report_on_geometry(Context& context, const Arguments& arguments) {
  if (!arguments.against.empty()) {
    throw Error(ErrorId::Usage, {"--against with an OpenMC geometry", "a planar model"});
  }
  verify::VerifyGeometryOptions options;
  options.seed = arguments.seed;
  options.nef_seconds = arguments.budget;
  if (!arguments.golden.empty()) options.golden = arguments.golden;
  options.golden_name = arguments.golden_name;
  options.disabled = arguments.without;
  options.progress = &context.progress();
  verify::Report report = verify::verify_geometry(read_geometry(context, arguments.model), options);
  verify::require_oracles(report, arguments.required);
  return report;
}

verify::Report report_on_solid(Context& context, const Arguments& arguments) {
  const io::Model model = read(context, arguments.model);
  verify::VerifyOptions options;
  options.source = arguments.model;
  options.against.assign(arguments.against.begin(), arguments.against.end());
  if (!arguments.golden.empty()) options.golden = arguments.golden;
  options.golden_name = arguments.golden_name;
  options.required = arguments.required;
  options.disabled = arguments.without;
  options.budget_seconds = arguments.budget;
  options.threads = context.common().threads;
  options.seed = arguments.seed;
  options.progress = &context.progress();
  return verify::verify_model(model, options);
}

Answer verify_one(Context& context, const Arguments& arguments) {
  check(arguments);
  verify::Report report = io::openmc::is_geometry_file(arguments.model)
                              ? report_on_geometry(context, arguments)
                              : report_on_solid(context, arguments);
  if (report.library.empty()) report.library = std::string(version);
  for (const std::string& file : arguments.reports) {
    write_file(file, [&](const std::filesystem::path& temporary) {
      verify::write_report(report, temporary);
    });
  }
  return print_report(context, report);
}

}  // namespace

Command add_verify(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("verify",
                                         "Hold the exact evaluation of a model, or the proved "
                                         "volumes of an OpenMC or MCNP geometry, against "
                                         "independent oracles.");
  command->add_option("MODEL", arguments->model, "the model")->required();
  command
      ->add_option(
          "--against", arguments->against,
          "a mesh file that should be this model (.off, .stl, .obj, .ply); may be repeated")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command->add_option("--golden", arguments->golden, "a file of golden values")->type_name("FILE");
  command
      ->add_option("--golden-name", arguments->golden_name,
                   "the model's entry in it (default: its file name without ending)")
      ->type_name("NAME");
  command
      ->add_option("--require", arguments->required,
                   fmt::format("oracles whose skip is a failure, of {}",
                               fmt::join(verify::oracle_names(), ",")))
      ->type_name("LIST")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_option("--without", arguments->without, "oracles not to run")
      ->type_name("LIST")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_option("--budget", arguments->budget, "seconds for each slow oracle")
      ->type_name("S")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--report", arguments->reports, "also write .json, .xml (JUnit), .html, .txt")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command->add_option("--seed", arguments->seed, "of the sampling")
      ->type_name("N")
      ->capture_default_str();
  return {command, [arguments](Context& context) { return verify_one(context, *arguments); }, 0};
}

}  // namespace exactcsg::cli
