// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/verify/verify_geometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <string_view>
#include <utility>

#include "exactcsg/io/openmc/cell_volumes.hpp"
#include "exactcsg/io/openmc/region_bounds.hpp"
#include "exactcsg/io/openmc/universes.hpp"
#include "exactcsg/measure/bounding_box.hpp"
#include "exactcsg/measure/decimal_bounds.hpp"
#include "exactcsg/support/version.hpp"
#include "exactcsg/verify/monte_carlo.hpp"
#include "exactcsg/verify/nef_volume.hpp"

namespace exactcsg::verify {

namespace {

using namespace io::openmc;

// The cells that may be visible outside every box: those of universes in cells without bounds.
std::vector<bool> cells_without_end(const Model& model, const GeometryVolumes& volumes) {
  std::vector<bool> is_universe_without_end(model.universes.size());
  std::vector<bool> result(model.cells.size());
  for (const Index universe : universes_from_above(model)) {
    for (const Index index : model.universes[universe].cells) {
      result[index] = is_universe_without_end[universe] || !volumes.cells[index].volume;
      if (!result[index]) continue;
      for (const Index below : universes_in(model, model.cells[index])) {
        is_universe_without_end[below] = true;
      }
    }
  }
  return result;
}

std::optional<SamplingBox> sampling_box(const Model& model, std::string& reason) {
  try {
    const domain::Box<3> box = box_of_root(model);
    SamplingBox result{};
    for (std::size_t i = 0; i < 3; ++i) {
      result.lower[i] = nearest_double(box.lower()[i]);
      result.upper[i] = nearest_double(box.upper()[i]);
    }
    return result;
  } catch (const Error& error) {
    if (error.id() != ErrorId::UnboundedSolid) throw;
    reason = error.what();
    return std::nullopt;
  }
}

Check skipped(std::string oracle, std::string name, std::string explanation) {
  Check check;
  check.oracle = std::move(oracle);
  check.name = std::move(name);
  check.verdict = Verdict::Skipped;
  check.explanation = std::move(explanation);
  return check;
}

Check compared(std::string name, const VisibleVolume& ours, const SampledVolume& theirs,
               double deviations) {
  constexpr int digits = 8;
  const measure::DecimalBounds bounds = measure::decimal_bounds(*ours.volume, digits);
  const double reach = deviations * theirs.deviation;
  const double lower = nearest_double(ours.volume->lower);
  const double upper = nearest_double(ours.volume->upper);
  const double beyond = theirs.estimate < lower   ? theirs.estimate - lower
                        : theirs.estimate > upper ? theirs.estimate - upper
                                                  : 0;
  Check check;
  check.oracle = "sampling";
  check.name = std::move(name);
  check.ours = fmt::format("{} to {}", bounds.lower, bounds.upper);
  check.theirs = fmt::format("{:.6g}", theirs.estimate);
  check.difference = fmt::format("{:.2g}", beyond);
  check.bound = fmt::format("{:.2g} ({:g} deviations)", reach, deviations);
  if (std::abs(beyond) > reach) {
    check.verdict = Verdict::Failed;
    check.explanation = fmt::format("{} random points were in the cell", theirs.hits);
  }
  return check;
}

void hold_against_points(const Model& model, const GeometryVolumes& volumes,
                         const VerifyGeometryOptions& options, Report& report) {
  std::string reason;
  if (const std::optional<SamplingBox> box = sampling_box(model, reason)) {
    const std::vector<SampledVolume> sampled =
        sample_volumes(model, *box, options.points, options.seed, options.progress);
    const std::vector<bool> without_end = cells_without_end(model, volumes);
    for (std::size_t i = 0; i < model.cells.size(); ++i) {
      const std::string name = fmt::format("sampling: cell {}", model.cells[i].id);
      report.checks.push_back(
          without_end[i]
              ? skipped("sampling", name, "it is not bounded, or a cell that it is seen in is not")
              : compared(name, volumes.cells[i], sampled[i], options.deviations));
    }
  } else {
    report.checks.push_back(skipped("sampling", "sampling: volumes", reason));
  }
}

// A quarter more on each side, so that a bounding box that is too small is seen.
domain::Box<3> enlarged(const domain::Box<3>& box) {
  domain::Coordinates<3> lower = box.lower().coordinates();
  domain::Coordinates<3> upper = box.upper().coordinates();
  for (std::size_t i = 0; i < 3; ++i) {
    const Rational margin = (upper[i] - lower[i]) / 4;
    lower[i] -= margin;
    upper[i] += margin;
  }
  return {lower, upper};
}

// Against the cell's own region: what of it is visible where nothing clips it.
Check compared_with_nef(const Model& model, Index index, const Enclosure& volume, double seconds,
                        const VerifyGeometryOptions& options) {
  const Cell& cell = model.cells[index];
  std::string name = fmt::format("nef: cell {}", cell.id);
  if (seconds <= 0) {
    return skipped("nef", std::move(name),
                   fmt::format("over the budget of {:g} s for all cells", options.nef_seconds));
  }
  const measure::Extent extent = measure::bounding_box(half_spaces(model, cell.region));
  if (!extent.box) return skipped("nef", std::move(name), "the cell has no bounding box");
  NefLimits limits;
  limits.seconds = seconds;
  limits.progress = options.progress;
  return compare_with_nef(
      std::move(name), volume,
      nef_volume(model, cell.region, enlarged(*extent.box), options.nef_segments, limits));
}

void hold_against_nef(const Model& model, const GeometryVolumes& volumes,
                      const VerifyGeometryOptions& options, Report& report) {
  const auto start = std::chrono::steady_clock::now();
  const std::vector<Index>& cells = model.universes[model.root].cells;
  if (options.progress != nullptr) options.progress->begin("Nef polyhedra", cells.size());
  for (const Index index : cells) {
    const std::optional<Enclosure>& volume = volumes.cells[index].volume;
    const double used =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    report.checks.push_back(
        volume ? compared_with_nef(model, index, *volume, options.nef_seconds - used, options)
               : skipped("nef", fmt::format("nef: cell {}", model.cells[index].id),
                         "it is not bounded"));
    if (options.progress == nullptr) continue;
    options.progress->advance();
    options.progress->check();
  }
  if (cells.size() < model.cells.size()) {
    report.checks.push_back(skipped("nef", "nef: cells of other universes",
                                    "faceted are the root's cells only, which nothing clips"));
  }
}

}  // namespace

Report verify_geometry(const Model& model, const VerifyGeometryOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  Report report;
  report.model = model.name;
  report.library = std::string(version);
  VolumeLimits limits;
  limits.relative_width = options.relative_width;
  limits.progress = options.progress;
  const GeometryVolumes volumes = measure_volumes(model, limits);
  if (options.progress != nullptr) options.progress->check();
  const auto is_enabled = [&](std::string_view oracle) {
    return std::find(options.disabled.begin(), options.disabled.end(), oracle) ==
           options.disabled.end();
  };
  if (is_enabled("sampling")) hold_against_points(model, volumes, options, report);
  if (is_enabled("nef")) hold_against_nef(model, volumes, options, report);
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

}  // namespace exactcsg::verify
