// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "cli/curved_models.hpp"
#include "cli/two_models.hpp"
#include "exactcsg/solid/classify.hpp"
#include "exactcsg/solid/figures.hpp"

namespace exactcsg::cli {

namespace {

// The answer is yes if the solid is empty, else no with its volume and a point of it.
Answer answer_by_emptiness(Context& context, const Solid& solid, const std::string& if_empty,
                           const std::string& if_not) {
  const Boundary boundary = evaluate(solid, context.evaluate_options());
  const std::optional<Point3> witness = interior_point(solid, boundary);
  if (!witness) {
    context.print(if_empty + "\n");
    return Answer::Yes;
  }
  constexpr int digits = 17;
  constexpr std::size_t no_exact_volume = 0;
  context.print(
      fmt::format("{}, of volume {}; a point of it is\n{}", if_not,
                  measure(boundary, digits, no_exact_volume, Wanted::VolumeAndArea).volume_decimal,
                  witness_lines(*witness)));
  return Answer::No;
}

bool is_about_geometry(const TwoModels& models) {
  return names_geometry(models.first) || names_geometry(models.second);
}

Answer interference(Context& context, const TwoModels& models) {
  if (is_about_geometry(models)) return curved_interference(context, models);
  const io::Model first = read(context, models.first);
  const io::Model second = read(context, models.second);
  return answer_by_emptiness(
      context, csg::intersect(first.solid, second.solid),
      "no interference: at most the boundaries meet",
      fmt::format("interference: a part of {} lies in {}", models.second, models.first));
}

Answer contains(Context& context, const TwoModels& models) {
  if (is_about_geometry(models)) return curved_contains(context, models);
  const io::Model outer = read(context, models.first);
  const io::Model inner = read(context, models.second);
  return answer_by_emptiness(
      context, csg::subtract(inner.solid, outer.solid),
      fmt::format("contained: all of {} lies in {}", models.second, models.first),
      fmt::format("not contained: a part of {} lies outside {}", models.second, models.first));
}

}  // namespace

Command add_interference(CLI::App& app) {
  return add_command_on_two_models(
      app,
      {"interference",
       "Exit 0 if no part of one model lies in the other; touching is none. If one does, print its "
       "volume and a point of it.",
       "a model; of an OpenMC geometry the set of its materials without void, or with #ID a cell",
       "another", true},
      interference);
}

Command add_contains(CLI::App& app) {
  return add_command_on_two_models(
      app,
      {"contains",
       "Exit 0 if all of B lies in A. If not, print the volume of what lies outside, and a point "
       "of it.",
       "the model that may contain the other; of an OpenMC geometry the set of its materials "
       "without void, or with #ID a cell",
       "the other", true},
      contains);
}

}  // namespace exactcsg::cli
