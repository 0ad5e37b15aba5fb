// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/mcnp/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <unordered_map>
#include <utility>

#include "exactcsg/csg/walk.hpp"
#include "exactcsg/io/mcnp/cells.hpp"
#include "exactcsg/io/mcnp/data_cards.hpp"
#include "exactcsg/io/mcnp/lattices.hpp"
#include "exactcsg/io/mcnp/surfaces.hpp"
#include "exactcsg/io/openmc/surfaces.hpp"
#include "exactcsg/io/openmc/universes.hpp"
#include "exactcsg/io/planar/substitute.hpp"

namespace exactcsg::io::mcnp {

namespace {

using csg::BooleanOperator;
using openmc::FillKind;
using openmc::Id;
using openmc::Index;
using openmc::Region;
using openmc::SurfaceSide;

constexpr std::uint64_t most_operands = 10'000'000;  // of one cell, what # stands for included
constexpr Id least_named_by_cell = 1000;             // surface 1000 j + n is surface n of cell j

// Of a whole body's inside, which is a side or an intersection of sides, the outside.
Region outside_of(const Region& inside) {
  const auto turned = [](const Region& side) {
    return Region::primitive({side.primitive().surface, !side.primitive().is_positive});
  };
  if (inside.is_primitive()) return turned(inside);
  std::vector<Region> sides;
  for (const Region& side : inside.children()) sides.push_back(turned(side));
  return Region::compose(BooleanOperator::Union, std::move(sides));
}

// A surface card's body where it is, with the surfaces of the model that it has become.
struct PlacedBody {
  Body body;
  std::size_t card = 0;  // among the surface cards
  Id id = 0;
  std::string name;  // what users call it
  std::vector<std::optional<Index>> entered;
};

class SurfaceTable {
 public:
  SurfaceTable(const std::vector<Card>& cards, const TransformationTable& transformations,
               openmc::Model& model)
      : cards_(cards), model_(model) {
    for (const Card& card : cards) add(card, transformations);
    for (std::size_t i = 0; i < cards.size(); ++i) check_partner(i);
  }

  std::optional<std::size_t> find(Id number) const {
    const auto found = indices_.find(number);
    return found == indices_.end() ? std::nullopt : std::optional<std::size_t>(found->second);
  }
  PlacedBody& plain(std::size_t card) { return plain_[card]; }

  // The body of a cell that is itself put somewhere else.
  PlacedBody& of_cell(std::size_t card, const CellCard& cell, std::size_t at) {
    const auto [entry, is_new] = of_cells_.try_emplace({cell.number, card});
    if (!is_new) return entry->second;
    const Id number = surfaces_[card].number;
    std::optional<Body> body = moved(cell.placement->to_main, plain_[card].body);
    if (!body) {
      cell.geometry_card->fail(ErrorId::UnsupportedNode,
                               "a torus whose axis would be along none of x, y and z",
                               "a transformation that keeps it along one", at);
    }
    entry->second = {
        std::move(*body), card, number, fmt::format("{} of cell {}", number, cell.number), {}};
    constexpr std::int64_t greatest = 99'999'999;
    const std::int64_t named = std::int64_t{least_named_by_cell} * cell.number + number;
    if (number < least_named_by_cell && named <= greatest && !find(static_cast<Id>(named))) {
      entry->second.id = static_cast<Id>(named);
      entry->second.name = std::to_string(named);
    }
    entry->second.entered.resize(entry->second.body.shapes.size());
    return entry->second;
  }

  // What "-n.m" or "-n" says. THROWS Error(BadArgument | UnsupportedNode)
  Region inside(PlacedBody& placed, unsigned facet, const Card& card, std::size_t at) {
    if (facet == 0) {
      return csg::map(placed.body.negative,
                      [&](const ShapeSide& side) { return entered(placed, side); });
    }
    if (facet > placed.body.facets.size()) {
      card.fail(ErrorId::BadArgument, fmt::format("facet {} of surface {}", facet, placed.name),
                fmt::format("one of its {} facets", placed.body.facets.size()), at);
    }
    const std::optional<ShapeSide>& side = placed.body.facets[facet - 1];
    if (!side) {
      card.fail(
          ErrorId::UnsupportedNode,
          fmt::format("facet {} of surface {}, a cone of one sheet or of two", facet, placed.name),
          "a cone as a surface of its own", at);
    }
    return Region::primitive(entered(placed, *side));
  }

  void enter_all(PlacedBody& placed) {
    for (std::uint32_t i = 0; i < placed.body.shapes.size(); ++i) entered(placed, {i, false});
  }

 private:
  void add(const Card& card, const TransformationTable& transformations) {
    SurfaceCard surface = read_surface_card(card, model_.warnings);
    if (!indices_.emplace(surface.number, surfaces_.size()).second) {
      card.fail(ErrorId::DuplicateId, fmt::format("a second surface {}", surface.number),
                "another number");
    }
    PlacedBody placed{
        surface.body, surfaces_.size(), surface.number, std::to_string(surface.number), {}};
    if (surface.transformation) {
      const Word& word = *surface.transformation;
      std::optional<Body> body = moved(transformations.find(card, word).to_main, surface.body);
      if (!body) {
        card.fail(ErrorId::UnsupportedNode, "a torus whose axis would be along none of x, y and z",
                  "a transformation that keeps it along one", word.at);
      }
      placed.body = std::move(*body);
    }
    placed.entered.resize(placed.body.shapes.size());
    plain_.push_back(std::move(placed));
    surfaces_.push_back(std::move(surface));
  }

  void check_partner(std::size_t index) const {
    const std::optional<Word>& word = surfaces_[index].partner;
    if (!word) return;
    const Id partner = -integer_of(cards_[index], *word);
    if (!find(partner)) {
      cards_[index].fail(ErrorId::UndefinedId, fmt::format("surface {}", partner),
                         "the number of another periodic plane", word->at);
    }
  }

  SurfaceSide entered(PlacedBody& placed, const ShapeSide& side) {
    std::optional<Index>& index = placed.entered[side.shape];
    if (!index) {
      index = static_cast<Index>(model_.surfaces.size());
      model_.surfaces.push_back(surface_of(placed, side.shape));
    }
    return {*index, side.is_positive};
  }

  openmc::Surface surface_of(const PlacedBody& placed, std::uint32_t index) const {
    const Shape& shape = placed.body.shapes[index];
    const auto half_space = openmc::half_space_of(shape.type, shape.coefficients);
    openmc::Surface surface{placed.id,
                            "",
                            shape.type,
                            openmc::Boundary::Transmission,
                            shape.coefficients,
                            *half_space,
                            cards_[placed.card].position()};
    if (!shape.is_auxiliary) surface.boundary = surfaces_[placed.card].boundary;
    surface.label = placed.name;
    if (placed.body.is_macrobody) surface.label += fmt::format(".{}", index + 1);
    if (shape.is_auxiliary) surface.label += " (the plane at its apex)";
    if (surface.label == std::to_string(surface.id)) surface.label.clear();
    return surface;
  }

  const std::vector<Card>& cards_;
  openmc::Model& model_;
  std::vector<SurfaceCard> surfaces_;
  std::unordered_map<Id, std::size_t> indices_;
  std::vector<PlacedBody> plain_;
  std::map<std::pair<Id, std::size_t>, PlacedBody> of_cells_;
};

class GeometryBuilder {
 public:
  GeometryBuilder(std::string_view text, std::string name)
      : deck_(read_deck(text, name)), transformations_(deck_.data, model_.warnings) {
    model_.name = std::move(name);
    model_.fills_space = true;
  }

  openmc::Model build() {
    surfaces_.emplace(deck_.surfaces, transformations_, model_);
    const Transformations find = [&](const Card& card, const Word& word) -> const Transformation& {
      return transformations_.find(card, word);
    };
    cells_ = read_cell_cards(deck_.cells, find, model_.warnings);
    for (std::size_t i = 0; i < cells_.size(); ++i) cell_indices_.emplace(cells_[i].number, i);
    enter_surfaces();
    for (const std::size_t cell : cells_by_complements()) regions_.emplace(cell, region_of(cell));
    for (std::size_t i = 0; i < cells_.size(); ++i) add_cell(i);
    choose_root();
    for (Index i = 0; i < cells_.size(); ++i) fill(i);
    openmc::refuse_cycles(model_);
    return std::move(model_);
  }

 private:
  // ---- regions ---------------------------------------------------------------------------------

  struct Place {
    std::size_t card;
    const CellCard* cell = nullptr;  // whose TRCL moves it
  };

  // THROWS Error(UndefinedId)
  Place place_of(const Operand& operand, const CellCard& cell) const {
    const CellCard* placed_by = cell.placement ? &cell : nullptr;
    if (const auto card = surfaces_->find(operand.number)) return {*card, placed_by};
    const auto other = cell_indices_.find(operand.number / least_named_by_cell);
    const auto card = surfaces_->find(operand.number % least_named_by_cell);
    if (!placed_by && card && other != cell_indices_.end() && cells_[other->second].placement) {
      return {*card, &cells_[other->second]};
    }
    cell.geometry_card->fail(ErrorId::UndefinedId, fmt::format("surface {}", operand.number),
                             "the number of a surface", operand.at);
  }

  PlacedBody& body_of(const Operand& operand, const CellCard& cell) {
    const Place place = place_of(operand, cell);
    return place.cell != nullptr ? surfaces_->of_cell(place.card, *place.cell, operand.at)
                                 : surfaces_->plain(place.card);
  }

  // Those that some cell uses where they are, and those that no cell uses, in the order of the
  // file.
  void enter_surfaces() {
    std::vector<std::vector<std::pair<const CellCard*, Operand>>> uses(deck_.surfaces.size());
    std::vector<bool> is_used(deck_.surfaces.size(), false);
    for (const CellCard& cell : cells_) {
      csg::for_each_primitive(cell.geometry, [&](const Operand& operand) {
        if (operand.is_cell) return;
        const Place place = place_of(operand, cell);
        is_used[place.card] = true;
        if (place.cell == nullptr && cell.lattice == 0)
          uses[place.card].push_back({&cell, operand});
      });
    }
    for (std::size_t i = 0; i < uses.size(); ++i) {
      if (!is_used[i]) surfaces_->enter_all(surfaces_->plain(i));
      for (const auto& use : uses[i]) {
        surfaces_->inside(surfaces_->plain(i), use.second.facet, *use.first->geometry_card,
                          use.second.at);
      }
    }
  }

  std::size_t complement_of(const CellCard& cell, const Operand& operand) const {
    const auto found = cell_indices_.find(operand.number);
    if (found == cell_indices_.end()) {
      cell.geometry_card->fail(ErrorId::UndefinedId, fmt::format("cell {}", operand.number),
                               "the number of a cell behind #", operand.at);
    }
    return found->second;
  }

  // Each behind those that it is the complement of, over a stack of our own.
  std::vector<std::size_t> cells_by_complements() const {
    enum class State : unsigned char { New, Open, Done };
    std::vector<State> states(cells_.size(), State::New);
    std::vector<std::size_t> order;
    std::vector<std::pair<std::size_t, bool>> pending;  // a cell, to enter or to leave
    for (std::size_t first = 0; first < cells_.size(); ++first) {
      pending.emplace_back(first, false);
      while (!pending.empty()) {
        const auto [index, leaves] = pending.back();
        pending.pop_back();
        if (leaves) {
          states[index] = State::Done;
          order.push_back(index);
        }
        if (leaves || states[index] != State::New) continue;
        states[index] = State::Open;
        pending.emplace_back(index, true);
        const CellCard& cell = cells_[index];
        csg::for_each_primitive(cell.geometry, [&](const Operand& operand) {
          if (!operand.is_cell) return;
          if (cell.placement) {
            cell.geometry_card->fail(ErrorId::UnsupportedNode, "# of a cell in a cell with trcl",
                                     "its surfaces", operand.at);
          }
          const std::size_t other = complement_of(cell, operand);
          if (cells_[other].lattice != 0) {
            cell.geometry_card->fail(ErrorId::UnsupportedNode, "# of a lattice cell",
                                     "the surfaces that bound the lattice", operand.at);
          }
          if (states[other] == State::Open) {
            cell.geometry_card->fail(
                ErrorId::BadArgument,
                fmt::format("cell {}, which is the complement of itself", operand.number),
                "another cell", operand.at);
          }
          if (states[other] == State::New) pending.emplace_back(other, false);
        });
      }
    }
    return order;
  }

  Region region_of(std::size_t index) {
    const CellCard& cell = cells_[index];
    // A lattice cell is where its lattice is: everywhere.
    if (cell.lattice != 0) return Region::full();
    Region region =
        substitute<Region>(cell.geometry, Region::full(), [&](const Operand& operand) -> Region {
          if (operand.is_cell) return regions_.at(complement_of(cell, operand));
          Region inside = surfaces_->inside(body_of(operand, cell), operand.facet,
                                            *cell.geometry_card, operand.at);
          return operand.is_positive ? outside_of(inside) : inside;
        });
    if (region.primitive_count() > most_operands) {
      cell.card->fail(ErrorId::TooLarge, "a geometry of more surfaces",
                      fmt::format("at most {}", most_operands));
    }
    return region;
  }

  // ---- cells and universes ---------------------------------------------------------------------

  Index universe_index(Id id) {
    const auto [entry, is_new] =
        universes_.emplace(id, static_cast<Index>(model_.universes.size()));
    if (is_new) model_.universes.push_back({id, {}});
    return entry->second;
  }

  void add_cell(std::size_t index) {
    const CellCard& card = cells_[index];
    openmc::Cell cell;
    cell.id = card.number;
    cell.position = card.card->position();
    cell.region = regions_.at(index);
    cell.universe = universe_index(card.universe);
    if (!card.fill && card.lattice == 0) cell.materials = materials_of(card);
    model_.universes[cell.universe].cells.push_back(static_cast<Index>(model_.cells.size()));
    model_.cells.push_back(std::move(cell));
  }

  static std::vector<std::optional<Id>> materials_of(const CellCard& card) {
    if (card.material == 0) return {std::nullopt};
    return {card.material};
  }

  void choose_root() {
    const auto root = universes_.find(0);
    if (root == universes_.end()) {
      throw Error(ErrorId::NoRootUniverse, {"every cell has a universe u", "cells without",
                                            cells_.front().card->position()});
    }
    model_.root = root->second;
  }

  // A universe of one cell.
  Index new_universe(Id id, openmc::Cell cell) {
    const auto universe = static_cast<Index>(model_.universes.size());
    cell.universe = universe;
    model_.universes.push_back({id, {static_cast<Index>(model_.cells.size())}});
    model_.cells.push_back(std::move(cell));
    return universe;
  }

  Index defined_universe(const Fill& fill, const FillElement& element) const {
    const auto found = universes_.find(element.universe);
    if (element.universe == 0 || found == universes_.end()) {
      fill.card->fail(ErrorId::UndefinedId, fmt::format("universe {}", element.universe),
                      "the universe u of some cell", element.at);
    }
    return found->second;
  }

  void fill(Index index) {
    const CellCard& card = cells_[index];
    if (card.placement && card.fill) refuse_two_transformations(*card.fill);
    if (card.lattice != 0) return fill_with_lattice(index);
    if (!card.fill) return;
    const FillElement& element = card.fill->elements.front();
    openmc::Cell& cell = model_.cells[index];
    cell.fill = FillKind::Universe;
    cell.filled_with = defined_universe(*card.fill, element);
    const auto& transformation = element.transformation ? element.transformation : card.placement;
    if (!transformation) return;
    cell.to_fill = inverse(transformation->to_main);
    cell.has_rounded_rotation = transformation->is_rounded;
  }

  static void refuse_two_transformations(const Fill& fill) {
    for (const FillElement& element : fill.elements) {
      if (!element.transformation) continue;
      fill.card->fail(ErrorId::UnsupportedNode, "a fill with a transformation in a cell with trcl",
                      "one of both", element.at);
    }
  }

  // ---- lattices --------------------------------------------------------------------------------

  void fill_with_lattice(Index index) {
    const CellCard& card = cells_[index];
    if (model_.universes[model_.cells[index].universe].cells.size() > 1) {
      card.card->fail(
          ErrorId::BadArgument,
          fmt::format("lattice cell {}, which is not alone in its universe", card.number),
          "a universe of its own");
    }
    LatticePlan plan = plan_lattice(card, walls_of(card), model_.warnings);
    openmc::Cell& cell = model_.cells[index];
    cell.fill = FillKind::Lattice;
    cell.filled_with = static_cast<Index>(model_.lattices.size());
    AffineMap to_fill = plan.frame;
    if (card.placement) {
      to_fill = to_fill * inverse(card.placement->to_main);
      cell.has_rounded_rotation = card.placement->is_rounded;
    }
    if (to_fill != AffineMap::identity()) cell.to_fill = std::move(to_fill);
    place_elements(card, plan);
    model_.lattices.push_back(std::move(plan.lattice));
  }

  std::vector<Wall> walls_of(const CellCard& card) {
    std::vector<Wall> walls;
    const auto refuse = [&](std::string found) {
      card.card->fail(ErrorId::BadArgument, std::move(found),
                      "the sides of one element: planes, or one body, one after another");
    };
    csg::walk(
        card.geometry.root(),
        [&](Geometry::Cursor node) {
          if (node.operation() != BooleanOperator::Intersection)
            refuse("a lattice cell with : or #");
          return true;
        },
        [&](Geometry::Cursor leaf) {
          const Operand& operand = leaf.primitive();
          if (operand.is_cell) refuse("a lattice cell with #");
          const auto number = surfaces_->find(operand.number);
          if (!number) place_of(operand, card);
          if (!number) refuse("a lattice cell with a surface of another cell");
          add_walls(surfaces_->plain(*number).body, operand, refuse, walls);
        },
        [](Geometry::Cursor) {});
    return walls;
  }

  template <class Refuse>
  void add_walls(const Body& body, const Operand& operand, const Refuse& refuse,
                 std::vector<Wall>& walls) const {
    std::vector<ShapeSide> sides;
    if (operand.facet == 0 && body.is_macrobody) {
      if (operand.is_positive) refuse("a lattice cell outside a body");
      for (const auto& facet : body.facets) sides.push_back(facet.value_or(ShapeSide{}));
    } else if (operand.facet > 0) {
      if (operand.facet > body.facets.size() || !body.facets[operand.facet - 1]) {
        refuse("a facet that is not there");
      }
      sides.push_back(*body.facets[operand.facet - 1]);
    } else if (body.shapes.size() == 1) {
      sides.push_back(body.negative.primitive());
    } else {
      refuse("a lattice cell at a cone");
    }
    for (ShapeSide side : sides) {
      if (operand.is_positive) side.is_positive = !side.is_positive;
      const Shape& shape = body.shapes[side.shape];
      const openmc::HalfSpace half_space = *openmc::half_space_of(shape.type, shape.coefficients);
      const domain::HalfSpace<3>* quadric = half_space.quadric();
      if (quadric == nullptr || !quadric->polynomial().is_linear()) {
        refuse("a lattice cell with a side that is no plane");
      }
      const auto& form = quadric->polynomial().linear();
      Wall wall{form.normal, Rational(-form.constant)};
      if (side.is_positive) {
        for (Rational& x : wall.normal) x = -x;
        wall.offset = -wall.offset;
      }
      walls.push_back(std::move(wall));
    }
  }

  void place_elements(const CellCard& card, LatticePlan& plan) {
    openmc::Lattice& lattice = plan.lattice;
    ElementFiller filler(*this, card, plan);
    if (!card.fill || !card.fill->ranges) {
      const Index universe =
          card.fill ? filler.universe_of(card.fill->elements.front()) : filler.own_material();
      lattice.elements.assign(plan.element_count, universe);
      lattice.outer = universe;
      return;
    }
    const Ranges& ranges = *card.fill->ranges;
    std::vector<std::optional<Index>> elements(plan.element_count);
    auto next = card.fill->elements.begin();
    for (std::int64_t k = ranges[2][0]; k <= ranges[2][1]; ++k) {
      for (std::int64_t j = ranges[1][0]; j <= ranges[1][1]; ++j) {
        for (std::int64_t i = ranges[0][0]; i <= ranges[0][1]; ++i) {
          elements[plan.index_of({i, j, k})] = filler.universe_of(*next++);
        }
      }
    }
    for (const std::optional<Index>& element : elements) {
      lattice.elements.push_back(element ? *element : filler.nothing());
    }
  }

  // Universes as the elements of a lattice show them, each made once.
  class ElementFiller {
   public:
    ElementFiller(GeometryBuilder& builder, const CellCard& card, const LatticePlan& plan)
        : builder_(builder), card_(card) {
      AffineMap to_centre = openmc::translation(plan.centre);
      if (!plan.lattice.has_layers) to_centre.m[2][3] = 0;
      from_element_ = inverse(plan.frame) * to_centre;
    }

    Index universe_of(const FillElement& element) {
      if (card_.universe != 0 && element.universe == card_.universe) return own_material();
      if (element.universe == 0 && card_.fill->ranges) return nothing();
      const Index universe = builder_.defined_universe(*card_.fill, element);
      AffineMap map = from_element_;
      if (element.transformation) map = inverse(element.transformation->to_main) * map;
      if (map == AffineMap::identity()) return universe;
      const std::string key = element.transformation ? key_of(map) : std::string();
      const auto [entry, is_new] = shown_.try_emplace({universe, key}, 0);
      if (is_new) {
        openmc::Cell cell = new_cell(Region::full());
        cell.fill = FillKind::Universe;
        cell.filled_with = universe;
        cell.to_fill = std::move(map);
        cell.has_rounded_rotation = element.transformation && element.transformation->is_rounded;
        entry->second = builder_.new_universe(element.universe, std::move(cell));
      }
      return entry->second;
    }

    // The lattice cell's own material.
    Index own_material() {
      if (!own_) {
        openmc::Cell cell = new_cell(Region::full());
        cell.materials = materials_of(card_);
        own_ = builder_.new_universe(card_.universe, std::move(cell));
      }
      return *own_;
    }

    // An element that does not exist: no place in it is in a cell.
    Index nothing() {
      if (!nothing_) {
        openmc::Cell cell = new_cell(Region::empty());
        cell.materials = {std::nullopt};
        nothing_ = builder_.new_universe(0, std::move(cell));
      }
      return *nothing_;
    }

   private:
    openmc::Cell new_cell(Region region) const {
      openmc::Cell cell;
      cell.id = card_.number;
      cell.region = std::move(region);
      cell.position = card_.card->position();
      return cell;
    }
    static std::string key_of(const AffineMap& map) {
      std::string key;
      for (const auto& row : map.m) {
        for (const Rational& x : row) key += to_text(x) + ' ';
      }
      return key;
    }

    GeometryBuilder& builder_;
    const CellCard& card_;
    AffineMap from_element_;
    std::map<std::pair<Index, std::string>, Index> shown_;
    std::optional<Index> own_;
    std::optional<Index> nothing_;
  };

  Deck deck_;
  openmc::Model model_;
  TransformationTable transformations_;
  std::optional<SurfaceTable> surfaces_;
  std::vector<CellCard> cells_;
  std::unordered_map<Id, std::size_t> cell_indices_;
  std::unordered_map<std::size_t, Region> regions_;
  std::unordered_map<Id, Index> universes_;
};

}  // namespace

openmc::Model read_geometry(std::string_view text, std::string name) {
  return GeometryBuilder(text, std::move(name)).build();
}

}  // namespace exactcsg::io::mcnp
