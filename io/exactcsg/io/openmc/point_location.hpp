// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Which cell of an OpenMC model a point is in, through universes and lattices. [Exact]
//
// In each universe on the way all cells are asked, in the point's coordinates there:
// LAW location.1  exactly one has the point in its interior, and it is on the boundary of none:
//                 that cell is entered; at a material, the place is InCell.
// LAW location.2  it is on the boundary of some cell, or of a lattice's element: OnBoundary.
// LAW location.3  otherwise several have it in their interior: InOverlap; or none, InGap. A lattice
//                 without an outer universe has a gap round it.
// LAW location.4  `cells` has all cells of the last universe that have the point inside or on
//                 their boundary, in the order of the file; `path` leads to that universe, and to
//                 the cell if it is InCell. Where a lattice decides, the path ends there, and there
//                 are no cells.
// LAW location.5  PointLocator(m)(p) == locate(m, p).
// THROWS Error(UndecidedNeighbourhood) as domain::classify does.
// COST: locate asks every cell of the universes on the way. PointLocator divides the space of each
// universe with many surfaces until few matter, and then asks those: O(log surfaces) a level.
//
// Decisions are filtered: exact numbers are computed where doubles do not decide, and for the
// coordinates in universes that are moved.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "exactcsg/io/openmc/model.hpp"

namespace exactcsg::io::openmc {

enum class PointVerdict : unsigned char { InCell, OnBoundary, InGap, InOverlap };

enum class StepKind : unsigned char { Universe, Cell, Lattice };

struct Step {
  StepKind kind = StepKind::Universe;
  Index index = 0;
  // Of a lattice, the element as in LatticePlace; nullopt: its outside.
  std::optional<std::array<std::int64_t, 3>> element;
  friend bool operator==(const Step&, const Step&) = default;
};

// "universe 0 > cell 10 > lattice 50 (8, 8) > universe 2", by ids.
std::string path_text(const Model& model, const std::vector<Step>& path);

struct Location {
  PointVerdict verdict = PointVerdict::InGap;
  std::vector<Step> path;
  std::vector<Index> cells;
  friend bool operator==(const Location&, const Location&) = default;
};

Location locate(const Model& model, const Point& point);

// Immutable; any number of threads may ask it.
class PointLocator {
 public:
  // REQUIRES that the model outlives it. COST: O(n log n) for n surfaces of cells that are spread.
  explicit PointLocator(const Model& model);
  ~PointLocator();
  PointLocator(PointLocator&&) noexcept;
  PointLocator& operator=(PointLocator&&) noexcept;

  Location operator()(const Point& point) const;

 private:
  struct Data;
  std::unique_ptr<const Data> data_;
};

}  // namespace exactcsg::io::openmc
