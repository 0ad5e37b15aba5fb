// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/openmc/visible_set.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "exactcsg/csg/prune.hpp"
#include "exactcsg/io/openmc/lattices.hpp"
#include "exactcsg/io/openmc/universes.hpp"
#include "exactcsg/io/planar/substitute.hpp"
#include "exactcsg/measure/bounding_box.hpp"

namespace exactcsg::io::openmc {

namespace {

constexpr std::uint64_t most_half_spaces = 10'000'000;

class VisibleSet {
 public:
  VisibleSet(const Model& model, const std::function<bool(const Cell&)>& is_chosen)
      : model_(model), is_chosen_(is_chosen), sets_(model.universes.size()) {}

  HalfSpaceRegion run() {
    std::vector<Index> order = universes_from_above(model_);
    std::reverse(order.begin(), order.end());
    for (const Index universe : order) sets_[universe] = set_of(universe);
    return csg::simplify(sets_[model_.root]);
  }

 private:
  HalfSpaceRegion set_of(Index universe) const {
    std::vector<HalfSpaceRegion> parts;
    for (const Index index : model_.universes[universe].cells) {
      const Cell& cell = model_.cells[index];
      const HalfSpaceRegion region = half_spaces(model_, cell.region);
      if (is_chosen_(cell)) {
        parts.push_back(region);
      } else if (cell.fill != FillKind::Material) {
        HalfSpaceRegion fill = set_of_fill(cell, region);
        if (!fill.is_empty()) parts.push_back(csg::intersect(region, std::move(fill)));
      }
    }
    HalfSpaceRegion result = unite_all(std::move(parts));
    if (result.primitive_count() > most_half_spaces) {
      throw Error(ErrorId::TooLarge, {"a geometry of more half-spaces in all instances",
                                      fmt::format("at most {}", most_half_spaces)});
    }
    return result;
  }

  // In the coordinates of the cell's universe.
  HalfSpaceRegion set_of_fill(const Cell& cell, const HalfSpaceRegion& region) const {
    HalfSpaceRegion set = cell.fill == FillKind::Universe
                              ? sets_[cell.filled_with]
                              : set_of_lattice(model_.lattices[cell.filled_with], cell, region);
    return cell.to_fill ? moved(inverse(*cell.to_fill), set) : set;
  }

  HalfSpaceRegion set_of_lattice(const Lattice& lattice, const Cell& cell,
                                 const HalfSpaceRegion& region) const {
    std::optional<domain::Box<3>> box;
    if (lattice.outer && !sets_[*lattice.outer].is_empty()) {
      const HalfSpaceRegion here = cell.to_fill ? moved(*cell.to_fill, region) : region;
      box = measure::bounding_box(here).box;
      if (!box) {
        throw Error(ErrorId::UnboundedSolid,
                    {fmt::format("the outer universe of lattice {} in cell {}, which has no end",
                                 lattice.id, cell.id),
                     "a cell that is bounded by itself", cell.position});
      }
    }
    std::vector<HalfSpaceRegion> parts;
    for_each_element(lattice, box,
                     [&](const std::array<std::int64_t, 3>&, Index universe,
                         const domain::Coordinates<3>& centre) {
                       if (sets_[universe].is_empty()) return;
                       parts.push_back(csg::intersect(
                           element_region(lattice, centre),
                           moved(translation(place_of_element(lattice, centre)), sets_[universe])));
                     });
    return unite_all(std::move(parts));
  }

  const Model& model_;
  const std::function<bool(const Cell&)>& is_chosen_;
  std::vector<HalfSpaceRegion> sets_;  // by universe
};

}  // namespace

HalfSpaceRegion visible_set(const Model& model, const std::function<bool(const Cell&)>& is_chosen) {
  return VisibleSet(model, is_chosen).run();
}

HalfSpaceRegion material_set(const Model& model) {
  return visible_set(model, [](const Cell& cell) {
    return cell.fill == FillKind::Material &&
           std::any_of(cell.materials.begin(), cell.materials.end(),
                       [](const std::optional<Id>& material) { return material.has_value(); });
  });
}

HalfSpaceRegion cell_set(const Model& model, Id cell) {
  const bool is_there = std::any_of(model.cells.begin(), model.cells.end(),
                                    [&](const Cell& c) { return c.id == cell; });
  if (!is_there) {
    throw Error(ErrorId::UndefinedId, {fmt::format("cell {} of {}", cell, model.name), ""});
  }
  return visible_set(model, [&](const Cell& c) { return c.id == cell; });
}

}  // namespace exactcsg::io::openmc
