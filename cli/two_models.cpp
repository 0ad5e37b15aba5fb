// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/two_models.hpp"

#include <fmt/format.h>

#include <memory>

#include "exactcsg/number/enclosure.hpp"

namespace exactcsg::cli {

Command add_command_on_two_models(CLI::App& app, const TwoModelsHelp& help,
                                  Answer (*answer)(Context&, const TwoModels&)) {
  auto models = std::make_shared<TwoModels>();
  CLI::App* command = app.add_subcommand(help.name, help.command);
  command->add_option("A", models->first, help.first)->required();
  command->add_option("B", models->second, help.second)->required();
  if (help.has_tolerance) {
    command
        ->add_option("--tolerance", models->tolerance,
                     "of OpenMC geometries: a volume within which the answer may stay undecided")
        ->type_name("V")
        ->check(CLI::NonNegativeNumber);
  }
  return {command, [models, answer](Context& context) { return answer(context, *models); }};
}

std::string witness_lines(const Point3& p) {
  constexpr int digits = 17;
  return fmt::format(
      "  exactly  ({}, {}, {})\n"
      "  nearly   ({}, {}, {})\n",
      to_text(p.x), to_text(p.y), to_text(p.z), to_decimal(p.x, digits), to_decimal(p.y, digits),
      to_decimal(p.z, digits));
}

}  // namespace exactcsg::cli
