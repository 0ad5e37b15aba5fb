// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Surface cards: what "-n" says of them, in surfaces of the kinds that OpenMC has. [Exact]
//
// P, PX, PY, PZ; SO, S, SX, SY, SZ; C/X to CZ; K/X to KZ; SQ, GQ; TX, TY, TZ; X, Y, Z (points of a
// surface of revolution); bodies BOX, RPP, SPH, RCC, RHP and HEX, REC, TRC, ELL, WED, ARB.
// LAW surface_card.1  a point has negative sense where the card's equation is below 0, of a body
//                     inside it. Planes through three points have the origin at their negative
//                     side; those through the origin have (0, 0, oo) at their positive side, or
//                     else (0, oo, 0), or else (oo, 0, 0). Of X, Y and Z with several points, what
//                     is far from the axis is positive.
// LAW surface_card.2  facets are numbered as the manual says: BOX, RHP: the end of the first
// vector,
//                     opposite, ...; RPP: xmax, xmin, ymax, ...; RCC, REC, TRC: round, end of h,
//                     base; WED: slant, (b, h), (a, h), top, base; ARB: as on the card.
// LAW surface_card.3  make_body(transformed) is moved(map, make_body): the image has the same sides
//                     and facets.

#include <vector>

#include "exactcsg/csg/tree.hpp"
#include "exactcsg/io/mcnp/deck.hpp"
#include "exactcsg/io/openmc/model.hpp"

namespace exactcsg::io::mcnp {

// A surface of one of OpenMC's types.
struct Shape {
  std::string type;
  std::vector<Rational> coefficients;
  bool is_auxiliary = false;  // cuts off the other sheet of a cone: no boundary condition
};

struct ShapeSide {
  std::uint32_t shape = 0;
  bool is_positive = false;
  friend bool operator==(const ShapeSide&, const ShapeSide&) = default;
};

struct Body {
  std::vector<Shape> shapes;
  csg::BooleanTree<ShapeSide> negative;          // what "-n" says
  std::vector<std::optional<ShapeSide>> facets;  // what "-n.m" says; nullopt: refused
  bool is_macrobody = false;
};

struct SurfaceCard {
  openmc::Id number = 0;
  openmc::Boundary boundary = openmc::Boundary::Transmission;
  std::optional<Word> transformation;  // the number of a TRn card
  std::optional<Word> partner;         // of a periodic surface
  Body body;                           // in the auxiliary system, if it has a transformation
  bool is_plane() const;
};

// THROWS Error(UnknownNode | UnsupportedNode | WrongCount | BadArgument | DegenerateSurface |
// MissingValue | NonPlanarFacet | NotConvex), and those of numbers
SurfaceCard read_surface_card(const Card& card, std::vector<Warning>& warnings);

// The image. nullopt: a torus whose axis would be along none of x, y and z.
// REQUIRES an orthogonal linear part
std::optional<Body> moved(const AffineMap& map, const Body& body);

}  // namespace exactcsg::io::mcnp
