// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/openmc/universes.hpp"

#include <fmt/format.h>

#include <utility>

#include "exactcsg/csg/prune.hpp"
#include "exactcsg/domain/plane.hpp"
#include "exactcsg/io/openmc/lattices.hpp"

namespace exactcsg::io::openmc {

namespace {

[[noreturn]] void throw_cycle(const Model& model, const Cell& cell, Index universe) {
  throw Error(ErrorId::CyclicFill,
              {fmt::format("cell {} is filled with universe {}, which it is itself part of",
                           cell.id, model.universes[universe].id),
               "", cell.position});
}

}  // namespace

std::vector<Index> universes_from_above(const Model& model) {
  std::vector<std::vector<Index>> below(model.universes.size());
  std::vector<std::size_t> waiting_for(model.universes.size());
  for (const Cell& cell : model.cells) {
    for (const Index universe : universes_in(model, cell)) {
      below[cell.universe].push_back(universe);
      ++waiting_for[universe];
    }
  }
  std::vector<Index> order;
  for (Index i = 0; i < waiting_for.size(); ++i) {
    if (waiting_for[i] == 0) order.push_back(i);
  }
  for (std::size_t next = 0; next < order.size(); ++next) {
    for (const Index universe : below[order[next]]) {
      if (--waiting_for[universe] == 0) order.push_back(universe);
    }
  }
  return order;
}

// Depth first, over a stack of our own: universes may be nested as deeply as a file is long.
void refuse_cycles(const Model& model) {
  enum class State : unsigned char { New, Open, Done };
  std::vector<State> states(model.universes.size(), State::New);
  std::vector<std::pair<Index, bool>> pending;  // a universe, to enter or to leave
  for (Index first = 0; first < states.size(); ++first) {
    pending.emplace_back(first, false);
    while (!pending.empty()) {
      const auto [universe, leaves] = pending.back();
      pending.pop_back();
      if (leaves) {
        states[universe] = State::Done;
        continue;
      }
      if (states[universe] != State::New) continue;
      states[universe] = State::Open;
      pending.emplace_back(universe, true);
      for (const Index index : model.universes[universe].cells) {
        const Cell& cell = model.cells[index];
        for (const Index below : universes_in(model, cell)) {
          if (states[below] == State::Open) throw_cycle(model, cell, below);
          if (states[below] == State::New) pending.emplace_back(below, false);
        }
      }
    }
  }
}

AffineMap translation(const domain::Coordinates<3>& offset) {
  AffineMap map = AffineMap::identity();
  for (std::size_t i = 0; i < 3; ++i) map.m[i][3] = offset[i];
  return map;
}

HalfSpaceRegion region_of(const domain::Solid3& solid) {
  return csg::map(solid, [](const domain::HalfSpace<3>& h) { return HalfSpace(h); });
}

HalfSpaceRegion moved(const AffineMap& map, const HalfSpaceRegion& region) {
  return csg::map(region, [&](const HalfSpace& h) { return apply(map, h); });
}

domain::Coordinates<3> place_of_element(const Lattice& lattice, domain::Coordinates<3> centre) {
  if (!lattice.has_layers) centre[2] = 0;
  return centre;
}

HalfSpaceRegion element_region(const Lattice& lattice, const domain::Coordinates<3>& centre) {
  const ElementShape shape = element_shape(lattice);
  std::vector<HalfSpaceRegion> sides;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (axis == 2 ? !lattice.has_layers : lattice.is_hexagonal()) continue;
    domain::Coordinates<3> normal;
    normal[axis] = 1;
    const Rational upper = centre[axis] + shape.half_extent[axis];
    const Rational lower = centre[axis] - shape.half_extent[axis];
    sides.push_back(HalfSpaceRegion::primitive(domain::make_plane(normal, Rational(-upper))));
    normal[axis] = -1;
    sides.push_back(HalfSpaceRegion::primitive(domain::make_plane(normal, lower)));
  }
  if (lattice.is_hexagonal()) {
    sides.push_back(moved(translation(place_of_element(lattice, centre)), shape.sides));
  }
  return csg::simplify(
      HalfSpaceRegion::compose(csg::BooleanOperator::Intersection, std::move(sides)));
}

}  // namespace exactcsg::io::openmc
