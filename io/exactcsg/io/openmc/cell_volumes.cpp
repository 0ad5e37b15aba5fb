// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/openmc/cell_volumes.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "exactcsg/csg/text.hpp"
#include "exactcsg/io/openmc/lattices.hpp"
#include "exactcsg/io/openmc/universes.hpp"
#include "exactcsg/measure/bounding_box.hpp"

namespace exactcsg::io::openmc {

namespace {

using measure::StopReason;
using Box = domain::Box<3>;

// Where something is visible: in the region, and in the box if there is one.
struct Clip {
  HalfSpaceRegion region = HalfSpaceRegion::full();
  std::optional<Box> box;
  // In infinitely many places, of which nothing else is known: the outer universe of a lattice in a
  // cell that is not bounded.
  bool is_everywhere = false;
};

// A cell as seen from its universe, as often as it is there.
struct Instance {
  Index cell;
  Clip clip;
  Integer count;
};

Box bounding_box_of_image(const AffineMap& map, const Box& box) {
  std::optional<domain::Coordinates<3>> lower;
  domain::Coordinates<3> upper;
  for (unsigned corner = 0; corner < 8; ++corner) {
    domain::Coordinates<3> x;
    for (std::size_t i = 0; i < 3; ++i)
      x[i] = ((corner >> i & 1U) != 0 ? box.upper() : box.lower())[i];
    const Point image = domain::apply(map, Point(x));
    if (!lower) {
      lower = image.coordinates();
      upper = image.coordinates();
    }
    for (std::size_t i = 0; i < 3; ++i) {
      (*lower)[i] = std::min((*lower)[i], image[i]);
      upper[i] = std::max(upper[i], image[i]);
    }
  }
  return {*lower, upper};
}

// What box and element have in common but for the sides of a hexagon; along z as the box if the
// lattice has no layers. nullopt: nothing but boundaries. REQUIRES a box, or layers.
std::optional<Box> common_box(const std::optional<Box>& box, const Lattice& lattice,
                              const ElementShape& shape, const domain::Coordinates<3>& centre) {
  domain::Coordinates<3> lower;
  domain::Coordinates<3> upper;
  for (std::size_t i = 0; i < 3; ++i) {
    if (i == 2 && !lattice.has_layers) {
      lower[i] = box->lower()[i];
      upper[i] = box->upper()[i];
      continue;
    }
    lower[i] = centre[i] - shape.half_extent[i];
    upper[i] = centre[i] + shape.half_extent[i];
    if (!box) continue;
    lower[i] = std::max(lower[i], box->lower()[i]);
    upper[i] = std::min(upper[i], box->upper()[i]);
    if (lower[i] >= upper[i]) return std::nullopt;
  }
  return Box(lower, upper);
}

// Follows universes downwards from the root, each after all that contain it.
class InstanceCollector {
 public:
  InstanceCollector(const Model& model, Progress* progress)
      : model_(model), progress_(progress), places_(model.universes.size()) {}

  std::vector<Instance> run() {
    places_[model_.root].emplace(std::string(), Place{Clip(), 1});
    for (const Index universe : universes_from_above(model_)) {
      for (const auto& named : places_[universe]) place_cells(universe, named.second);
      places_[universe].clear();
    }
    return std::move(instances_);
  }

 private:
  struct Place {
    Clip clip;
    Integer count;
  };

  void place_cells(Index universe, const Place& place) {
    for (const Index index : model_.universes[universe].cells) {
      if (progress_ != nullptr) {
        progress_->advance();
        progress_->check();
      }
      const Cell& cell = model_.cells[index];
      const std::optional<Clip> visible = clipped(place.clip, half_spaces(model_, cell.region));
      if (!visible) continue;
      instances_.push_back({index, *visible, place.count});
      if (cell.fill != FillKind::Material) place_fill(cell, *visible, place.count);
    }
  }

  // nullopt if nothing is left. The box is as tight as may be, and the region pruned to it.
  static std::optional<Clip> clipped(const Clip& clip, const HalfSpaceRegion& region) {
    if (clip.is_everywhere) return clip;
    HalfSpaceRegion common = csg::simplify(csg::intersect(clip.region, region));
    std::optional<Box> box = clip.box;
    if (box) {
      box = measure::tightened(common, *box);
      if (!box) return std::nullopt;
    } else {
      measure::Extent extent = measure::bounding_box(common);
      if (extent.kind == measure::ExtentKind::Empty) return std::nullopt;
      box = std::move(extent.box);
    }
    if (box) common = pruned(common, *box);
    return Clip{std::move(common), std::move(box), false};
  }
  static HalfSpaceRegion pruned(const HalfSpaceRegion& region, const Box& box) {
    return csg::prune(region, [&](const HalfSpace& h) { return classify(h, box); });
  }

  void place_fill(const Cell& cell, const Clip& visible, const Integer& count) {
    if (visible.is_everywhere) {
      for (const Index universe : universes_in(model_, cell)) put_down(universe, visible, count);
      return;
    }
    const Clip clip = cell.to_fill ? image(*cell.to_fill, visible) : visible;
    if (cell.fill == FillKind::Universe) return put_down(cell.filled_with, clip, count);
    place_elements(model_.lattices[cell.filled_with], clip, count);
  }

  static Clip image(const AffineMap& map, const Clip& clip) {
    Clip result{moved(map, clip.region), std::nullopt, false};
    if (!clip.box) return result;
    result.box = bounding_box_of_image(map, *clip.box);
    AffineMap linear = map;
    for (std::size_t i = 0; i < 3; ++i) linear.m[i][3] = 0;
    if (linear == AffineMap::identity()) return result;
    // What the region is outside the box is not known any more.
    result.region =
        csg::intersect(moved(map, region_of(domain::make_block(*clip.box))), result.region);
    return result;
  }

  void place_elements(const Lattice& lattice, const Clip& clip, const Integer& count) {
    const ElementShape shape = element_shape(lattice);
    const bool has_box = clip.box || lattice.has_layers;
    for_each_element(
        lattice, clip.box,
        [&](const std::array<std::int64_t, 3>&, Index universe,
            const domain::Coordinates<3>& centre) {
          Clip element;
          HalfSpaceRegion region = clip.region;
          const AffineMap to_element = inverse(translation(place_of_element(lattice, centre)));
          if (has_box) {
            const std::optional<Box> box = common_box(clip.box, lattice, shape, centre);
            if (!box) return;
            region = pruned(region, *box);
            if (region.is_empty()) return;
            element.box = bounding_box_of_image(to_element, *box);
          } else {
            region = csg::intersect(std::move(region), element_region(lattice, centre));
          }
          element.region = csg::simplify(csg::intersect(shape.sides, moved(to_element, region)));
          put_down(universe, element, count);
        });
    if (!clip.box && lattice.outer) {
      put_down(*lattice.outer, {HalfSpaceRegion::full(), std::nullopt, true}, count);
    }
  }

  void put_down(Index universe, const Clip& clip, const Integer& count) {
    auto [entry, is_new] = places_[universe].try_emplace(key_of(clip), Place{clip, count});
    if (!is_new) entry->second.count += count;
  }

  // Equal only for equal clips.
  std::string key_of(const Clip& clip) {
    std::string key = csg::to_text(clip.region, [&](const HalfSpace& h) {
      const measure::Literal literal = surfaces_.add(h);
      return (literal.is_complemented ? "-" : "") + std::to_string(literal.surface);
    });
    if (clip.is_everywhere) key += " everywhere";
    if (clip.box) {
      for (const Point* corner : {&clip.box->lower(), &clip.box->upper()}) {
        for (const Rational& x : corner->coordinates()) key += ' ' + to_text(x);
      }
    }
    return key;
  }

  const Model& model_;
  Progress* progress_;
  std::vector<std::map<std::string, Place>> places_;  // by universe
  std::vector<Instance> instances_;
  measure::SurfaceTable<HalfSpace> surfaces_;
};

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
  Volumes(const Model& model, const VolumeLimits& limits)
      : limits_(limits), instances_per_cell_(model.cells.size()) {
    if (limits_.progress != nullptr) limits_.progress->begin("find instances", 0);
    instances_ = InstanceCollector(model, limits_.progress).run();
    for (const Instance& instance : instances_)
      instances_per_cell_[instance.cell] += instance.count;
    results_.resize(instances_.size());
  }

  // Roughly at first, so that something is known of all when a limit is reached.
  GeometryVolumes run(const Model& model) {
    constexpr double rough = 1e-2;
    if (limits_.relative_width < rough) measure_all(rough);
    measure_all(limits_.relative_width);
    GeometryVolumes result;
    result.cells.assign(model.cells.size(), {0, Enclosure{0, 0}, StopReason::Width});
    for (std::size_t i = 0; i < instances_.size(); ++i) {
      VisibleVolume term{instances_[i].count, std::nullopt, StopReason::Width};
      if (const auto& measured = results_[i]) {
        term.volume = times(instances_[i].count, measured->value);
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
      if (!instances_[i].clip.box) continue;
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

  measure::CertifiedMeasure measure_one(const Instance& instance, double relative_width) const {
    constexpr double thinnest = 1e-6;
    const Clip& clip = instance.clip;
    measure::MeasureLimits limits;
    limits.relative_width = relative_width;
    const Rational of_one =
        rational_of(limits_.absolute_width) / instances_per_cell_[instance.cell];
    limits.absolute_width =
        std::max(nearest_double(of_one) * (1 - 0x1p-50),
                 thinnest * relative_width * nearest_double(volume_of(*clip.box)));
    limits.cells = limits_.cells;
    limits.deadline = limits_.deadline;
    limits.progress = limits_.progress;
    return measure::volume(clip.region, *clip.box, limits);
  }
  static Rational volume_of(const Box& box) { return measure::detail::volume_of(box); }

  const VolumeLimits& limits_;
  std::vector<Instance> instances_;
  std::vector<Integer> instances_per_cell_;
  std::vector<std::optional<measure::CertifiedMeasure>> results_;
  std::uint64_t cells_ = 0;
};

}  // namespace

GeometryVolumes measure_volumes(const Model& model, const VolumeLimits& limits) {
  return Volumes(model, limits).run(model);
}

}  // namespace exactcsg::io::openmc
