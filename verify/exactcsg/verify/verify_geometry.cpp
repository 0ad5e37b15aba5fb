// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/verify/verify_geometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <numeric>
#include <optional>
#include <string_view>
#include <utility>

#include "exactcsg/io/openmc/cell_volumes.hpp"
#include "exactcsg/io/openmc/region_bounds.hpp"
#include "exactcsg/io/openmc/universes.hpp"
#include "exactcsg/support/version.hpp"
#include "exactcsg/verify/golden_geometry.hpp"
#include "exactcsg/verify/monte_carlo.hpp"
#include "exactcsg/verify/nef_volume.hpp"
#include "exactcsg/verify/volume_bounds.hpp"

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
  const double reach = deviations * theirs.deviation;
  const double lower = nearest_double(ours.volume->lower);
  const double upper = nearest_double(ours.volume->upper);
  const double beyond = theirs.estimate < lower   ? theirs.estimate - lower
                        : theirs.estimate > upper ? theirs.estimate - upper
                                                  : 0;
  Check check;
  check.oracle = "sampling";
  check.name = std::move(name);
  check.ours = text_of(*ours.volume);
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

// A quarter more on each side, so that a bounding box that is too small is seen; but not beyond the
// view's, outside of which its window is not known.
domain::Box<3> enlarged(const domain::Box<3>& box, const std::optional<domain::Box<3>>& view) {
  domain::Coordinates<3> lower = box.lower().coordinates();
  domain::Coordinates<3> upper = box.upper().coordinates();
  for (std::size_t i = 0; i < 3; ++i) {
    const Rational margin = (upper[i] - lower[i]) / 4;
    lower[i] -= margin;
    upper[i] += margin;
    if (!view) continue;
    lower[i] = std::max(lower[i], view->lower()[i]);
    upper[i] = std::min(upper[i], view->upper()[i]);
  }
  return {lower, upper};
}

// Each cell in each of its views, the volumes of which are added up.
class NefComparison {
 public:
  NefComparison(const Model& model, const VisibleCells& visible,
                const VerifyGeometryOptions& options)
      : model_(model), visible_(visible), options_(options), instances_(model.cells.size()) {
    for (const VisibleCell& instance : visible.cells) {
      instances_[instance.cell].push_back(&instance);
    }
  }

  // Those with the fewest different instances first, so that one with many does not take the time
  // of all others; reported in the order of the model.
  std::vector<Check> run(const GeometryVolumes& volumes) {
    std::vector<Index> order(model_.cells.size());
    std::iota(order.begin(), order.end(), Index{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](Index a, Index b) { return instances_[a].size() < instances_[b].size(); });
    if (options_.progress != nullptr) {
      options_.progress->begin("Nef polyhedra", visible_.cells.size());
    }
    std::vector<Check> checks(model_.cells.size());
    for (const Index cell : order) checks[cell] = check_of(cell, volumes.cells[cell].volume);
    return checks;
  }

 private:
  Check check_of(Index cell, const std::optional<Enclosure>& volume) {
    std::string name = fmt::format("nef: cell {}", model_.cells[cell].id);
    if (!volume) return skipped("nef", std::move(name), "it is not bounded");
    if (instances_[cell].empty()) return skipped("nef", std::move(name), "it is not visible");
    Check check = compare_with_nef(std::move(name), *volume, volume_of(cell));
    if (instances_[cell].size() > 1 && check.verdict == Verdict::Passed) {
      check.explanation = fmt::format("{} different instances", instances_[cell].size());
    }
    return check;
  }

  NefVolume volume_of(Index cell) {
    Enclosure sum;
    std::size_t done = 0;
    for (const VisibleCell* instance : instances_[cell]) {
      NefVolume part = volume_of(*instance);
      if (!part.bounds) {
        if (seconds_left() <= 0) part.reason = over_the_budget();
        if (instances_[cell].size() > 1) {
          part.reason +=
              fmt::format(" (after {} of {} different instances)", done, instances_[cell].size());
        }
        return part;
      }
      sum.lower += instance->visible.instances * part.bounds->lower;
      sum.upper += instance->visible.instances * part.bounds->upper;
      ++done;
    }
    return {std::move(sum), ""};
  }

  NefVolume volume_of(const VisibleCell& instance) {
    if (options_.progress != nullptr) {
      options_.progress->advance();
      options_.progress->check();
    }
    NefLimits limits;
    limits.progress = options_.progress;
    limits.seconds = seconds_left();
    if (limits.seconds <= 0) return {std::nullopt, over_the_budget()};
    const Visible& view = visible_.views[instance.view].visible;
    return nef_volume(model_, model_.cells[instance.cell].region,
                      enlarged(*instance.visible.box, view.box), options_.nef_segments, limits,
                      view.window);
  }

  double seconds_left() const {
    return options_.nef_seconds -
           std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  std::string over_the_budget() const {
    return fmt::format("over the budget of {:g} s for all cells", options_.nef_seconds);
  }

  const Model& model_;
  const VisibleCells& visible_;
  const VerifyGeometryOptions& options_;
  std::vector<std::vector<const VisibleCell*>> instances_;  // by cell
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

Report verify_geometry(const Model& model, const VerifyGeometryOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  Report report;
  report.model = model.name;
  report.library = std::string(version);
  // What is wrong with a file is said before the long work.
  const GoldenGeometries golden =
      options.golden ? read_golden_geometries(*options.golden) : GoldenGeometries();
  VolumeLimits limits;
  limits.relative_width = options.relative_width;
  limits.progress = options.progress;
  const VisibleCells visible = visible_cells(model, options.progress);
  const GeometryVolumes volumes = measure_volumes(model, visible, limits);
  if (options.progress != nullptr) options.progress->check();
  const auto is_enabled = [&](std::string_view oracle) {
    return std::find(options.disabled.begin(), options.disabled.end(), oracle) ==
           options.disabled.end();
  };
  if (is_enabled("sampling")) hold_against_points(model, volumes, options, report);
  if (is_enabled("nef")) {
    for (Check& check : NefComparison(model, visible, options).run(volumes)) {
      report.checks.push_back(std::move(check));
    }
  }
  if (options.golden && is_enabled("golden")) {
    const std::string name = options.golden_name.empty()
                                 ? std::filesystem::path(model.name).stem().string()
                                 : options.golden_name;
    for (Check& check : check_golden(golden, name, model, volumes)) {
      report.checks.push_back(std::move(check));
    }
  }
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

}  // namespace exactcsg::verify
