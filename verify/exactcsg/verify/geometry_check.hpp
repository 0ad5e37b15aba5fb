// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Whether the cells of an OpenMC model overlap or leave gaps, where they can be seen. [Certified];
// witnesses [Exact]
//
// Every universe is looked at in its own coordinates, in each of its views
// (io/openmc/visible_universes.hpp): through the cells that it fills and the lattice elements that
// show it, and once for all places where it is seen in the same shape. What a lattice's element
// cuts away is no overlap and no gap.
//   overlap  points inside two cells of a universe, or more
//   gap      points outside all cells of a universe, unless boundary conditions keep particles away
//            from there; points outside the elements of a lattice without an outer universe
//
// Where particles are: the surfaces of a universe's cells with a boundary condition (vacuum,
// reflective, white, periodic) divide space by their sides. A combination of sides in which some
// cell of the universe has points is where particles are, and has to be filled; one without is
// outside. So what lies behind the outermost surface is no gap if that surface has a boundary
// condition; it is one if a particle gets there through a surface without. A universe without such
// surfaces fills its views.
//
// The root is looked at in the box given, or else in box_of_root (io/openmc/region_bounds.hpp).
//
// LAW geometry_check.1  is_clean(): there is no overlap and no gap in the box, in that sense.
// LAW geometry_check.2  every defect is one; its point is in the box, inside exactly the cells
//                       named and outside the others or on their boundary; io::openmc::locate finds
//                       InOverlap or InGap there with this path, unless an overlap of a universe
//                       above hides it.
// LAW geometry_check.3  all else that is wrong lies in the cells that are listed as undecided,
// whose
//                       volumes sum up, over all places where they are, to `undecided_volume`.
// Of overlaps each set of cells is named once for a universe, of gaps one point for a view.
// Coincident and unused surfaces, universes that are nowhere seen are warnings, not defects.

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "exactcsg/io/openmc/visible_universes.hpp"
#include "exactcsg/support/progress.hpp"
#include "exactcsg/verify/report.hpp"

namespace exactcsg::verify {

struct GeometryCheckOptions {
  std::optional<domain::Box<3>> box;  // of the root's coordinates
  double budget_seconds = 60;         // for all proofs; a view gets at most half of what is left
  std::uint64_t cells = 1'000'000;    // of the division of one view
  double negligible_share = 1e-11;    // of a view's box, at which a proof is given up
  std::size_t overlaps = 100;         // that are named of one view
  Progress* progress = nullptr;
};

enum class DefectKind : unsigned char { Overlap, Gap };

struct Defect {
  DefectKind kind = DefectKind::Overlap;
  io::openmc::Point point;               // in the root's coordinates
  std::vector<io::openmc::Step> path;    // to the universe or lattice
  std::vector<io::openmc::Index> cells;  // that overlap
};

struct UndecidedPart {
  std::vector<io::openmc::Step> path;
  Rational volume;                    // at all places where the view is
  std::vector<domain::Box<3>> boxes;  // in the coordinates at the end of the path, some of them
  std::size_t box_count = 0;
  std::vector<io::openmc::Index> cells;  // that have a boundary in these boxes
};

// A line of the report: a universe, or a lattice without outer universe.
struct CheckedPart {
  io::openmc::Step part;
  std::size_t views = 0;
  Integer instances;
  std::size_t overlaps = 0;
  std::size_t gaps = 0;
  Rational undecided_volume;
};

// Surfaces of one equation, but for a factor; is_reversed[i]: the sides of the i-th are exchanged.
struct CoincidentSurfaces {
  std::vector<io::openmc::Index> surfaces;
  std::vector<bool> is_reversed;
};

struct GeometryCheck {
  std::string model;
  domain::Box<3> box;
  std::vector<CheckedPart> parts;
  std::vector<Defect> defects;
  std::vector<UndecidedPart> undecided;
  std::vector<io::openmc::Index> unused_surfaces;
  std::vector<io::openmc::Index> unseen_universes;
  std::vector<CoincidentSurfaces> coincident_surfaces;
  double seconds = 0;

  Rational undecided_volume() const;
  // No defect, and at most so much undecided.
  bool is_clean(const Rational& tolerance = 0) const;
};

// THROWS Error(UnboundedSolid) if there is no box, what Progress throws, and Error(TooLarge)
GeometryCheck check_geometry(const io::openmc::Model& model,
                             const GeometryCheckOptions& options = {});

std::vector<CoincidentSurfaces> coincident_surfaces(const io::openmc::Model& model);

// A table, and below it the defects with their points.
std::string render_text(const io::openmc::Model& model, const GeometryCheck& check,
                        const Rational& tolerance);
// One object, "schema": "exactcsg.check/1".
std::string render_json(const io::openmc::Model& model, const GeometryCheck& check,
                        const Rational& tolerance);
// Each part's overlaps, gaps and undecided volume as checks, for JUnit and HTML.
Report as_report(const io::openmc::Model& model, const GeometryCheck& check,
                 const Rational& tolerance);

}  // namespace exactcsg::verify
