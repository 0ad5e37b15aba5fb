// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Tori and what cuts leave of them, whose volumes, and the areas of most, have closed forms, each
// derived where it stands.

#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "exactcsg/domain/classify.hpp"
#include "exactcsg/measure/region_proof.hpp"
#include "measure/curved_solids.hpp"

namespace exactcsg::measure::test {

using domain::SurfaceHalfSpace;
using TorusSet = csg::BooleanTree<SurfaceHalfSpace>;

inline TorusSet set(SurfaceHalfSpace primitive) {
  return TorusSet::primitive(std::move(primitive));
}
// {normal . x <= bound}
inline TorusSet half_space(const Coordinates<3>& normal, const Rational& bound) {
  return set(domain::make_plane(normal, Rational(-bound)));
}
// Round the z axis.
inline domain::Torus ring_of(const Rational& major, const Rational& minor) {
  return domain::make_torus({{0, 0, 0}, {0, 0, 1}}, major, minor, minor);
}
inline domain::Torus unit_torus() { return ring_of(1, Rational(1, 2)); }

struct KnownTorus {
  std::string name;
  TorusSet set;
  Box<3> box;
  double volume;
  std::optional<double> area = std::nullopt;
};

// Of the torus of radii 5 and 2 beyond y = 3, where the section is a figure of eight; evaluated to
// 15 digits, see TorusVolume.TheGoldenValueOfTheFigureOfEight.
inline constexpr double beyond_saddle = 114.886320192829;

inline std::vector<KnownTorus> known_tori() {
  using std::numbers::pi;
  std::vector<KnownTorus> all;
  const Box<3> box(point(-8, -8, -4), point(8, 8, 4));
  const TorusSet ring = set(ring_of(5, 2));
  // Pappus: the disc's area times the length of its centre's way; and its circumference times that.
  // At the angle u round the tube the surface has the area 2 (5 + 2 cos u) 2 pi du: where sin u >=
  // 1/2, a third of the whole. In z = 1 is the ring between the radii 5 - sqrt 3 and 5 + sqrt 3.
  const double whole = 40 * pi * pi;
  const double annulus = 20 * std::numbers::sqrt3 * pi;
  all.push_back({"ring", ring, box, whole, whole});
  // The ring between rho = 5 - w and 5 + w, w^2 = 4 - z^2, has the area 20 pi w: the integral of w
  // from 1 to 2 is 2 pi / 3 - sqrt 3 / 2.
  const double above = 20 * pi * (2 * pi / 3 - std::numbers::sqrt3 / 2);
  all.push_back({"ring above 1", intersect(ring, half_space({0, 0, -1}, -1)), box, above,
                 whole / 3 + annulus});
  all.push_back({"ring below 1", intersect(ring, half_space({0, 0, 1}, 1)), box, whole - above,
                 2 * whole / 3 + annulus});
  // A plate of 16 x 16 x 2: its top and its bottom without a ring each, its sides, and what of the
  // torus is above and below.
  const TorusSet plate = csg::map(domain::make_block({point(-8, -8, -1), point(8, 8, 1)}),
                                  [](const HalfSpace<3>& h) { return SurfaceHalfSpace(h); });
  all.push_back({"ring in a plate", csg::unite(ring, plate),
                 Box<3>(point(-9, -9, -4), point(9, 9, 4)), 512 + 2 * above,
                 2 * (256 - annulus) + 128 + 2 * whole / 3});
  all.push_back({"ring beyond 3", intersect(ring, half_space({0, -1, 0}, -3)), box, beyond_saddle});
  all.push_back(
      {"ring up to 3", intersect(ring, half_space({0, 1, 0}, 3)), box, whole - beyond_saddle});
  // Pappus again, of the ellipse of semi-axes 1 and 3/2, round a slanted axis. Its circumference is
  // 4 * 3/2 E(k), k^2 = 1 - 4/9.
  all.push_back({"slanted elliptic torus",
                 set(domain::make_torus({{0, 0, 0}, {1, 2, 2}}, 3, 1, Rational(3, 2))), cube(6),
                 9 * pi * pi, 36 * pi * std::comp_ellint_2(std::sqrt(5.0) / 3)});
  // The integral of 4 pi rho sqrt(4 - (rho - 1)^2) from 0 to 3; of 4 pi (1 + 2 cos u) where that is
  // not negative, up to u = 2 pi / 3 on both sides.
  all.push_back({"spindle", set(ring_of(1, 2)), cube(4),
                 4 * pi * (4 * pi / 3 + 1.5 * std::numbers::sqrt3),
                 8 * pi * (2 * pi / 3 + std::numbers::sqrt3)});
  return all;
}

}  // namespace exactcsg::measure::test
