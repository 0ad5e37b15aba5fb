// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <memory>

#include "cli/command.hpp"
#include "exactcsg/number/enclosure.hpp"
#include "exactcsg/solid/classify.hpp"
#include "exactcsg/solid/figures.hpp"

namespace exactcsg::cli {

namespace {

struct Arguments {
  std::string first;
  std::string second;
};

constexpr int digits = 17;

// The answer is yes if the solid is empty, else no with its volume and a point of it.
Answer answer_by_emptiness(Context& context, const Solid& solid, const std::string& if_empty,
                           const std::string& if_not) {
  const Boundary boundary = evaluate(solid, context.evaluate_options());
  const std::optional<Point3> witness = interior_point(solid, boundary);
  if (!witness) {
    context.print(if_empty + "\n");
    return Answer::Yes;
  }
  constexpr std::size_t no_exact_volume = 0;
  const Point3& p = *witness;
  context.print(fmt::format(
      "{}, of volume {}; a point of it is\n"
      "  exactly  ({}, {}, {})\n"
      "  nearly   ({}, {}, {})\n",
      if_not, measure(boundary, digits, no_exact_volume).volume_decimal, to_text(p.x), to_text(p.y),
      to_text(p.z), to_decimal(p.x, digits), to_decimal(p.y, digits), to_decimal(p.z, digits)));
  return Answer::No;
}

Answer interference(Context& context, const Arguments& arguments) {
  const io::Model first = read(context, arguments.first);
  const io::Model second = read(context, arguments.second);
  return answer_by_emptiness(
      context, csg::intersect(first.solid, second.solid),
      "no interference: at most the boundaries meet",
      fmt::format("interference: a part of {} lies in {}", arguments.second, arguments.first));
}

Answer contains(Context& context, const Arguments& arguments) {
  const io::Model outer = read(context, arguments.first);
  const io::Model inner = read(context, arguments.second);
  return answer_by_emptiness(
      context, csg::subtract(inner.solid, outer.solid),
      fmt::format("contained: all of {} lies in {}", arguments.second, arguments.first),
      fmt::format("not contained: a part of {} lies outside {}", arguments.second,
                  arguments.first));
}

}  // namespace

Command add_interference(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand(
      "interference",
      "Exit 0 if no part of one model lies in the other; touching is none. If one does, print its "
      "volume and a point of it.");
  command->add_option("A", arguments->first, "a model")->required();
  command->add_option("B", arguments->second, "another")->required();
  return {command, [arguments](Context& context) { return interference(context, *arguments); }};
}

Command add_contains(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand(
      "contains",
      "Exit 0 if all of B lies in A. If not, print the volume of what lies outside, and a point "
      "of it.");
  command->add_option("A", arguments->first, "the model that may contain the other")->required();
  command->add_option("B", arguments->second, "the other")->required();
  return {command, [arguments](Context& context) { return contains(context, *arguments); }};
}

}  // namespace exactcsg::cli
