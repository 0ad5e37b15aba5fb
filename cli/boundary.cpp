// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <memory>
#include <optional>

#include "cli/command.hpp"
#include "cli/output_file.hpp"
#include "exactcsg/io/mesh/mesh_file.hpp"
#include "exactcsg/io/mesh/snap.hpp"
#include "exactcsg/io/mesh/written_surface.hpp"

namespace exactcsg::cli {

namespace {

struct Arguments {
  std::string model;
  std::string output;
  bool is_unchecked = false;
  bool is_snapped = false;
};

// Rounding may turn a facet over, or let two meet.
void check_what_was_written(Context& context, const Boundary& boundary, const std::string& file) {
  if (boundary.empty()) return;
  context.progress().begin("check", 0);
  const io::PolygonSoup soup = io::read_polygon_soup(file);
  const auto [fault, touches_itself] = io::examine(soup);
  const std::size_t before = io::count_pieces(boundary);
  const std::size_t after = io::count_pieces(soup);
  if (fault) {
    context.warn(
        fmt::format("{}: warning: the rounded surface bounds no solid: {}", file, fault->what()));
  } else if (before != after) {
    context.warn(fmt::format("{}: warning: the rounded surface has {} pieces, the solid's {}", file,
                             after, before));
  } else {
    context.print(fmt::format("{}: the rounded surface bounds a solid, in {} {}{}\n", file, after,
                              after == 1 ? "piece" : "pieces",
                              touches_itself ? ", and touches itself" : ""));
  }
}

std::string counted(std::size_t count, const char* one) {
  return fmt::format("{} {}{}", count, one, count == 1 ? "" : "s");
}

void write_snapped(Context& context, const Boundary& boundary, const std::string& output) {
  context.progress().begin("snap", 0);
  const io::SnappedSurface snapped =
      io::snap(boundary, io::is_single_precision(output), context.evaluate_options());
  write_file(output,
             [&](const std::filesystem::path& file) { io::write_surface(snapped.surface, file); });
  context.print(fmt::format("{}: {} triangles, coordinates moved by at most {:.3g}\n", output,
                            snapped.surface.triangles.size(), snapped.largest_move));
  if (snapped.rounds != 0 || snapped.flat_triangles != 0) {
    context.print(fmt::format(
        "{}: snapped{}: {} taken out, crossings resolved in {}, volume changed by {:.3g}\n", output,
        snapped.grid > 0 ? fmt::format(" to multiples of {:.3g}", snapped.grid) : "",
        counted(snapped.flat_triangles, "flat triangle"), counted(snapped.rounds, "round"),
        snapped.volume_change));
  }
  check_what_was_written(context, boundary, output);
}

Answer write(Context& context, const Arguments& arguments) {
  expect_ending(arguments.output, {".off", ".stl", ".obj", ".ply"});
  const io::Model model = read(context, arguments.model);
  const Boundary boundary = evaluate(model.solid, context.evaluate_options());
  if (arguments.is_snapped && !boundary.empty()) {
    write_snapped(context, boundary, arguments.output);
    return Answer::Yes;
  }
  context.progress().begin("write", 0);
  io::WriteReport report;
  write_file(arguments.output, [&](const std::filesystem::path& file) {
    report = io::write_boundary(boundary, file);
  });
  context.print(fmt::format("{}: {} triangles, coordinates rounded by at most {:.3g}\n",
                            arguments.output, report.triangles, report.largest_rounding));
  if (!arguments.is_unchecked) check_what_was_written(context, boundary, arguments.output);
  if (report.merged_vertices != 0 || report.degenerate_triangles != 0) {
    context.warn(fmt::format(
        "{}: warning: the format's rounding made {} distinct vertices equal and {} triangles flat",
        arguments.output, report.merged_vertices, report.degenerate_triangles));
  }
  return Answer::Yes;
}

}  // namespace

Command add_boundary(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("boundary", "Write the boundary of the solid as a watertight mesh.");
  command->add_option("MODEL", arguments->model, "the model")->required();
  command->add_option("-o,--output", arguments->output, "the mesh: .off, .stl (binary), .obj, .ply")
      ->type_name("FILE")
      ->required();
  CLI::Option* snap = command->add_flag(
      "--snap", arguments->is_snapped,
      "repair what rounding breaks: the file bounds a solid, or nothing is written");
  command
      ->add_flag("--no-check", arguments->is_unchecked,
                 "do not read the file again to see what rounding made of the surface")
      ->excludes(snap);
  return {command, [arguments](Context& context) { return write(context, *arguments); }};
}

}  // namespace exactcsg::cli
