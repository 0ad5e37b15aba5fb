// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "exactcsg/number/enclosure.hpp"
#include "exactcsg/support/version.hpp"
#include "exactcsg/verify/geometry_check.hpp"

namespace exactcsg::verify {

namespace {

using namespace io::openmc;
using Json = nlohmann::ordered_json;

// Parts that are clean are not listed beyond so many lines.
constexpr std::size_t most_lines = 40;

std::string exact_text(const Point& point) {
  return fmt::format("({}, {}, {})", to_text(point[0]), to_text(point[1]), to_text(point[2]));
}
std::string decimal_text(const Point& point) {
  constexpr int digits = 17;
  return fmt::format("({}, {}, {})", to_decimal(point[0], digits), to_decimal(point[1], digits),
                     to_decimal(point[2], digits));
}
std::array<double, 3> doubles(const Point& point) {
  return {nearest_double(point[0]), nearest_double(point[1]), nearest_double(point[2])};
}
std::string box_text(const domain::Box<3>& box) {
  const auto corner = [](const Point& point) {
    const auto x = doubles(point);
    return fmt::format("({:.10g}, {:.10g}, {:.10g})", x[0], x[1], x[2]);
  };
  return fmt::format("{} to {}", corner(box.lower()), corner(box.upper()));
}

// Not below the volume, which is a bound.
std::string volume_text(const Rational& volume) {
  return volume == 0 ? "0" : fmt::format("{:.3g}", nearest_double(volume) * 1.005);
}

template <class Ids>
std::string list_of(std::string_view one, std::string_view several, const Ids& ids) {
  return fmt::format("{} {}", ids.size() == 1 ? one : several, fmt::join(ids, ", "));
}
template <class Item>
std::vector<Id> ids_of(const std::vector<Item>& items, const std::vector<Index>& indices) {
  std::vector<Id> ids;
  for (const Index index : indices) ids.push_back(items[index].id);
  return ids;
}
std::vector<std::string> labels_of(const Model& model, const std::vector<Index>& surfaces) {
  std::vector<std::string> labels;
  for (const Index surface : surfaces) labels.push_back(label_of(model.surfaces[surface]));
  return labels;
}
// At most so many by id.
constexpr std::size_t most_ids = 20;

std::string cells_text(const Model& model, const std::vector<Index>& cells) {
  std::vector<Id> ids = ids_of(model.cells, cells);
  if (ids.size() <= most_ids) return list_of("cell", "cells", ids);
  ids.resize(most_ids);
  return fmt::format("{} and {} more", list_of("cell", "cells", ids), cells.size() - most_ids);
}

std::string title_of(const Model& model, const Defect& defect) {
  if (defect.kind == DefectKind::Overlap) {
    return fmt::format("overlap of {}", cells_text(model, defect.cells));
  }
  const Step& last = defect.path.back();
  return last.kind == StepKind::Lattice
             ? fmt::format("gap outside lattice {}", model.lattices[last.index].id)
             : fmt::format("gap between the cells of universe {}", model.universes[last.index].id);
}

std::string title_of(const Model& model, const UndecidedPart& part) {
  return fmt::format("undecided: at most {} in {} boxes{}{}", volume_text(part.volume),
                     part.box_count, part.cells.empty() ? "" : ", where there are boundaries of ",
                     part.cells.empty() ? std::string() : cells_text(model, part.cells));
}

std::vector<std::string> warnings_of(const Model& model, const GeometryCheck& check) {
  std::vector<std::string> warnings;
  for (const CoincidentSurfaces& group : check.coincident_surfaces) {
    std::string text =
        fmt::format("surfaces {} are the same", fmt::join(labels_of(model, group.surfaces), ", "));
    for (std::size_t i = 0; i < group.surfaces.size(); ++i) {
      if (group.is_reversed[i] == group.is_reversed[0]) continue;
      text += fmt::format("; {} faces the other way", label_of(model.surfaces[group.surfaces[i]]));
    }
    warnings.push_back(std::move(text));
  }
  if (!check.unused_surfaces.empty()) {
    warnings.push_back(list_of("no cell uses surface", "no cell uses surfaces",
                               labels_of(model, check.unused_surfaces)));
  }
  for (const Index universe : check.unseen_universes) {
    warnings.push_back(fmt::format("universe {} is nowhere seen, and so {}",
                                   model.universes[universe].id,
                                   cells_text(model, model.universes[universe].cells)));
  }
  return warnings;
}

std::string name_of(const Model& model, const Step& part) { return path_text(model, {part}); }

bool is_clean(const CheckedPart& part) {
  return part.overlaps + part.gaps == 0 && part.undecided_volume == 0;
}

std::string table_of(const Model& model, const GeometryCheck& check) {
  std::string text =
      fmt::format("{:<9}  {:<20}  {:>7}  {:>7}  {:>9}  {:>8}  {:>5}  {:>9}\n", "verdict", "part",
                  "cells", "views", "instances", "overlaps", "gaps", "undecided");
  std::size_t lines = 0;
  std::size_t left_out = 0;
  for (const CheckedPart& part : check.parts) {
    if (is_clean(part) && lines >= most_lines) {
      ++left_out;
      continue;
    }
    ++lines;
    const bool is_universe = part.part.kind == StepKind::Universe;
    text += fmt::format(
        "{:<9}  {:<20}  {:>7}  {:>7}  {:>9}  {:>8}  {:>5}  {:>9}\n",
        is_clean(part)                   ? "proved"
        : part.overlaps + part.gaps == 0 ? "undecided"
                                         : "defect",
        name_of(model, part.part) + (is_universe ? "" : ", outside"),
        is_universe ? std::to_string(model.universes[part.part.index].cells.size()) : "",
        part.views, part.instances.get_str(), part.overlaps, part.gaps,
        volume_text(part.undecided_volume));
  }
  if (left_out > 0) text += fmt::format("... and {} more parts, proved\n", left_out);
  return text;
}

std::string conclusion(const GeometryCheck& check, const Rational& tolerance) {
  const auto overlaps =
      std::count_if(check.defects.begin(), check.defects.end(),
                    [](const Defect& defect) { return defect.kind == DefectKind::Overlap; });
  const Rational undecided = check.undecided_volume();
  if (!check.defects.empty()) {
    return fmt::format("not clean: {} overlaps, {} gaps", overlaps,
                       static_cast<std::ptrdiff_t>(check.defects.size()) - overlaps);
  }
  if (undecided == 0) return "clean: proved";
  return fmt::format("{}: undecided in a volume of at most {}, tolerance {}",
                     undecided <= tolerance ? "clean" : "not clean", volume_text(undecided),
                     nearest_double(tolerance));
}

template <class Item>
Json json_ids(const std::vector<Item>& items, const std::vector<Index>& indices) {
  return ids_of(items, indices);
}

// By id; those that users call by something else, by that.
Json json_surfaces(const Model& model, const std::vector<Index>& surfaces) {
  Json list = Json::array();
  for (const Index index : surfaces) {
    const Surface& surface = model.surfaces[index];
    if (surface.label.empty()) {
      list.push_back(surface.id);
    } else {
      list.push_back(surface.label);
    }
  }
  return list;
}

Json json_point(const Point& point) {
  return {{"exact", {to_text(point[0]), to_text(point[1]), to_text(point[2])}},
          {"nearly", doubles(point)}};
}
Json json_box(const domain::Box<3>& box) {
  return {{"lower", doubles(box.lower())}, {"upper", doubles(box.upper())}};
}

Json json_of(const Model& model, const CheckedPart& part) {
  return {{"part", name_of(model, part.part)},
          {"views", part.views},
          {"instances", part.instances.get_str()},
          {"overlaps", part.overlaps},
          {"gaps", part.gaps},
          {"undecided_volume", nearest_double(part.undecided_volume)}};
}
Json json_of(const Model& model, const Defect& defect) {
  return {{"kind", defect.kind == DefectKind::Overlap ? "overlap" : "gap"},
          {"cells", json_ids(model.cells, defect.cells)},
          {"point", json_point(defect.point)},
          {"path", path_text(model, defect.path)}};
}
Json json_of(const Model& model, const UndecidedPart& part) {
  Json boxes = Json::array();
  for (const domain::Box<3>& box : part.boxes) boxes.push_back(json_box(box));
  return {{"volume", nearest_double(part.volume)},
          {"path", path_text(model, part.path)},
          {"cells", json_ids(model.cells, part.cells)},
          {"box_count", part.box_count},
          {"boxes", std::move(boxes)}};
}

}  // namespace

std::string render_text(const Model& model, const GeometryCheck& check, const Rational& tolerance) {
  std::string text =
      fmt::format("{}\nbox {}\n\n{}", check.model, box_text(check.box), table_of(model, check));
  for (const Defect& defect : check.defects) {
    text += fmt::format("\n{}\n  exactly  {}\n  nearly   {}\n  path     {}\n",
                        title_of(model, defect), exact_text(defect.point),
                        decimal_text(defect.point), path_text(model, defect.path));
  }
  for (const UndecidedPart& part : check.undecided) {
    text += fmt::format("\n{}\n", title_of(model, part));
    for (const domain::Box<3>& box : part.boxes) text += fmt::format("  {}\n", box_text(box));
    text += fmt::format("  path     {}\n", path_text(model, part.path));
  }
  const std::vector<std::string> warnings = warnings_of(model, check);
  if (!warnings.empty()) text += '\n';
  for (const std::string& warning : warnings) text += fmt::format("warning: {}\n", warning);
  return text + fmt::format("\n{}, {:.2f} s\n", conclusion(check, tolerance), check.seconds);
}

std::string render_json(const Model& model, const GeometryCheck& check, const Rational& tolerance) {
  Json document{{"schema", "exactcsg.check/1"},
                {"model", check.model},
                {"library", version},
                {"clean", check.is_clean(tolerance)},
                {"tolerance", nearest_double(tolerance)},
                {"undecided_volume", nearest_double(check.undecided_volume())},
                {"seconds", check.seconds},
                {"box", json_box(check.box)},
                {"parts", Json::array()},
                {"defects", Json::array()},
                {"undecided", Json::array()},
                {"coincident_surfaces", Json::array()},
                {"unused_surfaces", json_surfaces(model, check.unused_surfaces)},
                {"unseen_universes", json_ids(model.universes, check.unseen_universes)}};
  for (const CheckedPart& part : check.parts) document["parts"].push_back(json_of(model, part));
  for (const Defect& defect : check.defects) document["defects"].push_back(json_of(model, defect));
  for (const UndecidedPart& part : check.undecided) {
    document["undecided"].push_back(json_of(model, part));
  }
  for (const CoincidentSurfaces& group : check.coincident_surfaces) {
    document["coincident_surfaces"].push_back(json_surfaces(model, group.surfaces));
  }
  // Names of files may not be UTF-8.
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Report as_report(const Model& model, const GeometryCheck& check, const Rational& tolerance) {
  Report report;
  report.model = check.model;
  report.library = std::string(version);
  report.seconds = check.seconds;
  report.notes = warnings_of(model, check);
  const auto add = [&](const CheckedPart& part, const char* what, std::size_t count) {
    Check line;
    line.oracle = "check";
    line.name = fmt::format("{}: {}", name_of(model, part.part), what);
    line.ours = std::to_string(count);
    line.theirs = "0";
    if (count > 0) line.verdict = Verdict::Failed;
    report.checks.push_back(std::move(line));
    return report.checks.size() - 1;
  };
  for (const CheckedPart& part : check.parts) {
    const std::size_t overlaps = add(part, "overlaps", part.overlaps);
    const std::size_t gaps = add(part, "gaps", part.gaps);
    for (const Defect& defect : check.defects) {
      const Step& last = defect.path.back();
      if (last.kind != part.part.kind || last.index != part.part.index) continue;
      add_mismatch(report.checks[defect.kind == DefectKind::Overlap ? overlaps : gaps],
                   {fmt::format("{}: {}", title_of(model, defect), exact_text(defect.point)),
                    {doubles(defect.point)}});
    }
  }
  Check undecided;
  undecided.oracle = "check";
  undecided.name = "undecided volume";
  undecided.ours = volume_text(check.undecided_volume());
  undecided.theirs = "0";
  undecided.bound = fmt::format("{}", nearest_double(tolerance));
  if (check.undecided_volume() > tolerance) undecided.verdict = Verdict::Failed;
  for (const UndecidedPart& part : check.undecided) {
    undecided.explanation +=
        fmt::format("{}; path {}\n", title_of(model, part), path_text(model, part.path));
  }
  report.checks.push_back(std::move(undecided));
  return report;
}

}  // namespace exactcsg::verify
