// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The geometry of an OpenMC model, as geometry.xml or model.xml says it, or of an MCNP input file
// (io/mcnp/reader.hpp): surfaces, cells, universes and lattices that refer to each other by index.
// A value, not changed once it was read. [Exact]
//
// LAW openmc_model.1  decimals mean themselves: no coefficient is rounded. Two irrational numbers
//                     are: the sines and cosines of a rotation given in degrees, and half the root
//                     of three of a hexagonal lattice, each to the nearest double. What they make
//                     is the model, and has_rounded_rotation and is_rounded() say so.
// LAW openmc_model.2  indices are in range, universes are not empty, and no universe is below
//                     itself.
//
// Source: the format's description in OpenMC's user's guide (0.13 to 0.15).

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "exactcsg/csg/tree.hpp"
#include "exactcsg/domain/surface_half_space.hpp"
#include "exactcsg/io/model.hpp"

namespace exactcsg::io::openmc {

using Id = std::int32_t;
using Index = std::uint32_t;
// What a side of a surface is.
using HalfSpace = domain::SurfaceHalfSpace;
using Point = domain::Point<3>;

enum class Boundary : unsigned char { Transmission, Vacuum, Reflective, White, Periodic };

struct Surface {
  Id id = 0;
  std::string name;
  std::string type;  // as the format spells it: "z-cylinder"
  Boundary boundary = Boundary::Transmission;
  std::vector<Rational> coefficients;
  HalfSpace negative;  // {f <= 0}, what "-id" says
  SourcePosition position;
  std::string label{};  // what users call it, if not by its id: "8.3", a facet
};
std::string label_of(const Surface& surface);

// "-id" or "id" in a region.
struct SurfaceSide {
  Index surface = 0;
  bool is_positive = false;
  friend bool operator==(const SurfaceSide&, const SurfaceSide&) = default;
};
// Regular closed sets: which side the surfaces themselves belong to does not matter.
using Region = csg::BooleanTree<SurfaceSide>;
using HalfSpaceRegion = csg::BooleanTree<HalfSpace>;

enum class FillKind : unsigned char { Material, Universe, Lattice };

struct Cell {
  Id id = 0;
  std::string name;
  Region region;  // Full if the file has none
  Index universe = 0;
  FillKind fill = FillKind::Material;
  Index filled_with = 0;                     // of a universe or lattice
  std::vector<std::optional<Id>> materials;  // nullopt: void; several: one an instance
  std::optional<AffineMap> to_fill;          // from the cell's coordinates to those of its fill
  bool has_rounded_rotation = false;         // given in degrees, whose sines are irrational
  SourcePosition position;
};

struct Universe {
  Id id = 0;
  std::vector<Index> cells;  // in the order of the file
};

enum class LatticeKind : unsigned char { Rectangular, HexagonalX, HexagonalY };

// How users number elements, if not as here: matrix * element + offset.
struct ElementNumbering {
  std::array<std::array<std::int64_t, 3>, 3> matrix{};
  std::array<std::int64_t, 3> offset{};
};

// LAW lattice.1  elements.size() is the product of the counts if rectangular, and layers times
//                3 rings (rings - 1) + 1 if hexagonal, in the order of element_index.
struct Lattice {
  Id id = 0;
  std::string name;
  LatticeKind kind = LatticeKind::Rectangular;
  bool has_layers = false;               // repeats along z as well
  std::array<std::int64_t, 3> counts{};  // of elements along x, y, z (rectangular)
  std::int64_t rings = 0;                // (hexagonal)
  std::int64_t layers = 1;
  std::array<Rational, 3> origin{};  // lower left corner, or centre if hexagonal
  std::array<Rational, 3> pitch{};   // hexagonal: [0] across, [2] along z
  std::vector<Index> elements;       // universes
  std::optional<Index> outer;        // universe
  SourcePosition position;
  // Hexagonal: between rows; without, half the root of three, rounded, times the pitch.
  std::optional<Rational> row_distance{};
  std::optional<ElementNumbering> numbering{};

  bool is_hexagonal() const { return kind != LatticeKind::Rectangular; }
  bool is_rounded() const { return is_hexagonal() && !row_distance; }
};

struct Model {
  std::string name;  // the file's name as given
  std::vector<Surface> surfaces;
  std::vector<Cell> cells;
  std::vector<Universe> universes;
  std::vector<Lattice> lattices;
  Index root = 0;  // universe
  // Every place has to be in a cell of the root, also where no boundary condition keeps particles
  // in: the format has cells for all that is outside.
  bool fills_space = false;
  std::vector<Warning> warnings;
};

// What the cell is filled with: no universe, one, or those of a lattice; ascending, each once.
std::vector<Index> universes_in(const Model& model, const Cell& cell);

// The region as a tree of half-spaces. Equal sides share one primitive's data.
HalfSpaceRegion half_spaces(const Model& model, const Region& region);

// THROWS Error with line and column for everything that is wrong with the text.
Model read_geometry(std::string_view text, std::string name);
// Of a file, by the ending of its name: .xml, or .mcnp, .inp and .i of MCNP.
// THROWS what the format's reader throws, and Error(FileNotReadable | EmptyFile)
Model read_geometry_file(const std::filesystem::path& file);
// By the ending of its name.
bool is_geometry_file(const std::filesystem::path& file);

}  // namespace exactcsg::io::openmc
