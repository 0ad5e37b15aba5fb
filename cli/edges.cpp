// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.hpp"
#include "cli/output_file.hpp"
#include "cli/wire_frame.hpp"
#include "exactcsg/number/enclosure.hpp"

namespace exactcsg::cli {

namespace {

struct Arguments {
  std::string model;
  std::string output;
};

std::string edges_json(const Boundary& boundary, const std::string& name) {
  nlohmann::ordered_json vertices = nlohmann::ordered_json::array();
  for (const Point3& p : boundary.vertices) {
    vertices.push_back({to_decimal(p.x, 17), to_decimal(p.y, 17), to_decimal(p.z, 17)});
  }
  nlohmann::ordered_json edges = nlohmann::ordered_json::array();
  for (const BoundaryEdge& edge : boundary.edges) edges.push_back({edge.from, edge.to});
  const nlohmann::ordered_json document{{"schema", "exactcsg.edges/1"},
                                        {"model", name},
                                        {"vertices", std::move(vertices)},
                                        {"edges", std::move(edges)}};
  return document.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

Answer write(Context& context, const Arguments& arguments) {
  expect_ending(arguments.output, {".svg", ".json"});
  const bool is_drawing = std::filesystem::path(arguments.output).extension() == ".svg";
  const io::Model model = read(context, arguments.model);
  const Boundary boundary = evaluate(model.solid, context.evaluate_options());
  context.progress().begin("write", 0);
  write_file(arguments.output,
             is_drawing ? wire_frame_svg(boundary, model.name) : edges_json(boundary, model.name));
  context.print(arguments.output + ": " + std::to_string(boundary.edges.size()) + " edges, " +
                std::to_string(boundary.vertices.size()) + " vertices\n");
  return Answer::Yes;
}

}  // namespace

Command add_edges(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand(
      "edges",
      "Write the edges of the solid, each as long as possible, as a drawing or as numbers.");
  command->add_option("MODEL", arguments->model, "the model")->required();
  command->add_option("-o,--output", arguments->output, "the drawing (.svg) or the numbers (.json)")
      ->type_name("FILE")
      ->required();
  return {command, [arguments](Context& context) { return write(context, *arguments); }};
}

}  // namespace exactcsg::cli
