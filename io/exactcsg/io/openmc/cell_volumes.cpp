// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/openmc/cell_volumes.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace exactcsg::io::openmc {

namespace {

using measure::StopReason;
using Box = domain::Box<3>;

Enclosure times(const Integer& count, const Enclosure& value) {
  return {Rational(count * value.lower), Rational(count * value.upper)};
}

void add(VisibleVolume& sum, const VisibleVolume& term) {
  sum.instances += term.instances;
  if (sum.stop == StopReason::Width) sum.stop = term.stop;
  if (!term.volume) sum.volume.reset();
  if (!sum.volume) return;
  sum.volume->lower += term.volume->lower;
  sum.volume->upper += term.volume->upper;
}

// Void before every id.
bool is_before(const Materials& a, const Materials& b) { return a < b; }

class Volumes {
 public:
  Volumes(const Model& model, const VisibleCells& visible, const VolumeLimits& limits)
      : limits_(limits),
        instances_(visible.cells),
        instances_per_cell_(model.cells.size()),
        results_(instances_.size()) {
    for (const VisibleCell& instance : instances_)
      instances_per_cell_[instance.cell] += instance.visible.instances;
  }

  // Roughly at first, so that something is known of all when a limit is reached.
  GeometryVolumes run(const Model& model) {
    constexpr double rough = 1e-2;
    if (limits_.relative_width < rough) measure_all(rough);
    measure_all(limits_.relative_width);
    GeometryVolumes result;
    result.cells.assign(model.cells.size(), {0, Enclosure{0, 0}, StopReason::Width});
    for (std::size_t i = 0; i < instances_.size(); ++i) {
      const Integer& count = instances_[i].visible.instances;
      VisibleVolume term{count, std::nullopt, StopReason::Width};
      if (const auto& measured = results_[i]) {
        term.volume = times(count, measured->value);
        term.stop = measured->stop;
      }
      add(result.cells[instances_[i].cell], term);
    }
    add_materials(model, result);
    result.distinct_instances = instances_.size();
    result.decomposition_cells = cells_;
    return result;
  }

 private:
  static void add_materials(const Model& model, GeometryVolumes& result) {
    std::map<Materials, VisibleVolume, decltype(&is_before)> sums(&is_before);
    for (std::size_t i = 0; i < model.cells.size(); ++i) {
      if (model.cells[i].fill != FillKind::Material) continue;
      const auto entry = sums.try_emplace(model.cells[i].materials,
                                          VisibleVolume{0, Enclosure{0, 0}, StopReason::Width})
                             .first;
      add(entry->second, result.cells[i]);
    }
    for (auto& sum : sums) result.materials.push_back({sum.first, std::move(sum.second)});
  }

  void measure_all(double relative_width) {
    for (std::size_t i = 0; i < instances_.size(); ++i) {
      if (!instances_[i].visible.box) continue;
      const std::optional<StopReason> limit = limit_reached();
      if (limit && results_[i]) {
        results_[i]->stop = *limit;
        continue;
      }
      measure::CertifiedMeasure measured = measure_one(instances_[i], relative_width);
      cells_ += measured.cells;
      if (results_[i]) measured.value = common(measured.value, results_[i]->value);
      results_[i] = std::move(measured);
    }
  }

  std::optional<StopReason> limit_reached() const {
    if (limits_.progress != nullptr && limits_.progress->cancelled()) return StopReason::Cancelled;
    if (limits_.deadline && std::chrono::steady_clock::now() >= *limits_.deadline) {
      return StopReason::Deadline;
    }
    return std::nullopt;
  }

  static Enclosure common(const Enclosure& a, const Enclosure& b) {
    return {std::max(a.lower, b.lower), std::min(a.upper, b.upper)};
  }

  measure::CertifiedMeasure measure_one(const VisibleCell& instance, double relative_width) const {
    constexpr double thinnest = 1e-6;
    const Box& box = *instance.visible.box;
    measure::MeasureLimits limits;
    limits.relative_width = relative_width;
    const Rational of_one =
        rational_of(limits_.absolute_width) / instances_per_cell_[instance.cell];
    limits.absolute_width = std::max(nearest_double(of_one) * (1 - 0x1p-50),
                                     thinnest * relative_width * nearest_double(volume_of(box)));
    limits.cells = limits_.cells;
    limits.deadline = limits_.deadline;
    limits.progress = limits_.progress;
    return measure::volume(instance.visible.window, box, limits);
  }
  static Rational volume_of(const Box& box) { return measure::detail::volume_of(box); }

  const VolumeLimits& limits_;
  const std::vector<VisibleCell>& instances_;
  std::vector<Integer> instances_per_cell_;
  std::vector<std::optional<measure::CertifiedMeasure>> results_;
  std::uint64_t cells_ = 0;
};

}  // namespace

std::string text_of_materials(const Materials& materials) {
  std::string text;
  for (const std::optional<Id>& material : materials) {
    if (!text.empty()) text += ", ";
    text += material ? std::to_string(*material) : std::string("void");
  }
  return text;
}

GeometryVolumes measure_volumes(const Model& model, const VisibleCells& visible,
                                const VolumeLimits& limits) {
  return Volumes(model, visible, limits).run(model);
}

GeometryVolumes measure_volumes(const Model& model, const VolumeLimits& limits) {
  return measure_volumes(model, visible_cells(model, limits.progress), limits);
}

}  // namespace exactcsg::io::openmc
