// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <array>
#include <memory>

#include "cli/openmc.hpp"
#include "cli/output_file.hpp"
#include "cli/report.hpp"
#include "exactcsg/verify/geometry_check.hpp"

namespace exactcsg::cli {

namespace {

struct Arguments {
  std::string model;
  std::vector<std::string> box;
  std::string tolerance = "0";
  std::vector<std::string> reports;
  double budget = 60;
};

Rational number_of(const std::string& text, const char* option) {
  const std::optional<Rational> value = parse_rational(text);
  if (!value) {
    throw Error(ErrorId::Usage, {fmt::format("'{:.40}' of {}", text, option), "a number"});
  }
  return *value;
}

std::optional<domain::Box<3>> box_of(const std::vector<std::string>& words) {
  if (words.empty()) return std::nullopt;
  if (words.size() != 6) {
    throw Error(ErrorId::Usage,
                {fmt::format("{} numbers of --box", words.size()), "six, x0,y0,z0,x1,y1,z1"});
  }
  std::array<domain::Coordinates<3>, 2> corners;
  for (std::size_t i = 0; i < words.size(); ++i) {
    corners[i / 3][i % 3] = number_of(words[i], "--box");
  }
  return domain::Box<3>(corners[0], corners[1]);
}

Answer check_one(Context& context, const Arguments& arguments) {
  // Slips in arguments must not wait for the end of long work.
  verify::GeometryCheckOptions options;
  options.box = box_of(arguments.box);
  const Rational tolerance = number_of(arguments.tolerance, "--tolerance");
  for (const std::string& file : arguments.reports) expect_report_ending(file);
  options.budget_seconds = arguments.budget;
  options.progress = &context.progress();
  const io::openmc::Model model = read_geometry(context, arguments.model);
  const verify::GeometryCheck check = verify::check_geometry(model, options);
  const std::string text = verify::render_text(model, check, tolerance);
  for (const std::string& file : arguments.reports) {
    const std::string ending = std::filesystem::path(file).extension().string();
    if (ending == ".json") {
      write_file(file, verify::render_json(model, check, tolerance));
    } else if (ending == ".txt") {
      write_file(file, text);
    } else {
      write_file(file, [&](const std::filesystem::path& temporary) {
        verify::write_report(verify::as_report(model, check, tolerance), temporary);
      });
    }
  }
  context.print(text);
  return check.is_clean(tolerance) ? Answer::Yes : Answer::No;
}

}  // namespace

Command add_check(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand(
      "check",
      "Do the cells of an OpenMC or MCNP geometry overlap, or leave gaps? Exit 0: proved that they "
      "do\n"
      "not; 1: a defect, with a point of it, or undecided in more than the tolerance.");
  command
      ->add_option("MODEL", arguments->model,
                   "geometry.xml, model.xml, or an MCNP input file (.mcnp, .inp, .i)")
      ->required();
  command
      ->add_option(
          "--box", arguments->box,
          "x0,y0,z0,x1,y1,z1: look at this box of the root only (default: round its cells)")
      ->type_name("BOX")
      ->delimiter(',')
      ->expected(1, 6);
  command
      ->add_option("--tolerance", arguments->tolerance,
                   "volume that may be left undecided without being a defect")
      ->type_name("V")
      ->capture_default_str();
  command->add_option("--budget", arguments->budget, "seconds for all proofs together")
      ->type_name("S")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--report", arguments->reports, "also write .json, .xml (JUnit), .html, .txt")
      ->type_name("FILE")
      ->allow_extra_args(false);
  Command checking{command,
                   [arguments](Context& context) { return check_one(context, *arguments); }, 0};
  checking.reads_meshes = false;
  return checking;
}

}  // namespace exactcsg::cli
