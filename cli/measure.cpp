// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.hpp"
#include "cli/measure_geometry.hpp"
#include "exactcsg/io/openmc/model.hpp"
#include "exactcsg/number/enclosure.hpp"
#include "exactcsg/solid/figures.hpp"
#include "exactcsg/solid/scaled_vertices.hpp"

namespace exactcsg::cli {

namespace {

using Json = nlohmann::ordered_json;

struct Arguments {
  std::vector<std::string> models;
  int digits = 17;
  bool json = false;
  WidthOption width;
};

// Longer fractions are of no use to a reader; the decimal has any number of digits.
constexpr std::size_t longest_in_json = 1000;
constexpr std::size_t longest_in_text = 80;

// Of a number of so many digits.
constexpr std::size_t bits_of(std::size_t digits) { return (digits * 3322 + 999) / 1000; }

using Triple = std::array<std::string, 3>;

struct Measurement {
  std::string model;
  MeasuredFigures figures;
  std::optional<std::string> exact_volume;
  std::optional<std::array<Triple, 2>> box;
  Topology topology;
  std::string digest;
  std::size_t primitives = 0;
  EvaluationStatistics statistics;
  double seconds = 0;
};

Triple decimals(const Point3& point, int digits) {
  return {to_decimal(point.x, digits), to_decimal(point.y, digits), to_decimal(point.z, digits)};
}

// Summing up fractions without a common denominator is work that only machines ask for.
std::size_t longest_fraction_shown(const Boundary& boundary, bool json) {
  if (json) return longest_in_json;
  return has_short_common_denominator(boundary) ? longest_in_text : 0;
}

Measurement take(Context& context, const io::Model& model, const Arguments& arguments) {
  const int digits = arguments.digits;
  Measurement result;
  result.model = model.name;
  const Boundary boundary = evaluate(model.solid, context.evaluate_options());
  context.progress().begin("measure", 0);
  const std::size_t longest_fraction = longest_fraction_shown(boundary, arguments.json);
  result.figures = measure(boundary, digits, bits_of(longest_fraction));
  context.progress().check();
  for (const std::string& figure : result.figures.unproved) {
    context.warn(fmt::format("{}: warning: last digit not proved: {}", model.name, figure));
  }
  if (result.figures.exact_volume) {
    std::string text = to_text(*result.figures.exact_volume);
    if (text.size() <= longest_fraction) result.exact_volume = std::move(text);
  }
  if (const auto& box = result.figures.bounding_box) {
    result.box = {decimals(box->lower, digits), decimals(box->upper, digits)};
  }
  result.topology = topology(boundary);
  context.progress().check();
  result.digest = digest(boundary);
  result.primitives = model.primitives;
  result.statistics = boundary.statistics;
  return result;
}

Json tiers(const TierStatistics& statistics) {
  constexpr std::array<const char*, tier_count> names{"symbolic", "double", "fixed", "unbounded"};
  Json result;
  for (std::size_t i = 0; i < tier_count; ++i) {
    result[names[i]] = {{"answers", statistics.answers[i]}, {"zeros", statistics.zeros[i]}};
  }
  return result;
}

// schema exactcsg.measure/1: decimals are text, because they may have more digits than a double.
Json as_json(const Measurement& m) {
  Json document;
  document["schema"] = "exactcsg.measure/1";
  document["model"] = m.model;
  document["volume"]["decimal"] = m.figures.volume_decimal;
  document["volume"]["exact"] = m.exact_volume ? Json(*m.exact_volume) : Json(nullptr);
  document["area"]["decimal"] = m.figures.area_decimal;
  document["centroid"] =
      m.figures.centroid_decimals ? Json(*m.figures.centroid_decimals) : Json(nullptr);
  document["bounding_box"] =
      m.box ? Json{{"lower", (*m.box)[0]}, {"upper", (*m.box)[1]}} : Json(nullptr);
  document["vertices"] = m.topology.vertices;
  document["edges"] = m.topology.edges;
  document["faces"] = m.topology.faces;
  document["components"] = m.topology.components;
  document["cavities"] = m.topology.cavities;
  document["genus"] = m.topology.genus;
  document["digest"] = m.digest;
  document["primitives"] = m.primitives;
  document["seconds"] = m.seconds;
  document["stats"] = {{"tiers", tiers(m.statistics.tiers)},
                       {"facets", m.statistics.facets},
                       {"cells", m.statistics.cells},
                       {"evaluated_cells", m.statistics.evaluated_cells},
                       {"pieces", m.statistics.pieces}};
  return document;
}

std::string as_text(const Measurement& m) {
  std::string text;
  const auto row = [&](std::string_view name, const auto& value) {
    text += fmt::format("{:<16} {}\n", name, value);
  };
  const auto triple = [](const Triple& t) { return fmt::format("({}, {}, {})", t[0], t[1], t[2]); };
  row("volume", m.figures.volume_decimal);
  if (m.exact_volume && *m.exact_volume != m.figures.volume_decimal) {
    row("  exactly", *m.exact_volume);
  }
  row("area", m.figures.area_decimal);
  if (m.figures.centroid_decimals) row("centre of mass", triple(*m.figures.centroid_decimals));
  if (m.box) {
    row("bounding box", fmt::format("{} to {}", triple((*m.box)[0]), triple((*m.box)[1])));
  }
  row("vertices", m.topology.vertices);
  row("edges", m.topology.edges);
  row("faces", m.topology.faces);
  row("components", m.topology.components);
  if (m.topology.cavities != 0) row("cavities", m.topology.cavities);
  row("genus", m.topology.genus);
  row("digest", m.digest);
  row("primitives", m.primitives);
  row("seconds", fmt::format("{:.3f}", m.seconds));
  return text;
}

Measurement measure_file(Context& context, const std::string& file, const Arguments& arguments) {
  const auto start = std::chrono::steady_clock::now();
  Measurement measurement = take(context, read(context, file), arguments);
  measurement.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return measurement;
}

Answer print_measures_of_one(Context& context, const Arguments& arguments) {
  const std::string& file = arguments.models.front();
  if (io::openmc::is_geometry_file(file)) {
    return measure_geometry(context, file, arguments.width, arguments.json, false);
  }
  const Measurement measurement = measure_file(context, file, arguments);
  context.print(arguments.json ? as_json(measurement).dump(2) + "\n" : as_text(measurement));
  return Answer::Yes;
}

// What ends the work on one model, but not on the next.
bool concerns_one_model(const Error& error) {
  return error.id() != ErrorId::TimeLimit && error.id() != ErrorId::Cancelled;
}

// JSON Lines, or texts that each begin with the model's name.
Answer print_measures(Context& context, const Arguments& arguments) {
  if (arguments.models.size() == 1) return print_measures_of_one(context, arguments);
  Answer answer = Answer::Yes;
  for (const std::string& file : arguments.models) {
    try {
      if (io::openmc::is_geometry_file(file)) {
        if (!arguments.json) context.print(fmt::format("{:<16} {}\n", "model", file));
        const Answer of_one =
            measure_geometry(context, file, arguments.width, arguments.json, true);
        if (of_one == Answer::No) answer = Answer::No;
        continue;
      }
      const Measurement measurement = measure_file(context, file, arguments);
      context.print(arguments.json ? as_json(measurement).dump() + "\n"
                                   : fmt::format("{:<16} {}\n{}\n", "model", measurement.model,
                                                 as_text(measurement)));
    } catch (const Error& error) {
      if (!concerns_one_model(error)) throw;
      context.refuse(error);
    }
  }
  return answer;
}

}  // namespace

Command add_measure(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("measure",
                                         "Volume, area, centre of mass, bounding box, counts, "
                                         "genus and digest. Of an OpenMC or MCNP geometry: "
                                         "proved bounds of the volumes of its cells and materials; "
                                         "exit 1 if a limit was reached before "
                                         "they were as narrow as asked for.");
  command
      ->add_option("MODEL", arguments->models,
                   "the model; or several, of which one that is refused does not stop the others")
      ->required();
  command
      ->add_option("--digits", arguments->digits,
                   "significant digits of decimals, correctly rounded")
      ->type_name("N")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command
      ->add_option("--width", arguments->width.width,
                   "of an OpenMC geometry: how far apart the bounds of a cell's volume may be, in "
                   "relation to the volume")
      ->type_name("W")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_flag("--absolute", arguments->width.is_absolute,
                    "W is not relative, but a volume in the model's unit");
  command->add_flag("--json", arguments->json,
                    "a JSON object, schema exactcsg.measure/1, or "
                    "exactcsg.measure_geometry/1; of several models one on each line");
  Command measuring{command,
                    [arguments](Context& context) { return print_measures(context, *arguments); }};
  measuring.models = [arguments] { return arguments->models.size(); };
  return measuring;
}

}  // namespace exactcsg::cli
