// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/measure_geometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "cli/openmc.hpp"
#include "exactcsg/io/openmc/cell_volumes.hpp"
#include "exactcsg/measure/decimal_bounds.hpp"

namespace exactcsg::cli {

namespace {

using namespace io::openmc;
using Json = nlohmann::ordered_json;
using measure::StopReason;

constexpr int digits_in_json = 17;

const char* reason_of(StopReason stop) {
  switch (stop) {
    case StopReason::Width:
      return "width";
    case StopReason::Cells:
      return "cells";
    case StopReason::Deadline:
      return "deadline";
    case StopReason::Cancelled:
      return "time limit";
    case StopReason::Precision:
      break;
  }
  return "precision";
}

// Relative, or absolute around zero.
double width_of(const Enclosure& value) {
  const Rational width = value.upper - value.lower;
  return nearest_double(value.lower > 0 ? Rational(width / value.lower) : width);
}

Json ids_of(const Materials& materials) {
  Json ids = Json::array();
  for (const auto& id : materials) ids.push_back(id ? Json(*id) : Json("void"));
  return ids;
}

Json as_json(const VisibleVolume& visible) {
  Json result;
  result["instances"] = visible.instances.fits_ulong_p() ? Json(visible.instances.get_ui())
                                                         : Json(to_text(visible.instances));
  if (!visible.volume) {
    result["volume"] = nullptr;
    result["bounded"] = false;
    return result;
  }
  const measure::DecimalBounds bounds = measure::decimal_bounds(*visible.volume, digits_in_json);
  result["volume"] = {{"lower", bounds.lower}, {"upper", bounds.upper}};
  result["bounded"] = true;
  result["stop"] = reason_of(visible.stop);
  return result;
}

// schema exactcsg.measure_geometry/1: bounds are text, rounded outwards.
Json as_json(const Model& model, const GeometryVolumes& volumes, const WidthOption& width,
             double seconds) {
  Json document;
  document["schema"] = "exactcsg.measure_geometry/1";
  document["model"] = model.name;
  document["width"] = {{width.is_absolute ? "absolute" : "relative", width.width}};
  document["cells"] = Json::array();
  for (std::size_t i = 0; i < model.cells.size(); ++i) {
    const Cell& cell = model.cells[i];
    Json entry;
    entry["id"] = cell.id;
    if (!cell.name.empty()) entry["name"] = cell.name;
    if (cell.fill == FillKind::Material) {
      entry["materials"] = ids_of(cell.materials);
    } else {
      entry["fill"] = cell.fill == FillKind::Universe ? "universe" : "lattice";
    }
    entry.update(as_json(volumes.cells[i]));
    document["cells"].push_back(std::move(entry));
  }
  document["materials"] = Json::array();
  for (const MaterialVolume& material : volumes.materials) {
    Json entry;
    entry["materials"] = ids_of(material.materials);
    entry.update(as_json(material.visible));
    document["materials"].push_back(std::move(entry));
  }
  document["distinct_instances"] = volumes.distinct_instances;
  document["stats"] = {{"cells", volumes.decomposition_cells}};
  document["seconds"] = seconds;
  return document;
}

// As many digits as the bounds have in common, and two more.
int digits_of(const Enclosure& value) {
  const double width = width_of(value);
  if (!(width > 0)) return digits_in_json;
  return std::clamp(static_cast<int>(std::ceil(-std::log10(width))) + 2, 3, digits_in_json);
}

std::string row(const std::string& name, const std::string& what, const VisibleVolume& visible) {
  std::string text = fmt::format("{:<10} {:<14} {:>9}  ", name, what, visible.instances.get_str());
  if (!visible.volume) return text + "unbounded\n";
  const auto bounds = measure::decimal_bounds(*visible.volume, digits_of(*visible.volume));
  fmt::format_to(std::back_inserter(text), "{:>22} {:>22}  {:.1e}{}\n", bounds.lower, bounds.upper,
                 width_of(*visible.volume),
                 visible.stop == StopReason::Width
                     ? std::string()
                     : fmt::format("  ended by: {}", reason_of(visible.stop)));
  return text;
}

std::string header(const char* name, const char* what) {
  return fmt::format("{:<10} {:<14} {:>9}  {:>22} {:>22}  {}\n", name, what, "instances",
                     "volume at least", "at most", "width");
}

std::string as_text(const Model& model, const GeometryVolumes& volumes, double seconds) {
  std::string text = header("cell", "holds");
  for (std::size_t i = 0; i < model.cells.size(); ++i) {
    const Cell& cell = model.cells[i];
    text += row(std::to_string(cell.id),
                cell.fill == FillKind::Material   ? text_of_materials(cell.materials)
                : cell.fill == FillKind::Universe ? std::string("universe")
                                                  : std::string("lattice"),
                volumes.cells[i]);
  }
  text += '\n' + header("material", "");
  for (const MaterialVolume& material : volumes.materials) {
    text += row(text_of_materials(material.materials), "", material.visible);
  }
  return text + fmt::format("\n{} distinct instances, {} cells of the decomposition, {:.3f} s\n",
                            volumes.distinct_instances, volumes.decomposition_cells, seconds);
}

}  // namespace

Answer measure_geometry(Context& context, const std::string& file, const WidthOption& width,
                        bool json, bool lines) {
  const auto start = std::chrono::steady_clock::now();
  const Model model = read_geometry(context, file);
  VolumeLimits limits;
  limits.relative_width = width.is_absolute ? 0 : width.width;
  limits.absolute_width = width.is_absolute ? width.width : 0;
  limits.progress = &context.progress();
  const GeometryVolumes volumes = measure_volumes(model, limits);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (json) {
    context.print(as_json(model, volumes, width, seconds).dump(lines ? -1 : 2) + "\n");
  } else {
    context.print(as_text(model, volumes, seconds));
  }
  const auto wide =
      std::count_if(volumes.cells.begin(), volumes.cells.end(),
                    [](const VisibleVolume& v) { return v.volume && v.stop != StopReason::Width; });
  if (wide == 0) return Answer::Yes;
  context.warn(fmt::format(
      "{}: warning: a limit was reached: the bounds of {} cells are proved, but further apart than "
      "asked for",
      model.name, wide));
  return Answer::No;
}

}  // namespace exactcsg::cli
