// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/mcnp/lattices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "exactcsg/io/openmc/lattices.hpp"

namespace exactcsg::io::mcnp {

namespace {

using Vector = domain::Coordinates<3>;
using Flat = std::array<Rational, 2>;
using Pair = std::array<std::int64_t, 2>;

Rational whole(std::int64_t value) { return Rational(static_cast<long>(value)); }

Flat operator+(const Flat& a, const Flat& b) {
  return {Rational(a[0] + b[0]), Rational(a[1] + b[1])};
}
Flat operator-(const Flat& a, const Flat& b) {
  return {Rational(a[0] - b[0]), Rational(a[1] - b[1])};
}
Flat scaled(const Rational& factor, const Flat& a) {
  return {Rational(factor * a[0]), Rational(factor * a[1])};
}
double length_of(const Flat& a) { return std::hypot(nearest_double(a[0]), nearest_double(a[1])); }

// Two opposite sides: -reach <= normal (x - centre) <= reach, normal outwards of the first.
struct Slab {
  Vector normal;
  Rational middle;  // normal * centre
  Rational reach;
};

// The axis across which a slab lies, where it begins and ends, and which way the elements count.
struct AxisSlab {
  std::size_t axis = 0;
  bool ascends = true;
  Rational lower, upper;
};

class Planner {
 public:
  Planner(const CellCard& cell, std::vector<Wall> walls, std::vector<Warning>& warnings)
      : cell_(cell), walls_(std::move(walls)), warnings_(warnings) {
    ranges_ = cell.fill && cell.fill->ranges ? *cell.fill->ranges : Ranges{};
  }

  LatticePlan plan() {
    plan_.lattice.id = cell_.number;
    plan_.lattice.position = cell_.card->position();
    if (cell_.lattice == 1) {
      plan_boxes();
    } else {
      plan_hexagons();
    }
    return std::move(plan_);
  }

 private:
  [[noreturn]] void fail(ErrorId id, std::string found, std::string expected) const {
    cell_.card->fail(id, std::move(found), std::move(expected));
  }

  std::int64_t size(std::size_t range) const { return ranges_[range][1] - ranges_[range][0] + 1; }

  Slab slab(std::size_t pair) const {
    const Wall& first = walls_[2 * pair];
    const Wall& second = walls_[2 * pair + 1];
    Rational factor;  // second.normal = -factor first.normal
    for (std::size_t i = 0; i < 3; ++i) {
      if (first.normal[i] != 0) factor = -second.normal[i] / first.normal[i];
    }
    bool is_opposite = factor > 0;
    for (std::size_t i = 0; i < 3; ++i) {
      is_opposite = is_opposite && second.normal[i] == -factor * first.normal[i];
    }
    if (!is_opposite) {
      fail(ErrorId::BadArgument,
           fmt::format("a lattice cell whose sides {} and {} are not opposite", 2 * pair + 1,
                       2 * pair + 2),
           "sides in pairs of opposite ones");
    }
    const Rational other = second.offset / factor;
    Slab result{first.normal, Rational((first.offset - other) / 2),
                Rational((first.offset + other) / 2)};
    if (result.reach <= 0) {
      fail(ErrorId::BadArgument,
           fmt::format("a lattice cell with nothing between its sides {} and {}", 2 * pair + 1,
                       2 * pair + 2),
           "another sense of its surfaces");
    }
    return result;
  }

  AxisSlab axis_slab(std::size_t pair) const {
    const Slab found = slab(pair);
    AxisSlab result;
    std::size_t components = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      if (found.normal[i] == 0) continue;
      ++components;
      result.axis = i;
    }
    if (components != 1) {
      fail(ErrorId::UnsupportedNode,
           fmt::format("a lattice cell whose sides {} and {} are not across x, y or z",
                       2 * pair + 1, 2 * pair + 2),
           "such sides; turn the cell by trcl");
    }
    const Rational& n = found.normal[result.axis];
    result.ascends = n > 0;
    result.lower = found.middle / n - abs(Rational(found.reach / n));
    result.upper = found.middle / n + abs(Rational(found.reach / n));
    return result;
  }

  // A cyclic exchange of axes after which `axis` is z.
  void choose_frame(std::size_t axis) {
    for (std::size_t row = 0; row < 3; ++row) {
      for (std::size_t i = 0; i < 4; ++i) plan_.frame.m[row][i] = i == (axis + 1 + row) % 3 ? 1 : 0;
      plan_.frame.m[row][3] = 0;
    }
  }
  static std::size_t in_frame(std::size_t axis, std::size_t z_axis) {
    return (axis + 2 - z_axis) % 3;
  }

  void expect_one_layer() const {
    if (size(2) == 1) return;
    fail(ErrorId::BadArgument,
         fmt::format("{} layers of a lattice cell without ends along an axis", size(2)),
         "k1:k2 with one layer");
  }

  // Where elements are along an axis, ascending; returns the place of the lower end of all.
  Rational place_row(const AxisSlab& row, std::size_t range, std::size_t axis) {
    const Rational width = row.upper - row.lower;
    const auto& [from, to] = ranges_[range];
    plan_.lattice.pitch[axis] = width;
    plan_.centre[axis] = (row.lower + row.upper) / 2;
    plan_.lattice.numbering->matrix[range][axis] = row.ascends ? 1 : -1;
    plan_.lattice.numbering->offset[range] = row.ascends ? from : to;
    return row.lower + width * whole(row.ascends ? from : -to);
  }

  static std::int64_t place_in_row(const AxisSlab& row, const Pair& range, std::int64_t element) {
    return row.ascends ? element - range[0] : range[1] - element;
  }

  void plan_boxes() {
    if (walls_.size() == 2) {
      fail(ErrorId::UnsupportedNode, "a lattice of slabs, with two sides", "four or six sides");
    }
    if (walls_.size() != 4 && walls_.size() != 6) {
      fail(ErrorId::WrongCount, fmt::format("a lattice cell of {} sides", walls_.size()),
           "four or six");
    }
    openmc::Lattice& lattice = plan_.lattice;
    lattice.has_layers = walls_.size() == 6;
    lattice.counts = {1, 1, 1};
    lattice.numbering.emplace();
    std::vector<AxisSlab> rows;
    for (std::size_t pair = 0; pair < walls_.size() / 2; ++pair) {
      rows.push_back(axis_slab(pair));
      for (std::size_t other = 0; other < pair; ++other) {
        if (rows[other].axis == rows[pair].axis) {
          fail(ErrorId::BadArgument, "a lattice cell with two pairs of sides across one axis",
               "pairs across different axes");
        }
      }
    }
    std::size_t z_axis = 2;
    if (!lattice.has_layers) {
      z_axis = 3 - rows[0].axis - rows[1].axis;
      choose_frame(z_axis);
      expect_one_layer();
    }
    std::array<std::size_t, 3> axes{0, 1, 2};
    for (std::size_t pair = 0; pair < rows.size(); ++pair) {
      axes[pair] = in_frame(rows[pair].axis, z_axis);
      lattice.counts[axes[pair]] = size(pair);
      lattice.origin[axes[pair]] = place_row(rows[pair], pair, axes[pair]);
    }
    lattice.layers = lattice.counts[2];
    plan_.element_count = static_cast<std::size_t>(size(0) * size(1) * size(2));
    plan_.index_of = [rows, axes, ranges = ranges_,
                      counts = lattice.counts](const std::array<std::int64_t, 3>& element) {
      std::array<std::int64_t, 3> place{};
      for (std::size_t pair = 0; pair < rows.size(); ++pair) {
        place[axes[pair]] = place_in_row(rows[pair], ranges[pair], element[pair]);
      }
      return static_cast<std::size_t>((place[2] * counts[1] + place[1]) * counts[0] + place[0]);
    };
  }

  // ---- hexagons --------------------------------------------------------------------------------

  struct Side {
    Flat normal;
    Rational reach;
  };

  static Rational dot(const Flat& a, const Flat& b) { return Rational(a[0] * b[0] + a[1] * b[1]); }

  // Where two lines normal x = reach meet.
  Flat corner(const Side& a, const Side& b) const {
    const Rational whole = a.normal[0] * b.normal[1] - a.normal[1] * b.normal[0];
    if (whole == 0) {
      fail(ErrorId::BadArgument, "a hexagonal lattice cell with parallel pairs of sides",
           "three pairs of different directions");
    }
    return {Rational((a.reach * b.normal[1] - b.reach * a.normal[1]) / whole),
            Rational((a.normal[0] * b.reach - b.normal[0] * a.reach) / whole)};
  }

  static Side reversed(const Side& side) { return {scaled(-1, side.normal), side.reach}; }

  // The axis along which the prism lies.
  std::size_t prism_axis() const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (std::all_of(walls_.begin(), walls_.begin() + 6,
                      [&](const Wall& wall) { return wall.normal[axis] == 0; })) {
        return axis;
      }
    }
    fail(ErrorId::UnsupportedNode, "a hexagonal lattice cell that is not along x, y or z",
         "such a prism; turn the cell by trcl");
  }

  // The vectors to the elements (1, 0) and (0, 1), and a corner.
  struct Hexagon {
    Flat centre, first, second, corner;
  };

  Hexagon hexagon(std::size_t z_axis) const {
    std::array<Side, 3> sides;
    std::array<Rational, 3> middles;
    for (std::size_t pair = 0; pair < 3; ++pair) {
      const Slab found = slab(pair);
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t axis = in_frame(i, z_axis);
        if (axis < 2) sides[pair].normal[axis] = found.normal[i];
      }
      sides[pair].reach = found.reach;
      middles[pair] = found.middle;
    }
    Hexagon result;
    result.centre = corner({sides[0].normal, middles[0]}, {sides[1].normal, middles[1]});
    const Flat a = corner(sides[0], sides[1]);
    const Flat b = corner(sides[1], sides[2]);
    const Flat c = corner(sides[0], reversed(sides[2]));
    if (abs(dot(sides[2].normal, a)) > sides[2].reach ||
        abs(dot(sides[0].normal, b)) > sides[0].reach ||
        abs(dot(sides[1].normal, c)) > sides[1].reach) {
      fail(ErrorId::BadArgument, "a lattice cell whose six sides make no hexagon in this order",
           "the sides of (1,0), (-1,0), (0,1), (0,-1), (-1,1), (1,-1)");
    }
    result.first = a + c;
    result.second = a + b;
    result.corner = a;
    const double off =
        std::abs(nearest_double(Rational(dot(sides[2].normal, result.centre) - middles[2])));
    if (off > tolerance * nearest_double(sides[2].reach)) {
      fail(ErrorId::BadArgument, "a lattice cell whose sides 5 and 6 are not round its middle",
           "a hexagon that is the same seen from its other side");
    }
    return result;
  }

  static constexpr double tolerance = 1e-3;

  // The lattice of the kind with this pitch and distance between rows: where (i, a) is.
  static Flat place(openmc::LatticeKind kind, const Rational& pitch, const Rational& step,
                    const Pair& element) {
    const bool is_y = kind == openmc::LatticeKind::HexagonalY;
    const Rational i = whole(element[0]);
    const Rational a = whole(element[1]);
    Rational across = step * (is_y ? i : a);
    Rational straight = pitch * (is_y ? Rational(a + i / 2) : Rational(i + a / 2));
    if (is_y) return {std::move(across), std::move(straight)};
    return {std::move(straight), std::move(across)};
  }

  struct Fit {
    Pair first{}, second{};  // the elements (1, 0) and (0, 1) in the lattice's numbers
  };

  Fit fit(const Hexagon& hexagon) {
    openmc::Lattice& lattice = plan_.lattice;
    const std::array<Flat, 3> neighbours{hexagon.first, hexagon.second,
                                         hexagon.second - hexagon.first};
    std::optional<std::size_t> straight;
    for (std::size_t n = 0; n < 3 && !straight; ++n) {
      for (std::size_t axis = 0; axis < 2 && !straight; ++axis) {
        if (std::abs(nearest_double(neighbours[n][1 - axis])) >
            tolerance * length_of(neighbours[n])) {
          continue;
        }
        straight = n;
        lattice.kind =
            axis == 1 ? openmc::LatticeKind::HexagonalY : openmc::LatticeKind::HexagonalX;
        lattice.pitch[0] = lattice.pitch[1] = abs(neighbours[n][axis]);
      }
    }
    if (!straight) {
      fail(ErrorId::UnsupportedNode, "a hexagonal lattice no side of which is across an axis",
           "such a lattice; turn the cell by trcl");
    }
    const std::size_t across = lattice.kind == openmc::LatticeKind::HexagonalY ? 0 : 1;
    Rational step;
    for (std::size_t n = 0; n < 3; ++n) {
      if (n != *straight) step += abs(neighbours[n][across]) / 2;
    }
    lattice.row_distance = step;
    Fit result;
    std::array<Flat, 2> images;
    for (std::size_t n = 0; n < 2; ++n) {
      Pair& best = n == 0 ? result.first : result.second;
      double least = HUGE_VAL;
      for (const Pair& element :
           {Pair{1, 0}, Pair{-1, 0}, Pair{0, 1}, Pair{0, -1}, Pair{1, -1}, Pair{-1, 1}}) {
        const Flat at = place(lattice.kind, lattice.pitch[0], step, element);
        const double distance = length_of(at - neighbours[n]);
        if (distance >= least) continue;
        least = distance;
        best = element;
        images[n] = at;
      }
    }
    check_fit(hexagon, images);
    return result;
  }

  // The corner between the elements (0, 0), (1, 0) and (0, 1) is their middle, in the lattice.
  void check_fit(const Hexagon& hexagon, const std::array<Flat, 2>& images) {
    const Flat corner = scaled(Rational(1, 3), images[0] + images[1]);
    const double moved =
        std::max({length_of(images[0] - hexagon.first), length_of(images[1] - hexagon.second),
                  length_of(corner - hexagon.corner)});
    if (!(moved <= tolerance * length_of(hexagon.first))) {
      fail(ErrorId::UnsupportedNode, "a lattice of hexagons that are not regular",
           "regular ones within a thousandth");
    }
    const bool is_exact =
        images[0] == hexagon.first && images[1] == hexagon.second && corner == hexagon.corner;
    if (is_exact) return;
    warnings_.push_back(
        {fmt::format(
             "the elements of lattice cell {} are made regular: corners move by up to {:.2g}",
             cell_.number, moved * 1.01),
         cell_.card->position()});
  }

  static Pair combined(const Fit& fit, std::int64_t i, std::int64_t j) {
    return {i * fit.first[0] + j * fit.second[0], i * fit.first[1] + j * fit.second[1]};
  }

  void plan_hexagons() {
    if (walls_.size() != 6 && walls_.size() != 8) {
      fail(ErrorId::WrongCount, fmt::format("a hexagonal lattice cell of {} sides", walls_.size()),
           "six or eight");
    }
    openmc::Lattice& lattice = plan_.lattice;
    const std::size_t z_axis = prism_axis();
    choose_frame(z_axis);
    const Hexagon shape = hexagon(z_axis);
    const Fit fitted = fit(shape);
    for (std::size_t i = 0; i < 2; ++i) plan_.centre[i] = shape.centre[i];
    lattice.numbering.emplace();
    lattice.pitch[2] = 0;
    AxisSlab layers;
    if (walls_.size() == 8) {
      layers = axis_slab(3);
      if (layers.axis != z_axis) {
        fail(ErrorId::BadArgument, "a hexagonal lattice cell whose ends are not across its sides",
             "ends across them");
      }
      lattice.has_layers = true;
      lattice.layers = size(2);
      const Rational lower = place_row(layers, 2, 2);
      lattice.origin[2] = lower + lattice.pitch[2] * whole(lattice.layers) / 2;
    } else {
      expect_one_layer();
      lattice.numbering->offset[2] = ranges_[2][0];
    }
    place_hexagons(fitted, layers);
  }

  // The rhombus of the array, in a hexagon of elements round its middle.
  void place_hexagons(const Fit& fitted, const AxisSlab& layers) {
    openmc::Lattice& lattice = plan_.lattice;
    const Pair middle{(ranges_[0][0] + ranges_[0][1]) / 2, (ranges_[1][0] + ranges_[1][1]) / 2};
    std::int64_t reach = 0;
    for (const std::int64_t i : ranges_[0]) {
      for (const std::int64_t j : ranges_[1]) {
        const Pair at = combined(fitted, i - middle[0], j - middle[1]);
        reach = std::max({reach, std::abs(at[0]), std::abs(at[1]), std::abs(at[0] + at[1])});
      }
    }
    constexpr std::int64_t greatest = 5'000;
    if (reach > greatest) {
      fail(ErrorId::TooLarge, "a hexagonal lattice of more rings", fmt::format("{}", greatest));
    }
    lattice.rings = reach + 1;
    const Flat offset = place(lattice.kind, lattice.pitch[0], *lattice.row_distance,
                              combined(fitted, middle[0], middle[1]));
    for (std::size_t i = 0; i < 2; ++i) lattice.origin[i] = plan_.centre[i] + offset[i];
    const std::int64_t determinant =
        fitted.first[0] * fitted.second[1] - fitted.first[1] * fitted.second[0];
    auto& matrix = lattice.numbering->matrix;
    matrix[0] = {determinant * fitted.second[1], -determinant * fitted.second[0], 0};
    matrix[1] = {-determinant * fitted.first[1], determinant * fitted.first[0], 0};
    for (std::size_t i = 0; i < 2; ++i) lattice.numbering->offset[i] = middle[i];
    const std::int64_t in_a_layer = 3 * lattice.rings * reach + 1;
    constexpr std::int64_t most_elements = 100'000'000;
    if (in_a_layer > most_elements / lattice.layers) {
      fail(ErrorId::TooLarge, "a hexagonal lattice of more elements",
           fmt::format("at most {}, in hexagonal rings round the array", most_elements));
    }
    plan_.element_count = static_cast<std::size_t>(in_a_layer * lattice.layers);
    openmc::Lattice shape = lattice;
    plan_.index_of = [fitted, middle, layers, shape = std::move(shape),
                      range = ranges_[2]](const std::array<std::int64_t, 3>& element) {
      const Pair at = combined(fitted, element[0] - middle[0], element[1] - middle[1]);
      const std::int64_t layer = shape.has_layers ? place_in_row(layers, range, element[2]) : 0;
      return openmc::element_index(shape, {at[0], at[1], layer});
    };
  }

  const CellCard& cell_;
  std::vector<Wall> walls_;
  std::vector<Warning>& warnings_;
  Ranges ranges_{};
  LatticePlan plan_;
};

}  // namespace

LatticePlan plan_lattice(const CellCard& cell, std::vector<Wall> walls,
                         std::vector<Warning>& warnings) {
  return Planner(cell, std::move(walls), warnings).plan();
}

}  // namespace exactcsg::io::mcnp
