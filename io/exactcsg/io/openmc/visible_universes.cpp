// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/openmc/visible_universes.hpp"

#include <algorithm>
#include <map>
#include <unordered_map>
#include <utility>

#include "exactcsg/csg/prune.hpp"
#include "exactcsg/csg/text.hpp"
#include "exactcsg/domain/bounded_primitives.hpp"
#include "exactcsg/io/openmc/lattices.hpp"
#include "exactcsg/io/openmc/region_bounds.hpp"
#include "exactcsg/io/openmc/universes.hpp"
#include "exactcsg/measure/bounding_box.hpp"
#include "exactcsg/measure/surface_table.hpp"

namespace exactcsg::io::openmc {

namespace {

using Box = domain::Box<3>;
using Coordinates = domain::Coordinates<3>;

constexpr std::size_t most_views = 2'000'000;

HalfSpaceRegion pruned(const HalfSpaceRegion& region, const Box& box) {
  return csg::prune(region, [&](const HalfSpace& half_space) { return classify(half_space, box); });
}

// The images of boxes are boxes.
bool keeps_axes(const AffineMap& map) {
  return std::all_of(map.m.begin(), map.m.end(), [](const auto& row) {
    return std::count(row.begin(), row.begin() + 3, Rational(0)) == 2;
  });
}

Box box_of_image(const AffineMap& map, const Box& box) {
  Coordinates lower;
  Coordinates upper;
  for (std::size_t i = 0; i < 3; ++i) {
    lower[i] = upper[i] = map.m[i][3];
    for (std::size_t j = 0; j < 3; ++j) {
      const Rational first = map.m[i][j] * box.lower()[j];
      const Rational second = map.m[i][j] * box.upper()[j];
      lower[i] += std::min(first, second);
      upper[i] += std::max(first, second);
    }
  }
  return {lower, upper};
}

Visible mapped(const AffineMap& map, Visible visible) {
  visible.from_root = map * visible.from_root;
  if (!visible.box) {
    visible.window = moved(map, visible.window);
    return visible;
  }
  // What the window is outside the box is not known.
  if (!keeps_axes(map))
    visible.window = csg::intersect(visible.window, region_of(domain::make_block(*visible.box)));
  visible.box = box_of_image(map, *visible.box);
  visible.window = pruned(moved(map, visible.window), *visible.box);
  return visible;
}

// Whether a range of a lattice's grid consists of its elements, or of none of them.
enum class Placement : unsigned char { Elements, Outside, Both };
Placement placement_of(const Lattice& lattice, const ElementRange& range) {
  bool is_outside = false;
  bool is_inside = true;
  // Of all numbers from low to high which are from least to greatest?
  const auto compare = [&](std::int64_t low, std::int64_t high, std::int64_t least,
                           std::int64_t greatest) {
    is_outside = is_outside || high < least || low > greatest;
    is_inside = is_inside && low >= least && high <= greatest;
  };
  const auto& [first, last] = range;
  if (lattice.is_hexagonal()) {
    const std::int64_t reach = lattice.rings - 1;
    for (std::size_t i = 0; i < 2; ++i) compare(first[i], last[i] - 1, -reach, reach);
    compare(first[0] + first[1], last[0] + last[1] - 2, -reach, reach);
  } else {
    for (std::size_t i = 0; i < 2; ++i) compare(first[i], last[i] - 1, 0, lattice.counts[i] - 1);
  }
  compare(first[2], last[2] - 1, 0, lattice.layers - 1);
  if (is_outside) return Placement::Outside;
  return is_inside ? Placement::Elements : Placement::Both;
}

Integer size_of(const ElementRange& range) {
  Integer size = 1;
  for (std::size_t i = 0; i < 3; ++i) size *= static_cast<long>(range.last[i] - range.first[i]);
  return size;
}

// Halves across the longest row. REQUIRES more than one element.
std::pair<ElementRange, ElementRange> halves(const ElementRange& range) {
  std::size_t axis = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (range.last[i] - range.first[i] > range.last[axis] - range.first[axis]) axis = i;
  }
  std::pair<ElementRange, ElementRange> result{range, range};
  result.first.last[axis] = result.second.first[axis] =
      range.first[axis] + (range.last[axis] - range.first[axis]) / 2;
  return result;
}

class Explorer {
 public:
  Explorer(const Model& model, Progress* progress) : model_(model), progress_(progress) {
    views_.resize(model.universes.size());
    known_.resize(model.universes.size());
  }

  VisibleUniverses run(const std::optional<Box>& box) {
    const std::vector<Index> order = universes_from_root();
    add(model_.root, {box, HalfSpaceRegion::full(), AffineMap::identity(), {}, 1, false});
    VisibleUniverses result;
    for (const Index universe : order) {
      for (View& view : views_[universe]) {
        if (progress_ != nullptr) progress_->check();
        explore(view);
        result.views.push_back(std::move(view));
      }
    }
    result.outsides = std::move(outsides_);
    return result;
  }

 private:
  // Those that are used, each before what fills its cells: the order in which a search of the depth
  // leaves them, reversed.
  std::vector<Index> universes_from_root() const {
    std::vector<Index> order;
    std::vector<bool> is_seen(model_.universes.size(), false);
    std::vector<std::pair<Index, bool>> pending{{model_.root, false}};
    while (!pending.empty()) {
      const auto [universe, leaves] = pending.back();
      pending.pop_back();
      if (leaves) order.push_back(universe);
      if (leaves || is_seen[universe]) continue;
      is_seen[universe] = true;
      pending.emplace_back(universe, true);
      for (const Index cell : model_.universes[universe].cells) {
        for (const Index below : universes_in(model_, model_.cells[cell])) {
          if (!is_seen[below]) pending.emplace_back(below, false);
        }
      }
    }
    std::reverse(order.begin(), order.end());
    return order;
  }

  std::string key_of(const Visible& visible) {
    std::string key = visible.is_everywhere ? "everywhere " : "";
    for (std::size_t i = 0; visible.box && i < 3; ++i) {
      key += to_text(visible.box->lower()[i]) + ' ' + to_text(visible.box->upper()[i]) + ' ';
    }
    return key + csg::to_text(surfaces_.add(visible.window), [](const measure::Literal& literal) {
             return (literal.is_complemented ? "c" : "s") + std::to_string(literal.surface);
           });
  }

  void add(Index universe, Visible visible) {
    visible.path.push_back({StepKind::Universe, universe, std::nullopt});
    const auto [entry, is_new] =
        known_[universe].try_emplace(key_of(visible), views_[universe].size());
    if (!is_new) {
      views_[universe][entry->second].visible.instances += visible.instances;
      return;
    }
    if (++count_ > most_views) {
      throw Error(ErrorId::TooLarge, {"more than 2000000 places at which universes differ", ""});
    }
    views_[universe].push_back({universe, std::move(visible)});
  }

  void explore(const View& view) {
    for (const Index index : model_.universes[view.universe].cells) {
      const Cell& cell = model_.cells[index];
      if (cell.fill == FillKind::Material) continue;
      std::optional<Visible> part = part_in(model_, view.visible, cell);
      if (!part) continue;
      part->path.push_back({StepKind::Cell, index, std::nullopt});
      if (cell.to_fill) part = mapped(*cell.to_fill, std::move(*part));
      if (cell.fill == FillKind::Universe) {
        add(cell.filled_with, std::move(*part));
      } else if (part->is_everywhere) {
        for (const Index universe : universes_in(model_, cell)) add(universe, *part);
      } else if (part->box) {
        explore_lattice(cell.filled_with, *part);
      } else {
        explore_lattice_without_end(cell.filled_with, *part);
      }
    }
  }

  // The box round the elements of a range, in the lattice's coordinates; along z, without layers,
  // that of `visible`. REQUIRES a box, or layers
  static Box box_of(const Lattice& lattice, const Coordinates& half_extent,
                    const ElementRange& range, const std::optional<Box>& visible) {
    Coordinates lower = visible ? visible->lower().coordinates() : Coordinates();
    Coordinates upper = visible ? visible->upper().coordinates() : Coordinates();
    for (unsigned corner = 0; corner < 8; ++corner) {
      std::array<std::int64_t, 3> element{};
      for (std::size_t i = 0; i < 3; ++i) {
        element[i] = (corner >> i & 1U) != 0 ? range.last[i] - 1 : range.first[i];
      }
      const Coordinates centre = centre_of(lattice, element);
      for (std::size_t i = 0; i < (lattice.has_layers ? 3U : 2U); ++i) {
        const Rational low = centre[i] - half_extent[i];
        const Rational high = centre[i] + half_extent[i];
        if (corner == 0 || low < lower[i]) lower[i] = low;
        if (corner == 0 || high > upper[i]) upper[i] = high;
      }
    }
    return {lower, upper};
  }

  static std::optional<Box> common(const Box& a, const Box& b) {
    std::array<Extent, 3> bounds;
    for (std::size_t i = 0; i < 3; ++i) bounds[i] = {b.lower()[i], b.upper()[i]};
    return cut(a, bounds);
  }

  // Ranges of the grid that nothing cuts are put down as a whole, others are halved.
  void explore_lattice(Index index, const Visible& visible) {
    const Lattice& lattice = model_.lattices[index];
    const ElementShape shape = element_shape(lattice);
    std::vector<ElementRange> pending{elements_near(lattice, *visible.box)};
    while (!pending.empty()) {
      if (progress_ != nullptr) progress_->check();
      const ElementRange range = pending.back();
      pending.pop_back();
      const Box whole = box_of(lattice, shape.half_extent, range, visible.box);
      const std::optional<Box> box = common(whole, *visible.box);
      if (!box) continue;
      Visible part{
          box,  pruned(visible.window, *box), visible.from_root, visible.path, visible.instances,
          false};
      if (part.window.is_empty()) continue;
      const bool is_uncut = part.window.is_full() && *box == whole;
      const Placement placement = placement_of(lattice, range);
      if (size_of(range) == 1 || (is_uncut && placement != Placement::Both)) {
        put(index, shape, range, placement, std::move(part));
      } else {
        const auto parts = halves(range);
        pending.push_back(parts.second);
        pending.push_back(parts.first);
      }
    }
  }

  // Element by element. Of the outer universe nothing is known.
  void explore_lattice_without_end(Index index, const Visible& visible) {
    const Lattice& lattice = model_.lattices[index];
    const ElementShape shape = element_shape(lattice);
    for_each_element(
        lattice, std::nullopt,
        [&](const std::array<std::int64_t, 3>& element, Index universe, const Coordinates& centre) {
          if (progress_ != nullptr) progress_->check();
          Visible part = visible;
          if (lattice.has_layers) {
            part.box = box_of(lattice, shape.half_extent, {element, next(element)}, std::nullopt);
            part.window = pruned(part.window, *part.box);
            part = element_of(index, shape, element, part);
          } else {
            part.window = csg::intersect(std::move(part.window), element_region(lattice, centre));
            part = in_element(index, element, part);
          }
          if (!part.window.is_empty()) add(universe, std::move(part));
        });
    if (!lattice.outer) return;
    Visible outer = visible;
    outer.window = HalfSpaceRegion::full();
    outer.is_everywhere = true;
    outer.path.push_back({StepKind::Lattice, index, std::nullopt});
    add(*lattice.outer, std::move(outer));
  }

  // REQUIRES one element, or several that are not cut.
  void put(Index index, const ElementShape& shape, const ElementRange& range, Placement placement,
           Visible part) {
    const Lattice& lattice = model_.lattices[index];
    // The first element with each universe, and how many there are.
    std::map<Index, std::pair<std::array<std::int64_t, 3>, Integer>> elements;
    if (placement == Placement::Elements) {
      std::array<std::int64_t, 3> at = range.first;
      for (at[2] = range.first[2]; at[2] < range.last[2]; ++at[2]) {
        for (at[1] = range.first[1]; at[1] < range.last[1]; ++at[1]) {
          for (at[0] = range.first[0]; at[0] < range.last[0]; ++at[0]) {
            const Index universe = lattice.elements[element_index(lattice, at)];
            ++elements.try_emplace(universe, at, 0).first->second.second;
          }
        }
      }
    } else if (lattice.outer) {
      elements.try_emplace(*lattice.outer, range.first, size_of(range));
    } else {
      // Of several outer elements, none of which is cut, one shows the gap.
      put_outside(index, shape, {range.first, next(range.first)}, std::move(part));
      return;
    }
    for (const auto& [universe, places] : elements) {
      Visible element = element_of(index, shape, places.first, part);
      element.instances *= places.second;
      if (!element.window.is_empty()) add(universe, std::move(element));
    }
  }

  static std::array<std::int64_t, 3> next(std::array<std::int64_t, 3> element) {
    for (std::int64_t& i : element) ++i;
    return element;
  }

  // The part that is in an element, in its coordinates. REQUIRES a box
  Visible element_of(Index index, const ElementShape& shape,
                     const std::array<std::int64_t, 3>& element, const Visible& part) const {
    const ElementRange range{element, next(element)};
    Visible result = part;
    result.box =
        common(box_of(model_.lattices[index], shape.half_extent, range, part.box), *part.box);
    result = in_element(index, element, std::move(result));
    result.window = pruned(csg::intersect(std::move(result.window), shape.sides), *result.box);
    return result;
  }

  // The same points, in the coordinates of an element.
  Visible in_element(Index index, const std::array<std::int64_t, 3>& element,
                     Visible visible) const {
    const Lattice& lattice = model_.lattices[index];
    const Coordinates centre = place_of_element(lattice, centre_of(lattice, element));
    visible = mapped(inverse(translation(centre)), std::move(visible));
    visible.path.push_back({StepKind::Lattice, index, element});
    if (!is_element_of(lattice, element)) visible.path.back().element.reset();
    return visible;
  }

  void put_outside(Index index, const ElementShape& shape, const ElementRange& range,
                   Visible part) {
    Visible outside = element_of(index, shape, range.first, part);
    if (!outside.window.is_empty()) outsides_.push_back({index, std::move(outside)});
  }

  const Model& model_;
  Progress* progress_;
  std::size_t count_ = 0;
  std::vector<std::vector<View>> views_;  // by universe
  std::vector<std::unordered_map<std::string, std::size_t>> known_;
  measure::SurfaceTable<HalfSpace> surfaces_;
  std::vector<OutsideView> outsides_;
};

}  // namespace

VisibleUniverses visible_universes(const Model& model, const std::optional<Box>& box,
                                   Progress* progress) {
  if (progress != nullptr) progress->begin("universes", 0);
  return Explorer(model, progress).run(box);
}

std::optional<Visible> part_in(const Model& model, const Visible& visible, const Cell& cell) {
  if (visible.is_everywhere) return visible;
  Visible part = visible;
  part.window = csg::simplify(csg::intersect(visible.window, half_spaces(model, cell.region)));
  if (visible.box) {
    part.box = cut(*visible.box, bounds_of(model, cell.region));
    if (part.box) part.box = measure::tightened(part.window, *part.box);
    if (!part.box) return std::nullopt;
  } else {
    measure::Extent extent = measure::bounding_box(part.window);
    if (extent.kind == measure::ExtentKind::Empty) return std::nullopt;
    part.box = std::move(extent.box);
  }
  if (part.box) part.window = pruned(part.window, *part.box);
  if (part.window.is_empty()) return std::nullopt;
  return part;
}

VisibleCells visible_cells(const Model& model, Progress* progress) {
  VisibleCells result{visible_universes(model, std::nullopt, progress).views, {}};
  for (std::size_t i = 0; i < result.views.size(); ++i) {
    const View& view = result.views[i];
    for (const Index cell : model.universes[view.universe].cells) {
      if (progress != nullptr) {
        progress->advance();
        progress->check();
      }
      std::optional<Visible> part = part_in(model, view.visible, model.cells[cell]);
      if (part) result.cells.push_back({cell, i, std::move(*part)});
    }
  }
  return result;
}

}  // namespace exactcsg::io::openmc
