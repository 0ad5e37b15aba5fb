// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/openmc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "exactcsg/io/openmc/cell_volumes.hpp"
#include "exactcsg/io/openmc/point_location.hpp"

namespace exactcsg::cli {

namespace {

using namespace io::openmc;

std::string text_of_cells(const Model& model, const std::vector<Index>& cells) {
  std::string text;
  for (const Index cell : cells) {
    fmt::format_to(std::back_inserter(text), "{}{}", text.empty() ? "" : ", ",
                   model.cells[cell].id);
  }
  return text;
}

std::string verdict_of(const Model& model, const Location& location) {
  const std::string cells = text_of_cells(model, location.cells);
  switch (location.verdict) {
    case PointVerdict::InCell:
      return fmt::format("In cell {}, material {}", cells,
                         text_of_materials(model.cells[location.cells.front()].materials));
    case PointVerdict::OnBoundary:
      return cells.empty() ? "On the boundary of an element" : fmt::format("On cells {}", cells);
    case PointVerdict::InOverlap:
      return fmt::format("Overlap of cells {}", cells);
    case PointVerdict::InGap:
      break;
  }
  return "Gap";
}

std::string line_of(const Model& model, const Location& location) {
  return verdict_of(model, location) + "; " + path_text(model, location.path) + '\n';
}

}  // namespace

Model read_geometry(Context& context, const std::filesystem::path& file) {
  context.progress().begin("read", 0);
  Model model = read_geometry_file(file);
  pass_on(context, model.warnings);
  return model;
}

Answer locate_points(Context& context, const std::string& file, const std::vector<Point3>& points) {
  const Model model = read_geometry(context, file);
  const PointLocator locate_point(model);
  context.progress().begin("classify", points.size());
  for (const Point3& point : points) {
    context.print(line_of(model, locate_point(Point(point.x, point.y, point.z))));
    context.progress().advance();
    context.progress().check();
  }
  return Answer::Yes;
}

Answer print_geometry_info(Context& context, const std::string& file) {
  const Model model = read_geometry(context, file);
  std::string text;
  const auto row = [&](std::string_view name, const auto& value) {
    text += fmt::format("{:<22} {}\n", name, value);
  };
  const auto filled = [&](FillKind kind) {
    return std::count_if(model.cells.begin(), model.cells.end(),
                         [&](const Cell& cell) { return cell.fill == kind; });
  };
  row("model", model.name);
  row("surfaces", model.surfaces.size());
  row("cells", model.cells.size());
  row("  of material", filled(FillKind::Material));
  row("  of a universe", filled(FillKind::Universe));
  row("  of a lattice", filled(FillKind::Lattice));
  row("universes", model.universes.size());
  row("  root", model.universes[model.root].id);
  row("lattices", model.lattices.size());
  row("  hexagonal, rounded", std::count_if(model.lattices.begin(), model.lattices.end(),
                                            [](const Lattice& l) { return l.is_rounded(); }));
  row("rotations, rounded",
      std::count_if(model.cells.begin(), model.cells.end(),
                    [](const Cell& cell) { return cell.has_rounded_rotation; }));
  row("warnings", model.warnings.size());
  context.print(text);
  return Answer::Yes;
}

}  // namespace exactcsg::cli
