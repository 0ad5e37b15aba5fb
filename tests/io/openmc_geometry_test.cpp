// SPDX-License-Identifier: GPL-3.0-or-later
// OpenMC geometries: surfaces, regions, lattices and the places of points, against values worked
// out by hand from the format's description, brute force, and the laws of the headers.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "exactcsg/csg/membership.hpp"
#include "exactcsg/domain/classify.hpp"
#include "exactcsg/io/openmc/lattices.hpp"
#include "exactcsg/io/openmc/point_location.hpp"
#include "exactcsg/io/openmc/surfaces.hpp"

namespace exactcsg::io::openmc {
namespace {

using csg::Membership;
using testing::ElementsAre;

Rational decimal(const char* text) { return *parse_rational(text); }

Model read(const std::string& body) {
  return read_geometry("<geometry>" + body + "</geometry>", "geometry.xml");
}
Surface surface(const std::string& type, const std::string& coefficients) {
  return read("<surface id=\"1\" type=\"" + type + "\" coeffs=\"" + coefficients +
              "\"/><cell id=\"1\" material=\"void\"/>")
      .surfaces.front();
}
PointClass class_at(const Surface& of, const Rational& x, const Rational& y, const Rational& z) {
  return domain::classify(of.negative, Point(x, y, z));
}

// --- surfaces: f < 0, f = 0, f > 0 by hand from the format's equations

struct SurfaceCase {
  const char* type;
  const char* coefficients;
  std::array<int, 3> in, on, out;
};
const SurfaceCase surface_cases[] = {
    {"plane", "1 2 3 6", {0, 0, 0}, {1, 1, 1}, {2, 2, 2}},
    {"plane", "-1 0 0 -3", {4, 0, 0}, {3, 5, 5}, {2, 0, 0}},
    {"x-plane", "2", {1, 9, 9}, {2, 9, 9}, {3, 9, 9}},
    {"y-plane", "2", {9, 1, 9}, {9, 2, 9}, {9, 3, 9}},
    {"Z-Plane", " 2 ", {9, 9, 1}, {9, 9, 2}, {9, 9, 3}},
    {"sphere", "1 2 3 5", {1, 2, 3}, {1, 5, 7}, {1, 6, 7}},
    {"x-cylinder", "1 2 5", {99, 1, 2}, {99, 4, 6}, {99, 5, 6}},
    {"y-cylinder", "1 2 5", {1, 99, 2}, {4, 99, 6}, {5, 99, 6}},
    {"z-cylinder", "1 2 5", {1, 2, 99}, {4, 6, 99}, {5, 6, 99}},
    // Both nappes; the slope squared is 4: radius 2 h at a distance h from the apex.
    {"x-cone", "1 2 3 4", {3, 5, 3}, {3, 6, 3}, {3, 7, 3}},
    {"x-cone", "1 2 3 4", {-1, 5, 3}, {-1, 6, 3}, {-1, 7, 3}},
    {"y-cone", "1 2 3 4", {4, 4, 3}, {5, 4, 3}, {6, 4, 3}},
    {"z-cone", "1 2 3 4", {4, 2, 1}, {5, 2, 1}, {6, 2, 1}},
    // x^2 + 2 y^2 + 3 z^2 + xy + yz + xz - x - y - z - 12 at (1, 1, 1): 1+2+3+1+1+1-3-12 = -6;
    // at (2, 1, 1): 4+2+3+2+1+2-4-12 = -2; at (1, 2, 1): 1+8+3+2+2+1-4-12 = 1;
    // at (3, 0, 1): 9+0+3+0+0+3-4-12 = -1; at (4, 0, 0): 16-4-12 = 0.
    {"quadric", "1 2 3 1 1 1 -1 -1 -1 -12", {2, 1, 1}, {4, 0, 0}, {1, 2, 1}},
    // The order of the mixed coefficients: xy, yz, xz.
    {"quadric", "0 0 0 1 0 0 0 0 0 -1", {0, 1, 9}, {1, 1, 9}, {2, 2, 0}},
    {"quadric", "0 0 0 0 1 0 0 0 0 -1", {9, 0, 1}, {9, 1, 1}, {0, 2, 2}},
    {"quadric", "0 0 0 0 0 1 0 0 0 -1", {0, 9, 1}, {1, 9, 1}, {2, 0, 2}},
    // (rho - 5)^2 / C^2 + (axial)^2 / B^2 = 1 round (1, 2, 3), with B along the axis: 3, C = 2.
    {"z-torus", "1 2 3 5 3 2", {6, 2, 5}, {6, 2, 6}, {6, 2, 7}},
    {"z-torus", "1 2 3 5 3 2", {5, 2, 3}, {4, 2, 3}, {3, 2, 3}},
    {"z-torus", "1 2 3 5 3 2", {4, 6, 3}, {4, 6, 0}, {1, 2, 3}},
    {"x-torus", "1 2 3 5 3 2", {3, 7, 3}, {4, 7, 3}, {5, 7, 3}},
    {"x-torus", "1 2 3 5 3 2", {1, 8, 3}, {1, 9, 3}, {1, 10, 3}},
    {"y-torus", "1 2 3 5 3 2", {6, 4, 3}, {6, 5, 3}, {6, 6, 3}},
    {"y-torus", "1 2 3 5 3 2", {1, 2, 9}, {1, 2, 10}, {1, 2, 11}},
    // A spindle: the lemon is inside. An ellipsoid, without a major radius.
    {"z-torus", "0 0 0 1 3 3", {0, 0, 0}, {4, 0, 0}, {5, 0, 0}},
    {"z-torus", "1 2 3 0 3 2", {1, 2, 5}, {1, 2, 6}, {4, 2, 3}},
};

TEST(OpenMcSurfaces, HaveTheSignsOfTheirEquations) {
  for (const SurfaceCase& c : surface_cases) {
    const Surface s = surface(c.type, c.coefficients);
    EXPECT_EQ(class_at(s, c.in[0], c.in[1], c.in[2]), PointClass::In) << c.type;
    EXPECT_EQ(class_at(s, c.on[0], c.on[1], c.on[2]), PointClass::On) << c.type;
    EXPECT_EQ(class_at(s, c.out[0], c.out[1], c.out[2]), PointClass::Out) << c.type;
  }
}

// 0.1 + 0.2 is 0.3 here; in doubles the sphere overlaps the plane by 2^-55.
TEST(OpenMcSurfaces, DecimalsMeanThemselves) {
  const Surface sphere = surface("sphere", "0.1 0 0 0.2");
  const Surface plane = surface("x-plane", "3.0e-1");
  EXPECT_EQ(class_at(sphere, decimal("0.3"), 0, 0), PointClass::On);
  EXPECT_EQ(class_at(plane, decimal("0.3"), 0, 0), PointClass::On);
}

TEST(OpenMcSurfaces, KeepWhatTheFileSays) {
  const Model model = read(
      "<surface><id> 7 </id><name>outer wall</name><type>X-Plane</type><coeffs>-1.5</coeffs>"
      "<boundary> Vacuum </boundary></surface><cell id='1' material='void'/>");
  const Surface& s = model.surfaces.front();
  EXPECT_EQ(s.id, 7);
  EXPECT_EQ(s.name, "outer wall");
  EXPECT_EQ(s.type, "x-plane");
  EXPECT_EQ(s.boundary, Boundary::Vacuum);
  EXPECT_THAT(s.coefficients, ElementsAre(Rational(-3, 2)));
  EXPECT_EQ(s.position.line, 1U);
  EXPECT_EQ(s.position.column, 11U);
}

TEST(OpenMcSurfaces, AnAttributeWinsOverAnElement) {
  const Model model = read(
      "<surface id='1' type='x-plane' coeffs='1'><coeffs>2</coeffs></surface>"
      "<cell id='1' material='void'/>");
  EXPECT_THAT(model.surfaces.front().coefficients, ElementsAre(1));
}

// By the values of f at some points: those that change sign somewhere, against squares and sums of
// squares, which do not.
TEST(OpenMcSurfaces, DegenerateQuadricsAreThoseOfOneSign) {
  using domain::LinearForm;
  const auto form = [](int x, int y, int z, int c) { return LinearForm<3>{{x, y, z}, c}; };
  const domain::Quadric<3> square = domain::product(form(1, 2, 3, 4), form(1, 2, 3, 4));
  const domain::Quadric<3> another = domain::product(form(0, 1, -1, 2), form(0, 1, -1, 2));
  const domain::Quadric<3> one(LinearForm<3>{{}, 1});
  EXPECT_FALSE(takes_both_signs(square));
  EXPECT_FALSE(takes_both_signs(square + another));
  EXPECT_FALSE(takes_both_signs(square + another + one));
  EXPECT_FALSE(takes_both_signs(Rational(-1) * square));
  EXPECT_FALSE(takes_both_signs(one));
  EXPECT_TRUE(takes_both_signs(square + Rational(-1) * one));
  EXPECT_TRUE(takes_both_signs(square + Rational(-1) * another));
  EXPECT_TRUE(takes_both_signs(domain::product(form(1, 2, 3, 4), form(0, 1, -1, 2))));
  EXPECT_TRUE(takes_both_signs(domain::Quadric<3>(form(0, 0, 1, 5))));
}

// --- regions

Region region(const std::string& text, int surfaces = 4) {
  std::string body;
  for (int i = 1; i <= surfaces; ++i) {
    body += "<surface id='" + std::to_string(i) + "' type='x-plane' coeffs='0'/>";
  }
  return read(body + "<cell id='1' material='void' region='" + text + "'/>").cells.front().region;
}

// Bit i: the point is on the positive side of surface i + 1.
bool holds(const Region& of, unsigned point) {
  return csg::membership_of(of, [&](const SurfaceSide& side) {
           return ((point >> side.surface & 1U) != 0) == side.is_positive ? Membership::In
                                                                          : Membership::Out;
         }) == Membership::In;
}

// "-n" is negative, "n" and "+n" positive; ~ binds more strongly than a blank, that more than |.
TEST(OpenMcRegions, MeanWhatTheDocumentationSays) {
  for (unsigned p = 0; p < 16; ++p) {
    const bool a = (p & 1U) != 0;
    const bool b = (p & 2U) != 0;
    const bool c = (p & 4U) != 0;
    const bool d = (p & 8U) != 0;
    EXPECT_EQ(holds(region("1"), p), a);
    EXPECT_EQ(holds(region("+1"), p), a);
    EXPECT_EQ(holds(region("-1"), p), !a);
    EXPECT_EQ(holds(region("1 2 | 3"), p), (a && b) || c);
    EXPECT_EQ(holds(region("3 | 1 2"), p), (a && b) || c);
    EXPECT_EQ(holds(region("1-2|3"), p), (a && !b) || c);
    EXPECT_EQ(holds(region("~(1 2 | 3)"), p), !((a && b) || c));
    EXPECT_EQ(holds(region("~1 2"), p), !a && b);
    EXPECT_EQ(holds(region("~~1"), p), a);
    EXPECT_EQ(holds(region("~(1|2)-3"), p), !(a || b) && !c);
    EXPECT_EQ(holds(region("(1)(2)"), p), a && b);
    EXPECT_EQ(holds(region("(1 | 2) (3 | ~(4 -1))"), p), (a || b) && (c || !(d && !a)));
    EXPECT_EQ(holds(region(" "), p), true);
  }
}

struct Expression {
  std::string text;
  std::vector<bool> values;  // at the 16 points
  int strength = 3;          // of its outermost operator: | 0, blank 1, ~ 2
};

Expression random_expression(int depth) {
  const auto of = [&](int least) {
    Expression e = random_expression(depth - 1);
    if (e.strength < least || *rc::gen::inRange(0, 4) == 0) {
      e.text = "(" + e.text + ")";
      e.strength = 3;
    }
    return e;
  };
  const int kind = depth == 0 ? 0 : *rc::gen::inRange(0, 4);
  Expression result;
  if (kind == 0) {
    const unsigned surface = *rc::gen::inRange(0U, 4U);
    const bool is_positive = *rc::gen::arbitrary<bool>();
    result.text = (is_positive ? *rc::gen::element<std::string>("", "+") : std::string("-")) +
                  std::to_string(surface + 1);
    for (unsigned p = 0; p < 16; ++p) {
      result.values.push_back(((p >> surface & 1U) != 0) == is_positive);
    }
    return result;
  }
  Expression a = of(kind == 1 ? 0 : kind == 2 ? 1 : 2);
  if (kind == 3) {
    result = {"~" + a.text, a.values, 2};
    result.values.flip();
    return result;
  }
  const Expression b = of(kind == 1 ? 0 : 1);
  result = a;
  result.strength = kind - 1;
  result.text += kind == 1 ? *rc::gen::element<std::string>("|", " | ", "\n|") : std::string(" ");
  result.text += b.text;
  for (std::size_t p = 0; p < 16; ++p) {
    result.values[p] = kind == 1 ? a.values[p] || b.values[p] : a.values[p] && b.values[p];
  }
  return result;
}

RC_GTEST_PROP(OpenMcRegions, RandomOnesMeanWhatTheyWereMadeOf, ()) {
  const Expression expression = random_expression(*rc::gen::inRange(0, 6));
  const Region read_back = region(expression.text);
  for (unsigned p = 0; p < 16; ++p) RC_ASSERT(holds(read_back, p) == expression.values[p]);
}

TEST(OpenMcRegions, AMillionDeep) {
  constexpr std::size_t depth = 1'000'000;
  const Region plain = region(std::string(depth, '(') + "-1" + std::string(depth, ')'));
  EXPECT_TRUE(plain.is_primitive());
  std::string nested;
  for (std::size_t i = 0; i < depth; ++i) nested += "~(1 ";
  nested += "-1" + std::string(depth, ')');
  const Region deep = region(nested);
  EXPECT_GE(deep.node_count(), depth);
  // Innermost: 1 and -1 is nothing; then ~(1 and x) by turns: -1 or not x, at 1 the other value.
  EXPECT_EQ(holds(deep, 0), true);
  EXPECT_EQ(holds(deep, 1), false);
  EXPECT_TRUE(region(std::string(depth, '~') + "1").is_primitive());
}

// --- lattices

std::string pin_universes(int count) {
  std::string text;
  for (int i = 1; i <= count; ++i) {
    const std::string n = std::to_string(i);
    text += "<cell id='" + n + "' universe='" + n + "' material='" + n + "'/>";
  }
  return text;
}

// The material at a point, and 0 where there is none.
int material_at(const Model& model, const Rational& x, const Rational& y, const Rational& z) {
  const Location location = locate(model, Point(x, y, z));
  if (location.verdict != PointVerdict::InCell) return 0;
  return model.cells[location.cells.front()].materials.front().value_or(-1);
}

// Two rows of three in two layers: the first row has the highest y, the first layer the lowest z.
TEST(OpenMcLattices, RectangularOrder) {
  const Model model = read(pin_universes(12) +
                           "<cell id='20' fill='5000'/><lattice id='5000' dimension='3 2 2' "
                           "lower_left='-3 -2 10' pitch='2 2 5'><universes>1 2 3 4 5 6\n"
                           "7 8 9 10 11 12</universes></lattice>");
  EXPECT_EQ(material_at(model, -2, 1, 11), 1);
  EXPECT_EQ(material_at(model, 2, 1, 11), 3);
  EXPECT_EQ(material_at(model, -2, -1, 11), 4);
  EXPECT_EQ(material_at(model, 2, -1, 11), 6);
  EXPECT_EQ(material_at(model, -2, 1, 16), 7);
  EXPECT_EQ(material_at(model, 2, -1, 19), 12);
  EXPECT_EQ(locate(model, Point(0, 3, 11)).verdict, PointVerdict::InGap);
  EXPECT_EQ(locate(model, Point(1, 1, 11)).verdict, PointVerdict::OnBoundary);
  EXPECT_EQ(locate(model, Point(0, 2, 11)).verdict, PointVerdict::OnBoundary);
  EXPECT_EQ(locate(model, Point(0, 1, 20)).verdict, PointVerdict::OnBoundary);
  EXPECT_EQ(locate(model, Point(0, 4, 11)).verdict, PointVerdict::InGap);
}

// The local origin is the element's centre, also outside, where the grid goes on; z is left alone.
TEST(OpenMcLattices, LocalCoordinatesAndOuter) {
  const Model model = read(
      "<surface id='1' type='sphere' coeffs='0 0 3 0.5'/>"
      "<cell id='1' universe='1' material='1' region='-1'/>"
      "<cell id='2' universe='1' material='2' region='1'/>"
      "<cell id='20' fill='7'/><lattice id='7' dimension='2 1' lower_left='0 0' pitch='2 2' "
      "universes='1 1' outer='1'/>");
  for (const int x : {-9, -1, 1, 3, 5, 101}) {
    EXPECT_EQ(material_at(model, x, 1, 3), 1) << x;
    EXPECT_EQ(material_at(model, x, 1, 0), 2) << x;
    EXPECT_EQ(material_at(model, x, 9, 3), 1) << x;
  }
  const Location outside = locate(model, Point(-9, 1, 3));
  ASSERT_EQ(outside.path.size(), 5U);
  EXPECT_EQ(outside.path[2].kind, StepKind::Lattice);
  EXPECT_FALSE(outside.path[2].element);
}

Model hexagons(const std::string& orientation, const std::string& universes, int rings) {
  const int count = 3 * rings * (rings - 1) + 1;
  return read(pin_universes(count) + "<cell id='500' fill='900'/><hex_lattice id='900' n_rings='" +
              std::to_string(rings) + "' orientation='" + orientation +
              "' center='0 0' pitch='2'><universes>" + universes + "</universes></hex_lattice>");
}

// Pitch 2. Orientation y, two rings: rows of 1, 2, 1, 2, 1 from the top; centres at (0, +-2), and
// at (+-1.73, +-1). Orientation x: rows of 2, 3, 2; centres at (+-2, 0) and (+-1, +-1.73).
TEST(OpenMcLattices, HexagonalOrder) {
  const Model y = hexagons("y", "1\n2 3\n4\n5 6\n7", 2);
  const Rational s = decimal("1.73");
  EXPECT_EQ(material_at(y, 0, 2, 0), 1);
  EXPECT_EQ(material_at(y, -s, 1, 0), 2);
  EXPECT_EQ(material_at(y, s, 1, 0), 3);
  EXPECT_EQ(material_at(y, 0, 0, 0), 4);
  EXPECT_EQ(material_at(y, -s, -1, 0), 5);
  EXPECT_EQ(material_at(y, s, -1, 0), 6);
  EXPECT_EQ(material_at(y, 0, -2, 0), 7);
  EXPECT_EQ(locate(y, Point(0, 1, 0)).verdict, PointVerdict::OnBoundary);
  EXPECT_EQ(locate(y, Point(0, 3, 0)).verdict, PointVerdict::OnBoundary);
  EXPECT_EQ(locate(y, Point(0, decimal("3.001"), 0)).verdict, PointVerdict::InGap);
  EXPECT_EQ(locate(y, Point(0, 5, 0)).verdict, PointVerdict::InGap);
  const Model x = hexagons("x", "1 2\n3 4 5\n6 7", 2);
  EXPECT_EQ(material_at(x, -1, s, 0), 1);
  EXPECT_EQ(material_at(x, 1, s, 0), 2);
  EXPECT_EQ(material_at(x, -2, 0, 0), 3);
  EXPECT_EQ(material_at(x, 0, 0, 0), 4);
  EXPECT_EQ(material_at(x, 2, 0, 0), 5);
  EXPECT_EQ(material_at(x, -1, -s, 0), 6);
  EXPECT_EQ(material_at(x, 1, -s, 0), 7);
}

// Layers of two numbers: the lowest first, the centre at half the height.
TEST(OpenMcLattices, HexagonalLayers) {
  const Model model =
      read(pin_universes(3) +
           "<cell id='500' fill='900'/><hex_lattice id='900' n_rings='1' n_axial='3' "
           "center='0 0 10' pitch='2 4' universes='1 2 3'/>");
  EXPECT_EQ(material_at(model, 0, 0, 5), 1);
  EXPECT_EQ(material_at(model, 0, 0, 9), 2);
  EXPECT_EQ(material_at(model, 0, 0, 15), 3);
  EXPECT_EQ(material_at(model, 0, 0, 17), 0);
  EXPECT_EQ(locate(model, Point(0, 0, 8)).verdict, PointVerdict::OnBoundary);
}

// Every element's centre is in it, at the local origin; and a point is in the element whose centre
// is nearest, by brute force in doubles where these can tell.
RC_GTEST_PROP(OpenMcLattices, PointsAreInTheNearestElement, ()) {
  Lattice lattice;
  lattice.kind = *rc::gen::element(LatticeKind::HexagonalX, LatticeKind::HexagonalY);
  lattice.rings = *rc::gen::inRange(1, 6);
  lattice.layers = *rc::gen::inRange(1, 4);
  lattice.has_layers = true;
  lattice.origin = {Rational(1, 3), -2, 5};
  lattice.pitch = {Rational(7, 5), Rational(7, 5), 3};
  std::vector<std::array<std::int64_t, 3>> elements;
  for (std::int64_t layer = 0; layer < lattice.layers; ++layer) {
    for (std::int64_t i = 1 - lattice.rings; i < lattice.rings; ++i) {
      for (std::int64_t a = 1 - lattice.rings; a < lattice.rings; ++a) {
        if (std::abs(i + a) < lattice.rings) elements.push_back({i, a, layer});
      }
    }
  }
  lattice.elements.assign(elements.size(), 0);
  std::vector<bool> seen(elements.size(), false);
  for (const auto& element : elements) {
    const std::size_t index = element_index(lattice, element);
    RC_ASSERT(index < elements.size());
    RC_ASSERT(!seen[index]);
    seen[index] = true;
    const LatticePlace place = place_in(lattice, Point(centre_of(lattice, element)));
    RC_ASSERT(place.element == element);
    RC_ASSERT(place.local == Point(0, 0, 0));
    RC_ASSERT(!place.is_on_boundary);
  }
  const Point point(Rational(*rc::gen::inRange(-8000, 8000), 1001),
                    Rational(*rc::gen::inRange(-8000, 8000), 1003),
                    Rational(*rc::gen::inRange(-1000, 9000), 997));
  double nearest = 1e9;
  double second = 1e9;
  std::array<std::int64_t, 3> winner{};
  for (const auto& element : elements) {
    const domain::Coordinates<3> centre = centre_of(lattice, element);
    const auto along = [&](std::size_t i) { return nearest_double(point[i] - centre[i]); };
    if (std::abs(along(2)) > 1.5) continue;
    const double distance = std::hypot(along(0), along(1));
    if (distance < nearest) {
      second = nearest;
      nearest = distance;
      winner = element;
    } else {
      second = std::min(second, distance);
    }
  }
  const LatticePlace place = place_in(lattice, point);
  if (place.element && second > nearest + 1e-9) RC_ASSERT(*place.element == winner);
  // Within the circle that a hexagon contains it is an element's for certain, beyond that round a
  // hexagon it is not.
  if (nearest < 0.699) RC_ASSERT(place.element.has_value());
  if (nearest > 0.81) RC_ASSERT(!place.element.has_value());
}

// --- transforms

// local = R^T (global - translation); a quarter turn about z takes x to y: exact.
TEST(OpenMcTransforms, TranslationAndQuarterTurn) {
  const Model model = read(
      "<surface id='1' type='sphere' coeffs='5 0 0 1'/>"
      "<cell id='1' universe='1' material='1' region='-1'/>"
      "<cell id='2' universe='1' material='2' region='1'/>"
      "<cell id='3' fill='1' translation='10 20 30' rotation='0 0 90'/>");
  EXPECT_EQ(material_at(model, 10, 25, 30), 1);
  EXPECT_EQ(material_at(model, 15, 20, 30), 2);
  EXPECT_EQ(locate(model, Point(10, 26, 30)).verdict, PointVerdict::OnBoundary);
  EXPECT_FALSE(model.cells[2].has_rounded_rotation);
}

// psi about z after theta about y after phi about x: e_x -> (phi) e_x -> (theta = 90) -e_z ->
// (psi) -e_z. And e_y -> (phi = 90) e_z -> (theta = 90) e_x -> (psi = 90) e_y.
TEST(OpenMcTransforms, OrderOfAngles) {
  const Model model = read(
      "<surface id='1' type='sphere' coeffs='5 0 0 1'/><surface id='2' type='sphere' coeffs='0 5 0 "
      "1'/><cell id='1' universe='1' material='1' region='-1'/>"
      "<cell id='2' universe='1' material='2' region='-2'/>"
      "<cell id='3' universe='1' material='3' region='1 2'/>"
      "<cell id='4' fill='1' rotation='90 90 90'/>");
  EXPECT_EQ(material_at(model, 0, 0, -5), 1);
  EXPECT_EQ(material_at(model, 0, 5, 0), 2);
}

TEST(OpenMcTransforms, NineNumbersAreTheMatrixFromGlobalToLocal) {
  const Model model = read(
      "<surface id='1' type='sphere' coeffs='5 0 0 1'/>"
      "<cell id='1' universe='1' material='1' region='-1'/>"
      "<cell id='2' universe='1' material='2' region='1'/>"
      "<cell id='3' fill='1' rotation='0 1 0 -1 0 0 0 0 1'/>");
  EXPECT_EQ(material_at(model, 0, 5, 0), 1);
}

TEST(OpenMcTransforms, RoundedAnglesSayTheyAre) {
  const Model model =
      read("<cell id='1' universe='1' material='1'/><cell id='3' fill='1' rotation='0 0 30'/>");
  EXPECT_TRUE(model.cells[1].has_rounded_rotation);
}

// --- verdicts

TEST(OpenMcLocation, OverlapGapAndBoundary) {
  const Model model = read(
      "<surface id='1' type='sphere' coeffs='0 0 0 2'/><surface id='2' type='sphere' coeffs='3 0 0 "
      "2'/><cell id='1' material='1' region='-1'/><cell id='2' material='2' region='-2'/>");
  const auto at = [&](const char* x) { return locate(model, Point(decimal(x), 0, 0)); };
  EXPECT_EQ(at("0").verdict, PointVerdict::InCell);
  EXPECT_THAT(at("0").cells, ElementsAre(0));
  EXPECT_EQ(at("1.5").verdict, PointVerdict::InOverlap);
  EXPECT_THAT(at("1.5").cells, ElementsAre(0, 1));
  EXPECT_EQ(at("9").verdict, PointVerdict::InGap);
  EXPECT_EQ(at("5").verdict, PointVerdict::OnBoundary);
  EXPECT_THAT(at("5").cells, ElementsAre(1));
  EXPECT_THAT(at("2").cells, ElementsAre(0, 1));
}

// A cell that is a union of two halves has no boundary where they meet.
TEST(OpenMcLocation, TheSeamOfAUnionIsInside) {
  const Model model = read(
      "<surface id='1' type='x-plane' coeffs='0'/><cell id='1' material='1' region='-1 | 1'/>");
  EXPECT_EQ(material_at(model, 0, 0, 0), 1);
}

TEST(OpenMcLocation, ThePathGoesThroughUniversesAndLattices) {
  const Model model = read(
      "<surface id='1' type='z-cylinder' coeffs='0 0 0.4'/>"
      "<cell id='10' universe='3' material='1' region='-1'/>"
      "<cell id='11' universe='3' material='2' region='1'/>"
      "<cell id='20' universe='0' fill='7'/>"
      "<lattice id='7' dimension='2 2' lower_left='-1 -1' pitch='1 1' universes='3 3 3 3'/>");
  const Location location = locate(model, Point(Rational(1, 2), Rational(-1, 2), 0));
  EXPECT_EQ(location.verdict, PointVerdict::InCell);
  EXPECT_THAT(
      location.path,
      ElementsAre(Step{StepKind::Universe, 1, std::nullopt}, Step{StepKind::Cell, 2, std::nullopt},
                  Step{StepKind::Lattice, 0, std::array<std::int64_t, 3>{1, 0, 0}},
                  Step{StepKind::Universe, 0, std::nullopt},
                  Step{StepKind::Cell, 0, std::nullopt}));
}

TEST(OpenMcLocation, UniversesNestedAHundredThousandDeep) {
  constexpr int depth = 100'000;
  std::string body = "<cell id='1' universe='1' material='1'/>";
  for (int i = 2; i <= depth; ++i) {
    body += "<cell id='" + std::to_string(i) + "' universe='" + std::to_string(i) + "' fill='" +
            std::to_string(i - 1) + "'/>";
  }
  EXPECT_EQ(locate(read(body), Point(0, 0, 0)).path.size(), 2U * depth);
}

// LAW location.5, on many spheres that touch, overlap and leave gaps, points on walls included.
RC_GTEST_PROP(OpenMcLocation, TheIndexAnswersAsAllCellsDo, ()) {
  std::string body;
  std::string outside;
  const int count = *rc::gen::inRange(1, 40);
  for (int i = 1; i <= count; ++i) {
    const std::string id = std::to_string(i);
    const auto coordinate = [&] { return std::to_string(*rc::gen::inRange(-6, 7)); };
    const std::string centre = coordinate() + " " + coordinate() + " " + coordinate() + " ";
    body += "<surface id='" + id + "' type='sphere' coeffs='" + centre +
            *rc::gen::element<std::string>("1", "0.5", "2") + "'/><cell id='" + id +
            "' material='1' region='-" + id + "'/>";
    outside += " " + id;
  }
  body += "<surface id='100' type='z-plane' coeffs='7'/><cell id='100' material='2' region='-100" +
          outside + "'/>";
  const Model model = read(body);
  const PointLocator locator(model);
  for (int k = 0; k < 50; ++k) {
    const auto coordinate = [&] { return Rational(*rc::gen::inRange(-20, 21), 2); };
    const Point point(coordinate(), coordinate(), coordinate());
    std::optional<Location> expected;
    try {
      expected = locate(model, point);
    } catch (const Error& error) {
      RC_ASSERT(error.id() == ErrorId::UndecidedNeighbourhood);
    }
    if (expected) RC_ASSERT(locator(point) == *expected);
  }
}

// A sector of a ring in a vessel of nested tori round three axes: an index is built (more than
// twelve surfaces), and points are in the cells that their distances from the circles say.
TEST(OpenMcLocation, OfTori) {
  std::string body;
  const std::array<const char*, 3> kinds{"x-torus", "y-torus", "z-torus"};
  std::string outside;
  for (int i = 0; i < 3; ++i) {
    for (int layer = 1; layer <= 5; ++layer) {
      const std::string id = std::to_string(10 * i + layer);
      const std::string radius = "0." + std::to_string(layer);
      body += "<surface id='" + id + "' type='" + kinds[static_cast<std::size_t>(i)] +
              "' coeffs='0 0 " + std::to_string(8 * i) + " 2 " + radius + " " + radius + "'/>";
      body += "<cell id='" + id + "' material='1' region='-" + id;
      if (layer > 1) body += " " + std::to_string(10 * i + layer - 1);
      body += "'/>";
      if (layer == 5) outside += " " + id;
    }
  }
  body += "<cell id='100' material='2' region='" + outside + "'/>";
  const Model model = read(body);
  const PointLocator locator(model);
  int inside = 0;
  std::mt19937_64 engine(3);
  std::uniform_int_distribution<int> number(-3000, 3000);
  const auto coordinate = [&] { return Rational(Rational(number(engine)) / 1000); };
  for (int k = 0; k < 3000; ++k) {
    const int i = k % 3;
    const std::array<Rational, 3> local{coordinate(), coordinate(), coordinate()};
    const Point point(local[0], local[1], Rational(local[2] + 8 * i));
    double along = 0;
    double square = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double x = nearest_double(local[static_cast<std::size_t>(axis)]);
      (axis == i ? along : square) += axis == i ? x : x * x;
    }
    const double distance = std::hypot(std::sqrt(square) - 2, along);
    const int layer = static_cast<int>(distance * 10) + 1;
    if (std::abs(distance * 10 - std::round(distance * 10)) < 1e-9) continue;
    const Location found = locator(point);
    ASSERT_EQ(found.verdict, PointVerdict::InCell);
    ASSERT_EQ(model.cells[found.cells.front()].id, layer <= 5 ? 10 * i + layer : 100);
    ASSERT_EQ(found, locate(model, point));
    inside += layer <= 5 ? 1 : 0;
  }
  EXPECT_GT(inside, 50);
}

// --- the file

TEST(OpenMcFiles, AModelFileHoldsAGeometry) {
  const Model model = read_geometry(
      "\xEF\xBB\xBF<?xml version='1.0' encoding='utf-8'?>\n<model>\n<materials><material "
      "id='3'/></materials><settings><batches>5</batches></settings>\n<geometry>\r\n"
      "<cell id='1' material='3'/></geometry></model>\r\n",
      "model.xml");
  EXPECT_EQ(model.cells.size(), 1U);
  EXPECT_EQ(model.name, "model.xml");
  EXPECT_EQ(model.cells.front().position.line, 5U);
}

TEST(OpenMcFiles, WhatIsNotReadIsSaid) {
  const Model model = read("<cell id='1' material='3'\nregoin='-1'/>");
  ASSERT_EQ(model.warnings.size(), 1U);
  EXPECT_EQ(model.warnings.front().text, "'regoin' is not read");
  EXPECT_EQ(model.warnings.front().position.line, 2U);
  EXPECT_EQ(model.warnings.front().position.column, 1U);
}

// A fill is looked up among universes first.
TEST(OpenMcFiles, UniversesComeBeforeLattices) {
  const Model model = read(pin_universes(2) +
                           "<cell id='5' fill='2'/><cell id='6' fill='1' region=''/>"
                           "<lattice id='2' dimension='1 1' lower_left='0 0' pitch='1 1' "
                           "universes='1'/>");
  EXPECT_EQ(model.cells[2].fill, FillKind::Universe);
}

TEST(OpenMcFiles, VoidAndSeveralMaterials) {
  const Model model = read("<cell id='1' material='3 void 4'/>");
  EXPECT_THAT(model.cells.front().materials,
              ElementsAre(std::optional<Id>(3), std::nullopt, std::optional<Id>(4)));
}

}  // namespace
}  // namespace exactcsg::io::openmc
