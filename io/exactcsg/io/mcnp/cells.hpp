// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Cell cards: "j m d geometry parameters", "j LIKE n BUT parameters". [Exact]
//
// From the strongest: parentheses, # (complement: of a cell "#n", or "#(...)"), a blank or nothing
// (intersection), : (union). Parameters are keywords with values: of those that say something about
// geometry, U, FILL, LAT, TRCL, MAT; the others that MCNP has are passed over, unknown ones warned
// of.
// LAW cell_card.1  no text is too deep: nothing here recurses.

#include <array>
#include <functional>
#include <vector>

#include "exactcsg/csg/tree.hpp"
#include "exactcsg/io/mcnp/deck.hpp"
#include "exactcsg/io/mcnp/transformation.hpp"
#include "exactcsg/io/openmc/model.hpp"

namespace exactcsg::io::mcnp {

// What stands in a geometry: "-8.3", or the 5 of "#5".
struct Operand {
  bool is_cell = false;
  openmc::Id number = 0;
  unsigned facet = 0;  // 0: the whole surface
  bool is_positive = false;
  std::size_t at = 0;  // in the card

  friend bool operator==(const Operand&, const Operand&) = default;
};
using Geometry = csg::BooleanTree<Operand>;

struct FillElement {
  openmc::Id universe = 0;
  std::optional<Transformation> transformation;
  std::size_t at = 0;
};

struct Fill {
  // Of an array: from, to along the three; the first varies fastest.
  std::optional<std::array<std::array<std::int64_t, 2>, 3>> ranges;
  std::vector<FillElement> elements;
  std::size_t at = 0;
  const Card* card = nullptr;
};

struct CellCard {
  const Card* card = nullptr;
  const Card* geometry_card = nullptr;  // of another cell after LIKE
  openmc::Id number = 0;
  openmc::Id material = 0;
  Geometry geometry;
  openmc::Id universe = 0;
  int lattice = 0;  // 1 or 2
  std::optional<Fill> fill;
  std::optional<Transformation> placement;  // TRCL
};

using Transformations = std::function<const Transformation&(const Card&, const Word&)>;

// REQUIRES that the cards outlive the result. THROWS Error with a place for everything that is
// wrong
std::vector<CellCard> read_cell_cards(const std::vector<Card>& cards,
                                      const Transformations& transformations,
                                      std::vector<Warning>& warnings);

}  // namespace exactcsg::io::mcnp
