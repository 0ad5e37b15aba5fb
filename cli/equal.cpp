// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <memory>

#include "cli/command.hpp"
#include "exactcsg/number/enclosure.hpp"
#include "exactcsg/solid/classify.hpp"

namespace exactcsg::cli {

namespace {

struct Arguments {
  std::string first;
  std::string second;
};

Answer equal(Context& context, const Arguments& arguments) {
  const io::Model first = read(context, arguments.first);
  const io::Model second = read(context, arguments.second);
  const auto difference = find_difference(first.solid, second.solid, context.evaluate_options());
  if (!difference) {
    context.print("equal: the same solid\n");
    return Answer::Yes;
  }
  const Point3& p = difference->witness;
  const std::string& inside = difference->in_first ? arguments.first : arguments.second;
  const std::string& outside = difference->in_first ? arguments.second : arguments.first;
  context.print(
      fmt::format("different: a point lies in {} and outside {}\n"
                  "  exactly  ({}, {}, {})\n"
                  "  nearly   ({}, {}, {})\n",
                  inside, outside, to_text(p.x), to_text(p.y), to_text(p.z), to_decimal(p.x, 17),
                  to_decimal(p.y, 17), to_decimal(p.z, 17)));
  return Answer::No;
}

}  // namespace

Command add_equal(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand(
      "equal", "Are two models the same solid? If not, print a point that lies in one alone.");
  command->add_option("A", arguments->first, "the first model")->required();
  command->add_option("B", arguments->second, "the second model")->required();
  return {command, [arguments](Context& context) { return equal(context, *arguments); }};
}

}  // namespace exactcsg::cli
