// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/curved_models.hpp"

#include <fmt/format.h>

#include <charconv>
#include <optional>

#include "cli/openmc.hpp"
#include "exactcsg/io/half_space_tree.hpp"
#include "exactcsg/io/openmc/universes.hpp"
#include "exactcsg/io/openmc/visible_set.hpp"
#include "exactcsg/measure/decimal_bounds.hpp"
#include "exactcsg/measure/pair_proof.hpp"

namespace exactcsg::cli {

namespace {

using io::openmc::HalfSpaceRegion;

struct GeometryName {
  std::string file;
  std::optional<io::openmc::Id> cell;
};

std::optional<GeometryName> geometry_name(const std::string& name) {
  if (io::openmc::is_geometry_file(name)) return GeometryName{name, std::nullopt};
  const std::size_t hash = name.rfind('#');
  if (hash == std::string::npos) return std::nullopt;
  GeometryName result{name.substr(0, hash), 0};
  const char* const end = name.data() + name.size();
  const auto parsed = std::from_chars(name.data() + hash + 1, end, *result.cell);
  const bool is_number = parsed.ec == std::errc() && parsed.ptr == end;
  if (!is_number || !io::openmc::is_geometry_file(result.file)) return std::nullopt;
  return result;
}

HalfSpaceRegion read_region(Context& context, const std::string& name) {
  const auto geometry = geometry_name(name);
  if (!geometry) return io::openmc::region_of(io::half_space_tree(read(context, name).solid));
  const io::openmc::Model model = read_geometry(context, geometry->file);
  return geometry->cell ? cell_set(model, *geometry->cell) : material_set(model);
}

std::string volume_text(const Enclosure& volume) {
  constexpr int digits = 6;
  const measure::DecimalBounds bounds = measure::decimal_bounds(volume, digits);
  return fmt::format("{} to {}", bounds.lower, bounds.upper);
}

struct Texts {
  std::string if_proved;
  std::string if_refuted;
};

Answer print_answer(Context& context, const measure::PairProof& proof, const Texts& texts,
                    double tolerance) {
  if (std::holds_alternative<measure::Proved>(proof.proof)) {
    context.print(texts.if_proved + "\n");
    return Answer::Yes;
  }
  if (const auto* refuted = std::get_if<measure::Refuted>(&proof.proof)) {
    const domain::Point<3>& p = refuted->witnesses.front().point;
    context.print(fmt::format("{}, of volume {}; a point of it is\n{}", texts.if_refuted,
                              volume_text(*proof.volume), witness_lines({p[0], p[1], p[2]})));
    return Answer::No;
  }
  const auto& undecided = std::get<measure::Undecided>(proof.proof);
  constexpr int digits = 3;
  const bool is_tolerated = undecided.volume <= rational_of(tolerance);
  context.print(fmt::format(
      "undecided in {} cells of volume {} together{}: elsewhere, {}\n", undecided.cells.size(),
      measure::decimal_bounds({undecided.volume, undecided.volume}, digits).upper,
      is_tolerated ? ", which the tolerance covers" : "", texts.if_proved));
  return is_tolerated ? Answer::Yes : Answer::No;
}

measure::ProofLimits limits_of(Context& context) {
  measure::ProofLimits limits;
  limits.progress = &context.progress();
  return limits;
}

}  // namespace

bool names_geometry(const std::string& name) { return geometry_name(name).has_value(); }

Answer curved_interference(Context& context, const TwoModels& models) {
  const HalfSpaceRegion first = read_region(context, models.first);
  const HalfSpaceRegion second = read_region(context, models.second);
  return print_answer(
      context, measure::prove_no_interference(first, second, limits_of(context)),
      {"no interference: at most the boundaries meet",
       fmt::format("interference: a part of {} lies in {}", models.second, models.first)},
      models.tolerance);
}

Answer curved_contains(Context& context, const TwoModels& models) {
  const HalfSpaceRegion outer = read_region(context, models.first);
  const HalfSpaceRegion inner = read_region(context, models.second);
  return print_answer(
      context, measure::prove_containment(outer, inner, limits_of(context)),
      {fmt::format("contained: all of {} lies in {}", models.second, models.first),
       fmt::format("not contained: a part of {} lies outside {}", models.second, models.first)},
      models.tolerance);
}

}  // namespace exactcsg::cli
