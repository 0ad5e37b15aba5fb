// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/verify/verify_geometry.hpp"

#include <fmt/format.h>

#include <chrono>
#include <optional>
#include <utility>

#include "exactcsg/io/openmc/cell_volumes.hpp"
#include "exactcsg/io/openmc/region_bounds.hpp"
#include "exactcsg/io/openmc/universes.hpp"
#include "exactcsg/measure/decimal_bounds.hpp"
#include "exactcsg/support/version.hpp"
#include "exactcsg/verify/monte_carlo.hpp"

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

Check skipped(std::string name, std::string explanation) {
  Check check;
  check.oracle = "sampling";
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
  std::string reason;
  if (const std::optional<SamplingBox> box = sampling_box(model, reason)) {
    const std::vector<SampledVolume> sampled =
        sample_volumes(model, *box, options.points, options.seed, options.progress);
    const std::vector<bool> without_end = cells_without_end(model, volumes);
    for (std::size_t i = 0; i < model.cells.size(); ++i) {
      const std::string name = fmt::format("sampling: cell {}", model.cells[i].id);
      report.checks.push_back(
          without_end[i] ? skipped(name, "it is not bounded, or a cell that it is seen in is not")
                         : compared(name, volumes.cells[i], sampled[i], options.deviations));
    }
  } else {
    report.checks.push_back(skipped("sampling: volumes", reason));
  }
  Check nef = skipped("nef: faceted model", "no faceted version of a geometry is built yet");
  nef.oracle = "nef";
  report.checks.push_back(std::move(nef));
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

}  // namespace exactcsg::verify
