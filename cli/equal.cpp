// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "cli/two_models.hpp"
#include "exactcsg/solid/classify.hpp"

namespace exactcsg::cli {

namespace {

Answer equal(Context& context, const TwoModels& models) {
  const io::Model first = read(context, models.first);
  const io::Model second = read(context, models.second);
  const auto difference = find_difference(first.solid, second.solid, context.evaluate_options());
  if (!difference) {
    context.print("equal: the same solid\n");
    return Answer::Yes;
  }
  const std::string& inside = difference->in_first ? models.first : models.second;
  const std::string& outside = difference->in_first ? models.second : models.first;
  context.print(fmt::format("different: a point lies in {} and outside {}\n{}", inside, outside,
                            witness_lines(difference->witness)));
  return Answer::No;
}

}  // namespace

Command add_equal(CLI::App& app) {
  return add_command_on_two_models(
      app,
      {"equal", "Are two models the same solid? If not, print a point that lies in one alone.",
       "the first model", "the second model"},
      equal);
}

}  // namespace exactcsg::cli
