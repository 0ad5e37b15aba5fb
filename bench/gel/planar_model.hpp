// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The planar half-spaces and models of the experiments: lines and circles with coefficients that
// are multiples of 2^-12, asked at points that are multiples of 2^-14 in the unit square. Every
// intermediate result is then a multiple of 2^-28 below 2^6, so that doubles compute exactly.

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "exactcsg/csg/prune.hpp"
#include "exactcsg/csg/text.hpp"
#include "exactcsg/csg/traverse.hpp"
#include "exactcsg/csg/tree.hpp"
#include "exactcsg/domain/point_class.hpp"
#include "exactcsg/gdt/cell.hpp"

namespace exactcsg::bench {

struct PlanarPoint {
  double x, y;
};

// {d (x^2 + y^2) + a x + b y + c <= 0}: a half-plane if d = 0, a disc if d = 1, the outside of one
// if d = -1.
struct PlanarHalfSpace {
  double a, b, c, d;

  double operator()(const PlanarPoint& p) const {
    return d * (p.x * p.x + p.y * p.y) + a * p.x + b * p.y + c;
  }
};

using Planar = csg::Tree<PlanarHalfSpace, csg::BooleanOperator>;
using PlanarCell = gdt::Cell<double, 2>;

inline PointClass classify(const PlanarHalfSpace& h, const PlanarPoint& p) {
  const double value = h(p);
  return value < 0 ? PointClass::In : value > 0 ? PointClass::Out : PointClass::On;
}

// The tables of the paper's section 3.2.
inline PointClass combine(PointClass a, csg::BooleanOperator op, PointClass b) {
  if (op == csg::BooleanOperator::Difference) b = complement(b);
  return op == csg::BooleanOperator::Union ? std::max(a, b) : std::min(a, b);
}

inline PointClass membership(const Planar& solid, const PlanarPoint& point) {
  return csg::traverse(
      solid, [point](const PlanarHalfSpace& h) { return classify(h, point); },
      [](PointClass a, csg::BooleanOperator op, PointClass b) { return combine(a, op, b); },
      csg::FullEmptyResult{PointClass::In, PointClass::Out});
}

// The extreme values of the polynomial over a cell: it is a sum of one function of x and one of y.
inline csg::Membership classify(const PlanarHalfSpace& h, const PlanarCell& cell) {
  const auto range = [&](double linear, std::size_t axis) {
    const double low = cell.lower[axis], high = cell.upper[axis];
    const double at_low = h.d * low * low + linear * low;
    const double at_high = h.d * high * high + linear * high;
    std::pair<double, double> result = std::minmax(at_low, at_high);
    const double turn = -linear / (2 * h.d);  // not a number for a line, and then nowhere
    if (low < turn && turn < high) {
      const double at_turn = h.d * turn * turn + linear * turn;
      result = {std::min(result.first, at_turn), std::max(result.second, at_turn)};
    }
    return result;
  };
  const auto [low_x, high_x] = range(h.a, 0);
  const auto [low_y, high_y] = range(h.b, 1);
  if (low_x + low_y + h.c >= 0) return csg::Membership::Out;
  return high_x + high_y + h.c <= 0 ? csg::Membership::In : csg::Membership::Unknown;
}

inline Planar rectangle(double x0, double y0, double x1, double y1) {
  const auto line = [](double a, double b, double c) { return Planar::primitive({a, b, c, 0}); };
  return csg::intersect(csg::intersect(line(-1, 0, x0), line(1, 0, -x1)),
                        csg::intersect(line(0, -1, y0), line(0, 1, -y1)));
}

inline Planar disc(double x, double y, double radius) {
  return Planar::primitive({-2 * x, -2 * y, x * x + y * y - radius * radius, 1});
}

inline Planar united(std::vector<Planar> parts) {
  while (parts.size() > 1) {
    std::vector<Planar> pairs;
    for (std::size_t i = 0; i + 1 < parts.size(); i += 2) {
      pairs.push_back(csg::unite(parts[i], parts[i + 1]));
    }
    if (parts.size() % 2 != 0) pairs.push_back(parts.back());
    parts = std::move(pairs);
  }
  return parts.front();
}

// Squares on a grid, four half-planes each; operators have two operands. REQUIRES count % 4 == 0
inline Planar squares(std::size_t count) {
  const std::size_t number = count / 4;
  constexpr std::size_t columns = 32;
  std::vector<Planar> parts;
  parts.reserve(number);
  for (std::size_t i = 0; i < number; ++i) {
    const double x = static_cast<double>(i % columns) / columns;
    const double y = static_cast<double>(i / columns % columns) / columns;
    parts.push_back(rectangle(x, y, x + 1.0 / 64, y + 1.0 / 64));
  }
  return united(std::move(parts));
}

// A plate of side 15/16 with its corners cut at 45 degrees by 1/16, less 5 x 5 round holes of
// radius 1/16, each with a boss of radius 1/32 left in it: lines and circles, 58 half-spaces.
inline Planar plate() {
  Planar result = rectangle(1.0 / 32, 1.0 / 32, 31.0 / 32, 31.0 / 32);
  for (const auto& [a, b] :
       std::array<std::pair<double, double>, 4>{{{1, 1}, {-1, 1}, {1, -1}, {-1, -1}}}) {
    // a (x - 1/2) + b (y - 1/2) <= 7/8: the corner of the square has 15/16.
    result = csg::intersect(result, Planar::primitive({a, b, -(a + b) / 2 - 7.0 / 8, 0}));
  }
  std::vector<Planar> rings;
  for (int i = 0; i < 25; ++i) {
    const double x = (2 + 3 * (i % 5)) / 16.0;
    const double y = (2 + 3 * (i / 5)) / 16.0;
    rings.push_back(csg::subtract(disc(x, y, 1.0 / 16), disc(x, y, 1.0 / 32)));
  }
  return csg::subtract(result, united(std::move(rings)));
}

// The square, less 4 corners (1/16)^2 / 2, less 25 rings.
inline double area_of_plate() {
  return 225.0 / 256 - 2.0 / 256 - 25 * std::acos(-1.0) * (1.0 / 256 - 1.0 / 1024);
}

inline std::string text_of(const Planar& tree) {
  return csg::to_text(tree, [](TextWriter& out, const PlanarHalfSpace& h) {
    for (const double value : {h.a, h.b, h.c, h.d}) {
      out.separate();
      out.write(value);
    }
  });
}

inline Planar tree_of(const std::string& text) {
  return csg::from_text(text, [](TextReader& in) {
    PlanarHalfSpace h{};
    for (double* value : {&h.a, &h.b, &h.c, &h.d}) *value = in.number<double>("a coefficient");
    return h;
  });
}

// A cell, and the solid as far as it matters there.
struct Local {
  PlanarCell cell;
  Planar solid;
  int depth = 0;
};

inline bool is_decided(const Local& local) {
  return local.solid.is_empty() || local.solid.is_full();
}

inline Local localised(const Local& local, std::size_t quadrant) {
  const PlanarCell cell = gdt::Orthants()(local.cell, gdt::NoLabel(), quadrant);
  return {cell,
          csg::prune(local.solid, [&](const PlanarHalfSpace& h) { return classify(h, cell); }),
          local.depth + 1};
}

inline std::array<Local, 4> quadrants(const Local& local) {
  return {localised(local, 0), localised(local, 1), localised(local, 2), localised(local, 3)};
}

inline double size_of(const PlanarCell& cell) {
  return (cell.upper[0] - cell.lower[0]) * (cell.upper[1] - cell.lower[1]);
}

// What follows is given to the operators as objects: a pointer to a function would not be inlined.

// A cell that is not decided counts as its middle.
inline constexpr auto area_of_leaf = [](const Local& local) -> double {
  if (local.solid.is_empty()) return 0;
  if (local.solid.is_full()) return size_of(local.cell);
  const PlanarPoint middle{(local.cell.lower[0] + local.cell.upper[0]) / 2,
                           (local.cell.lower[1] + local.cell.upper[1]) / 2};
  return membership(local.solid, middle) == PointClass::Out ? 0 : size_of(local.cell);
};

inline constexpr auto sum = [](std::span<const double> parts) {
  return parts[0] + parts[1] + parts[2] + parts[3];
};

}  // namespace exactcsg::bench
