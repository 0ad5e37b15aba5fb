// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Where the universes of a model, and their cells, are seen: through the regions of the cells that
// they fill, and the elements of lattices, all the way down from the root. [Exact]
//
// LAW visible.1  the points at which `locate` enters a universe, outside the overlaps of those
//                above, are those of its views, mapped from the root; within the box given.
// LAW visible.2  views of one universe differ as they are written: the same window at many places,
//                such as an element of a lattice that nothing cuts, is one view.
// LAW visible.3  views are in an order in which a universe comes before what fills its cells.
// What a window leaves of another cell's window is not asked: neighbours in a universe may overlap.
// THROWS Error(TooLarge) for more than 2 000 000 views. COST: a window for each element of a
// lattice that the windows above cut, and one for all others of the same universe.

#include <string>
#include <vector>

#include "exactcsg/io/openmc/model.hpp"
#include "exactcsg/io/openmc/point_location.hpp"
#include "exactcsg/support/progress.hpp"

namespace exactcsg::io::openmc {

// The points inside both the box, if there is one, and the window.
struct Visible {
  std::optional<domain::Box<3>> box;
  HalfSpaceRegion window;
  AffineMap from_root;     // to the coordinates of box and window
  std::vector<Step> path;  // down to the universe or lattice
  Integer instances = 1;   // so many times; the map and the path are those of the first one
  // In infinitely many places: the outer universe of a lattice in a cell that is not bounded.
  bool is_everywhere = false;
};

struct View {
  Index universe = 0;
  Visible visible;
};

// A part of the outside of a lattice that has no outer universe.
struct OutsideView {
  Index lattice = 0;
  Visible visible;
};

struct VisibleUniverses {
  std::vector<View> views;
  std::vector<OutsideView> outsides;  // some may be without interior
};

VisibleUniverses visible_universes(const Model& model, const std::optional<domain::Box<3>>& box,
                                   Progress* progress = nullptr);

std::optional<Visible> part_in(const Model& model, const Visible& visible, const Cell& cell);

// A cell in a view of its universe.
struct VisibleCell {
  Index cell = 0;
  std::size_t view = 0;
  Visible visible;
};

struct VisibleCells {
  std::vector<View> views;
  std::vector<VisibleCell> cells;
};

// Wherever they are, without a box: those that are visible in one way are one, counted.
VisibleCells visible_cells(const Model& model, Progress* progress = nullptr);

}  // namespace exactcsg::io::openmc
