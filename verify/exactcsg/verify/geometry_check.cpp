// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/verify/geometry_check.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <variant>

#include "exactcsg/csg/prune.hpp"
#include "exactcsg/csg/walk.hpp"
#include "exactcsg/io/openmc/region_bounds.hpp"
#include "exactcsg/measure/region_proof.hpp"

namespace exactcsg::verify {

namespace {

using namespace io::openmc;
using Clock = std::chrono::steady_clock;
using measure::Proof;

constexpr std::size_t listed_boxes = 10;
constexpr std::size_t most_combinations = 4096;

HalfSpaceRegion composed(csg::BooleanOperator operation, std::vector<HalfSpaceRegion> operands) {
  if (operands.size() == 1) return std::move(operands.front());
  return HalfSpaceRegion::compose(operation, std::move(operands));
}

class Checker {
 public:
  Checker(const Model& model, const GeometryCheckOptions& options, domain::Box<3> box)
      : model_(model),
        options_(options),
        deadline_(Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                     std::chrono::duration<double>(options.budget_seconds))),
        result_{model.name, std::move(box), {}, {}, {}, {}, {}, {}, 0} {}

  GeometryCheck run() {
    const Clock::time_point start = Clock::now();
    const VisibleUniverses visible = visible_universes(model_, result_.box, options_.progress);
    for (const View& view : visible.views) check(view);
    for (const OutsideView& outside : visible.outsides) check(outside);
    find_unused(visible);
    result_.coincident_surfaces = coincident_surfaces(model_);
    result_.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    return std::move(result_);
  }

 private:
  measure::ProofLimits limits(std::size_t witnesses) const {
    measure::ProofLimits limits;
    limits.negligible_share = options_.negligible_share;
    limits.cells = options_.cells;
    const Clock::time_point now = Clock::now();
    limits.deadline = now + std::max((deadline_ - now) / 2, Clock::duration(0));
    limits.progress = options_.progress;
    limits.witnesses = witnesses;
    return limits;
  }

  // THROWS what Progress throws, which is how proofs are interrupted.
  void look_at_progress() const {
    if (options_.progress != nullptr) options_.progress->check();
  }

  CheckedPart& part(StepKind kind, Index index, const Visible& visible) {
    const auto is_it = [&](const CheckedPart& part) {
      return part.part.kind == kind && part.part.index == index;
    };
    auto found = std::find_if(result_.parts.rbegin(), result_.parts.rend(), is_it);
    if (found == result_.parts.rend()) {
      result_.parts.push_back({{kind, index, std::nullopt}, 0, 0, 0, 0, 0});
      found = result_.parts.rbegin();
    }
    ++found->views;
    found->instances += visible.instances;
    return *found;
  }

  std::vector<HalfSpaceRegion> regions_of(Index universe) const {
    std::vector<HalfSpaceRegion> regions;
    for (const Index cell : model_.universes[universe].cells) {
      regions.push_back(half_spaces(model_, model_.cells[cell].region));
    }
    return regions;
  }

  std::vector<HalfSpaceRegion> boundary_sides(Index universe) const {
    std::set<Index> surfaces;
    for (const Index cell : model_.universes[universe].cells) {
      csg::for_each_primitive(model_.cells[cell].region, [&](const SurfaceSide& side) {
        if (model_.surfaces[side.surface].boundary != io::openmc::Boundary::Transmission) {
          surfaces.insert(side.surface);
        }
      });
    }
    std::vector<HalfSpaceRegion> sides;
    for (const Index surface : surfaces) {
      sides.push_back(HalfSpaceRegion::primitive(model_.surfaces[surface].negative));
    }
    return sides;
  }

  // The combinations of sides that are named, each as the numbers of those that are negative.
  static HalfSpaceRegion union_of(const std::vector<HalfSpaceRegion>& sides,
                                  const std::vector<measure::Witness>& combinations) {
    std::vector<HalfSpaceRegion> terms;
    for (const measure::Witness& combination : combinations) {
      std::vector<HalfSpaceRegion> factors;
      for (std::size_t i = 0; i < sides.size(); ++i) {
        const bool is_negative =
            std::binary_search(combination.regions.begin(), combination.regions.end(), i);
        factors.push_back(
            is_negative ? sides[i] : HalfSpaceRegion::primitive(complement(sides[i].primitive())));
      }
      terms.push_back(composed(csg::BooleanOperator::Intersection, std::move(factors)));
    }
    return composed(csg::BooleanOperator::Union, std::move(terms));
  }

  // Where particles are in a view: see the header.
  HalfSpaceRegion inhabited(const View& view, const std::vector<HalfSpaceRegion>& regions,
                            CheckedPart& line) {
    const std::vector<HalfSpaceRegion> sides = boundary_sides(view.universe);
    const Visible& visible = view.visible;
    if (sides.empty()) return visible.window;
    const HalfSpaceRegion cells =
        csg::intersect(composed(csg::BooleanOperator::Union, regions), visible.window);
    const Proof found = measure::find_combinations(std::span<const HalfSpaceRegion>(sides), cells,
                                                   *visible.box, limits(most_combinations));
    look_at_progress();
    if (const auto* some = std::get_if<measure::Refuted>(&found)) {
      if (!some->is_complete) add_undecided(some->rest, visible, view.universe, line);
      return csg::intersect(union_of(sides, some->witnesses), visible.window);
    }
    if (const auto* rest = std::get_if<measure::Undecided>(&found)) {
      add_undecided(*rest, visible, view.universe, line);
    }
    return HalfSpaceRegion::empty();
  }

  void check(const View& view) {
    CheckedPart& line = part(StepKind::Universe, view.universe, view.visible);
    const std::vector<HalfSpaceRegion> regions = regions_of(view.universe);
    const HalfSpaceRegion within = inhabited(view, regions, line);
    const Proof proof = measure::prove_partition(std::span<const HalfSpaceRegion>(regions), within,
                                                 *view.visible.box, limits(options_.overlaps));
    look_at_progress();
    if (const auto* refuted = std::get_if<measure::Refuted>(&proof)) {
      for (const measure::Witness& witness : refuted->witnesses) add_defect(witness, view, line);
      if (!refuted->is_complete) add_undecided(refuted->rest, view.visible, view.universe, line);
    }
    if (const auto* rest = std::get_if<measure::Undecided>(&proof)) {
      add_undecided(*rest, view.visible, view.universe, line);
    }
  }

  static Point in_root(const Visible& visible, const Point& point) {
    return domain::apply(inverse(visible.from_root), point);
  }

  void add_defect(const measure::Witness& witness, const View& view, CheckedPart& line) {
    std::vector<Index> cells;
    for (const std::size_t i : witness.regions) {
      cells.push_back(model_.universes[view.universe].cells[i]);
    }
    if (cells.empty()) {
      ++line.gaps;
    } else if (overlaps_.insert(cells).second) {
      ++line.overlaps;
    } else {
      return;  // named already, of another view
    }
    result_.defects.push_back({cells.empty() ? DefectKind::Gap : DefectKind::Overlap,
                               in_root(view.visible, witness.point), view.visible.path,
                               std::move(cells)});
  }

  // All that is visible outside of a lattice is a gap; one is named.
  void check(const OutsideView& outside) {
    CheckedPart& line = part(StepKind::Lattice, outside.lattice, outside.visible);
    if (line.gaps > 0) return;
    const Proof proof =
        measure::find_combinations(std::span<const HalfSpaceRegion>(), outside.visible.window,
                                   *outside.visible.box, limits(1));
    look_at_progress();
    if (const auto* found = std::get_if<measure::Refuted>(&proof)) {
      ++line.gaps;
      result_.defects.push_back({DefectKind::Gap,
                                 in_root(outside.visible, found->witnesses.front().point),
                                 outside.visible.path,
                                 {}});
    } else if (const auto* rest = std::get_if<measure::Undecided>(&proof)) {
      add_undecided(*rest, outside.visible, std::nullopt, line);
    }
  }

  void add_undecided(const measure::Undecided& rest, const Visible& visible,
                     std::optional<Index> universe, CheckedPart& line) {
    UndecidedPart part;
    part.path = visible.path;
    part.volume = rest.volume * visible.instances / abs(determinant(visible.from_root));
    part.box_count = rest.cells.size();
    const auto listed = std::min(listed_boxes, rest.cells.size());
    part.boxes.assign(rest.cells.begin(), rest.cells.begin() + static_cast<std::ptrdiff_t>(listed));
    if (universe) part.cells = cells_that_end_in(part.boxes, *universe);
    line.undecided_volume += part.volume;
    result_.undecided.push_back(std::move(part));
  }

  std::vector<Index> cells_that_end_in(const std::vector<domain::Box<3>>& boxes,
                                       Index universe) const {
    std::vector<Index> cells;
    for (const Index cell : model_.universes[universe].cells) {
      const HalfSpaceRegion region = half_spaces(model_, model_.cells[cell].region);
      if (std::any_of(boxes.begin(), boxes.end(), [&](const domain::Box<3>& box) {
            const HalfSpaceRegion local = csg::prune(
                region,
                [&](const io::openmc::HalfSpace& half_space) { return classify(half_space, box); });
            return !local.is_empty() && !local.is_full();
          })) {
        cells.push_back(cell);
      }
    }
    return cells;
  }

  bool holds_nothing(std::size_t universe) const {
    const std::vector<Index>& cells = model_.universes[universe].cells;
    return std::all_of(cells.begin(), cells.end(),
                       [&](Index cell) { return model_.cells[cell].region.is_empty(); });
  }

  void find_unused(const VisibleUniverses& visible) {
    std::vector<bool> is_used(model_.surfaces.size(), false);
    for (const Cell& cell : model_.cells) {
      csg::for_each_primitive(cell.region,
                              [&](const SurfaceSide& side) { is_used[side.surface] = true; });
    }
    std::vector<bool> is_seen(model_.universes.size(), false);
    for (const View& view : visible.views) is_seen[view.universe] = true;
    // Elements that do not exist are not missed.
    for (std::size_t i = 0; i < is_seen.size(); ++i) is_seen[i] = is_seen[i] || holds_nothing(i);
    const auto missing = [](const std::vector<bool>& there) {
      std::vector<Index> result;
      for (std::size_t i = 0; i < there.size(); ++i) {
        if (!there[i]) result.push_back(static_cast<Index>(i));
      }
      return result;
    };
    result_.unused_surfaces = missing(is_used);
    result_.unseen_universes = missing(is_seen);
  }

  const Model& model_;
  const GeometryCheckOptions& options_;
  Clock::time_point deadline_;
  std::set<std::vector<Index>> overlaps_;
  GeometryCheck result_;
};

}  // namespace

Rational GeometryCheck::undecided_volume() const {
  Rational sum;
  for (const UndecidedPart& part : undecided) sum += part.volume;
  return sum;
}

bool GeometryCheck::is_clean(const Rational& tolerance) const {
  return defects.empty() && undecided_volume() <= tolerance;
}

GeometryCheck check_geometry(const Model& model, const GeometryCheckOptions& options) {
  return Checker(model, options, options.box ? *options.box : box_of_root(model)).run();
}

std::vector<CoincidentSurfaces> coincident_surfaces(const Model& model) {
  measure::SurfaceTable<io::openmc::HalfSpace> table;
  std::map<std::uint32_t, CoincidentSurfaces> found;
  for (std::size_t i = 0; i < model.surfaces.size(); ++i) {
    const measure::Literal literal = table.add(model.surfaces[i].negative);
    CoincidentSurfaces& group = found[literal.surface];
    group.surfaces.push_back(static_cast<Index>(i));
    group.is_reversed.push_back(literal.is_complemented);
  }
  std::vector<CoincidentSurfaces> result;
  for (auto& [surface, group] : found) {
    if (group.surfaces.size() > 1) result.push_back(std::move(group));
  }
  return result;
}

}  // namespace exactcsg::verify
