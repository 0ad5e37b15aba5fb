// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <variant>

#include "cli/command.hpp"
#include "cli/openmc.hpp"
#include "exactcsg/csg/walk.hpp"
#include "exactcsg/number/enclosure.hpp"

namespace exactcsg::cli {

namespace {

struct Counts {
  std::uint64_t half_spaces = 0;
  std::uint64_t polytopes = 0;
  std::uint64_t meshes = 0;
  std::uint64_t facets = 0;
  std::uint64_t depth = 0;
  std::array<std::uint64_t, 4> operators{};

  void add(const Primitive& primitive) {
    const StoredPolyhedron* polyhedron = polyhedron_of(primitive);
    if (polyhedron == nullptr) {
      ++half_spaces;
      ++facets;
      return;
    }
    ++(std::holds_alternative<ConvexPolytope>(primitive.shape) ? polytopes : meshes);
    facets += polyhedron->facets.size();
  }
};

Counts count(const Solid& solid) {
  Counts counts;
  std::uint64_t depth = 0;
  csg::walk(
      solid.root(),
      [&](Solid::Cursor node) {
        ++counts.operators[static_cast<std::size_t>(node.operation())];
        counts.depth = std::max(counts.depth, ++depth);
        return true;
      },
      [&](Solid::Cursor leaf) {
        if (leaf.kind() == csg::NodeKind::Primitive) counts.add(leaf.primitive());
      },
      [&](Solid::Cursor) { --depth; });
  return counts;
}

Answer print_info(Context& context, const std::string& file) {
  if (io::openmc::is_geometry_file(file)) return print_geometry_info(context, file);
  const io::Model model = read(context, file);
  const Counts counts = count(model.solid);
  std::string text;
  const auto row = [&](std::string_view name, const auto& value) {
    text += fmt::format("{:<22} {}\n", name, value);
  };
  row("model", model.name);
  row("primitives", model.primitives);
  row("  convex polytopes", counts.polytopes);
  row("  polyhedral meshes", counts.meshes);
  row("  half-spaces", counts.half_spaces);
  row("facets of primitives", counts.facets);
  row("nodes of the tree", model.solid.node_count());
  row("  unions", counts.operators[0]);
  row("  intersections", counts.operators[1]);
  row("  differences", counts.operators[2]);
  if (counts.operators[3] != 0) row("  symmetric differences", counts.operators[3]);
  row("depth of the tree", counts.depth);
  row("rounding of sines",
      fmt::format("at most {} per coordinate", to_decimal(model.rounding_bound, 3)));
  for (const io::FontFile& font : model.fonts) {
    row("font", fmt::format("{}: {}, {}", font.asked, font.name, font.file));
  }
  row("warnings", model.warnings.size());
  context.print(text);
  return Answer::Yes;
}

}  // namespace

Command add_info(CLI::App& app) {
  auto file = std::make_shared<std::string>();
  CLI::App* command =
      app.add_subcommand("info", "What a model's file holds, without evaluating it.");
  command->add_option("MODEL", *file, "the model")->required();
  return {command, [file](Context& context) { return print_info(context, *file); }};
}

}  // namespace exactcsg::cli
