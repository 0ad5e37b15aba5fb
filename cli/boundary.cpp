// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <memory>

#include "cli/command.hpp"
#include "cli/output_file.hpp"
#include "exactcsg/io/mesh/mesh_file.hpp"

namespace exactcsg::cli {

namespace {

struct Arguments {
  std::string model;
  std::string output;
};

void check_format(const std::string& file) {
  const std::string ending = std::filesystem::path(file).extension().string();
  if (ending == ".off" || ending == ".stl" || ending == ".obj" || ending == ".ply") return;
  throw Error(ErrorId::UnknownFormat,
              {fmt::format("'{}'", ending), ".off, .stl, .obj or .ply", SourcePosition{file}});
}

Answer write(Context& context, const Arguments& arguments) {
  check_format(arguments.output);
  const io::Model model = read(context, arguments.model);
  const Boundary boundary = evaluate(model.solid, context.evaluate_options());
  context.progress().begin("write", 0);
  io::WriteReport report;
  write_file(arguments.output, [&](const std::filesystem::path& file) {
    report = io::write_boundary(boundary, file);
  });
  context.print(fmt::format("{}: {} triangles, coordinates rounded by at most {:.3g}\n",
                            arguments.output, report.triangles, report.largest_rounding));
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
  return {command, [arguments](Context& context) { return write(context, *arguments); }};
}

}  // namespace exactcsg::cli
