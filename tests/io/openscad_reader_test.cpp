// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "exactcsg/io/model.hpp"
#include "exactcsg/io/openscad/tessellation.hpp"
#include "exactcsg/solid/evaluate.hpp"
#include "exactcsg/solid/measures.hpp"

namespace exactcsg::io {
namespace {

Model read(std::string_view text) { return read_openscad_csg(text, "x.csg"); }

Rational volume(std::string_view text) { return *exact_volume(evaluate(read(text).solid)); }

std::size_t vertex_count(const Model& model) {
  const auto& shape = model.solid.primitive().shape;
  if (const auto* polytope = std::get_if<ConvexPolytope>(&shape)) {
    return polytope->polyhedron->vertices.size();
  }
  return std::get<PolyhedralMesh>(shape).polyhedron->vertices.size();
}

struct Closed {
  const char* text;
  Rational volume;
};

class OpenscadVolume : public testing::TestWithParam<Closed> {};

TEST_P(OpenscadVolume, IsTheClosedForm) {
  EXPECT_EQ(volume(GetParam().text), GetParam().volume) << GetParam().text;
}

// A circle of four fragments has the exact vertices (r, 0), (0, r), (-r, 0), (0, -r) and the area
// 2 r^2, so everything made from it has a rational volume.
INSTANTIATE_TEST_SUITE_P(
    Leaves, OpenscadVolume,
    testing::Values(Closed{"cube(size = [1, 2, 3], center = true);", 6}, Closed{"cube();", 1},
                    Closed{"cube(2);", 8}, Closed{"cube(size = [.1, .1, .1]);", Rational(1, 1000)},
                    Closed{"cylinder($fn = 4, h = 3, r1 = 2, r2 = 2);", 24},
                    Closed{"cylinder($fn = 4, h = 3, r = 2, center = true);", 24},
                    Closed{"cylinder($fn = 4, h = 3, r1 = 2, r2 = 0);", 8},
                    Closed{"cylinder($fn = 4, h = 3, r1 = 0, r2 = 2, center = true);", 8},
                    // 3 / 3 (8 + 2 + sqrt(8 * 2))
                    Closed{"cylinder($fn = 4, h = 3, r1 = 2, r2 = 1);", 14},
                    Closed{"cylinder($fn = 4, h = 3, d1 = 2, d2 = 4);", 14},
                    // The corner of a cube, clockwise seen from outside.
                    Closed{"polyhedron(points = [[0,0,0],[1,0,0],[0,1,0],[0,0,1]], "
                           "faces = [[0,1,2],[0,3,1],[1,3,2],[0,2,3]]);",
                           Rational(1, 6)}));

// The turned cubes of the 3-4-5 angle: intersection 5/6 of the unit cube, union 7/6, difference
// 1/6.
INSTANTIATE_TEST_SUITE_P(
    Trees, OpenscadVolume,
    testing::Values(
        Closed{"cube(1, true); multmatrix([[0.6, -0.8, 0, 0], [0.8, 0.6, 0, 0], [0, 0, 1, 0], "
               "[0, 0, 0, 1]]) { cube(1, true); }",
               Rational(7, 6)},
        Closed{"intersection() { cube(1, true); multmatrix([[0.6, -0.8, 0, 0], [0.8, 0.6, 0, 0], "
               "[0, 0, 1, 0], [0, 0, 0, 1]]) { cube(1, true); } }",
               Rational(5, 6)},
        Closed{"difference() { cube(1, true); multmatrix([[0.6, -0.8, 0, 0], [0.8, 0.6, 0, 0], "
               "[0, 0, 1, 0], [0, 0, 0, 1]]) { cube(1, true); } }",
               Rational(1, 6)},
        // The map scales by 1/2 once its last row is divided out.
        Closed{"multmatrix([[1,0,0,5],[0,1,0,0],[0,0,1,0],[0,0,0,2]]) { cube(2); }", 1},
        // A mirror; determinant -8.
        Closed{"multmatrix([[-2,0,0,0],[0,2,0,0],[0,0,2,0],[0,0,0,1]]) { cube(1); }", 8},
        Closed{"color([1, 0, 0, 1]) { render(convexity = 3) { group() { cube(2); } } }", 8},
        // difference skips empty operands but the first; intersection does not skip any
        Closed{"difference() { cube(2); group(); cube(0); cube(1); }", 7},
        Closed{"difference() { group(); cube(2); } cube(1);", 1},
        Closed{"intersection() { cube(2); group(); } cube(1);", 1},
        Closed{"intersection() { cube(2); square(1); } cube(1);", 1},
        Closed{"%cube(5); #cube(2); *cube(7);", 8}, Closed{"cube(5); group() { !cube(2); }", 8},
        Closed{"group() { %cube(5); } cube(1);", 1},
        Closed{"hull() { cube(1); multmatrix([[1,0,0,2],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) { cube(1); "
               "} }",
               3},
        Closed{"hull() { }  cube(1);", 1}));

// Areas by hand; rotate_extrude of [1, 2] x [0, 1] in four fragments: (2 * 4 - 2 * 1) * 1 = 6.
INSTANTIATE_TEST_SUITE_P(
    Extrusions, OpenscadVolume,
    testing::Values(
        Closed{"linear_extrude(height = 5) { square(size = [2, 3]); }", 30},
        Closed{"linear_extrude(height = 5, center = true) { circle($fn = 4, r = 2); }", 40},
        Closed{"linear_extrude(height = 5) { difference() { square(4, true); circle($fn = 4, r = "
               "1); } }",
               70},
        Closed{"linear_extrude(height = 5) { polygon(points = "
               "[[0,0],[4,0],[4,4],[0,4],[1,1],[1,2],[2,2],[2,1]],"
               " paths = [[0,1,2,3],[4,5,6,7]]); }",
               75},
        Closed{"linear_extrude(height = 5) { polygon([[0,0],[4,0],[0,4]]); }", 40},
        Closed{"linear_extrude(height = 3) { hull() { square(1); multmatrix([[1,0,0,2],[0,1,0,0]]) "
               "{ square(1); } } }",
               9},
        Closed{"linear_extrude(height = 3, scale = [0, 0]) { square(2, true); }", 4},
        // 3 / 3 (4 + 1 + 2)
        Closed{"linear_extrude(height = 3, scale = [0.5, 0.5]) { square(2, true); }", 7},
        Closed{"linear_extrude(height = 0) { square(2); } cube(1);", 1},
        Closed{"rotate_extrude($fn = 4) { polygon([[1,0],[2,0],[2,1],[1,1]]); }", 6},
        Closed{"rotate_extrude($fn = 4) { polygon([[-1,0],[-2,0],[-2,1],[-1,1]]); }", 6},
        Closed{"rotate_extrude(angle = 180, $fn = 4) { polygon([[1,0],[2,0],[2,1],[1,1]]); }", 3},
        Closed{"rotate_extrude(angle = -90, $fn = 4) { polygon([[1,0],[2,0],[2,1],[1,1]]); }",
               Rational(3, 2)},
        Closed{"rotate_extrude($fn = 4) { square(size = [2, 3]); }", 24},
        Closed{"rotate_extrude(angle = 0) { square(1); } cube(1);", 1},
        // The image under a map of an extrusion.
        Closed{"multmatrix([[1,0,0,0],[0,0,-1,0],[0,2,0,0],[0,0,0,1]]) { linear_extrude(height = "
               "5) { square(1); } }",
               10}));

// OpenSCAD takes the planar part of every single matrix: turning a square out of its plane and back
// leaves nothing.
TEST(OpenscadReader, FlattensPlanarFiguresMatrixByMatrix) {
  const Model model = read(
      "linear_extrude(height = 1) { multmatrix([[1,0,0,0],[0,0,-1,0],[0,1,0,0],[0,0,0,1]]) { "
      "multmatrix([[1,0,0,0],[0,0,1,0],[0,-1,0,0],[0,0,0,1]]) { square(1); } } }");
  EXPECT_TRUE(model.solid.is_empty());
  EXPECT_THAT(model.warnings.front().text, testing::HasSubstr("singular in the plane"));
}

// Sphere of four fragments: two rings at phi = 45 and 135 degrees, so a prism with the half
// diagonal s and the half height s, s the double nearest to sqrt(1/2): V = 2 s^2 * 2 s.
TEST(OpenscadReader, ReadsSpheres) {
  const Rational s = rational_of(0.70710678118654752440);
  EXPECT_EQ(volume("sphere($fn = 4, r = 10);"), 4000 * s * s * s);
  EXPECT_EQ(vertex_count(read("sphere($fn = 5, r = 1);")), 15U);
  EXPECT_EQ(vertex_count(read("sphere(r = 100);")), 450U);  // $fa = 12: 30 fragments, 15 rings
}

TEST(OpenscadReader, StatesPrimitivesOriginsAndRounding) {
  const Model model = read(
      "group() {\n  cube(1);\n  multmatrix([[2,0,0,0],[0,1,0,0],[0,0,1,0],"
      "[0,0,0,1]]) { sphere(3); }\n}");
  EXPECT_EQ(model.name, "x.csg");
  EXPECT_EQ(model.primitives, 2U);
  EXPECT_EQ(model.solid.children()[0].primitive().origin, "x.csg:2:3");
  EXPECT_EQ(model.rounding_bound, 6 * openscad::unit_rounding_bound());
  EXPECT_EQ(read("cube(0.1);").rounding_bound, 0);
}

TEST(OpenscadReader, AnswersEmptyModelsWithAWarning) {
  for (const char* text : {"group();", "cube(0);", "sphere(0);", "cylinder(h = 0);",
                           "cylinder(h = 1, r1 = 0, r2 = 0);", "difference() { group(); cube(1); }",
                           "multmatrix([[1,0,0,0],[0,1,0,0],[0,0,0,0],[0,0,0,1]]) { cube(1); }",
                           "multmatrix([[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,0]]) { cube(1); }",
                           "multmatrix([[nan,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) { cube(1); }",
                           "linear_extrude(height = 1) { polygon([]); }"}) {
    const Model model = read(text);
    EXPECT_TRUE(model.solid.is_empty()) << text;
    EXPECT_FALSE(model.warnings.empty()) << text;
  }
}

TEST(OpenscadReader, WarnsOfUnknownArgumentsAndReadsDefaultsForUndefinedOnes) {
  const Model model = read("cube(size = nan, centre = true, center = undef);");
  EXPECT_EQ(*exact_volume(evaluate(model.solid)), 1);
  ASSERT_EQ(model.warnings.size(), 1U);
  EXPECT_THAT(model.warnings[0].text, testing::HasSubstr("'centre'"));
  EXPECT_EQ(model.warnings[0].position.column, 18U);
}

// A million nodes deep, with matrices: neither the parser nor the evaluation recurses.
TEST(OpenscadReader, EvaluatesAChainOfAMillionNodes) {
  constexpr std::size_t depth = 200'000;
  std::string text;
  for (std::size_t i = 0; i < depth; ++i) {
    text +=
        "group(){difference(){multmatrix([[1,0,0,1],[0,1,0,0],[0,0,1,0],[0,0,0,1]]){union(){color("
        "0){";
  }
  text += "cube();";
  for (std::size_t i = 0; i < depth; ++i) text += "}}}}}";
  const Model model = read(text);
  ASSERT_TRUE(model.solid.is_primitive());
  const auto& polytope = std::get<ConvexPolytope>(model.solid.primitive().shape);
  Rational least = polytope.polyhedron->vertices[0].x;
  for (const Point3& p : polytope.polyhedron->vertices) least = std::min(least, p.x);
  EXPECT_EQ(least, Rational(static_cast<unsigned long>(depth)));
}

struct Refused {
  const char* text;
  ErrorId id;
  std::size_t column;
};

class OpenscadRefused : public testing::TestWithParam<Refused> {};

TEST_P(OpenscadRefused, HasItsIdAndPosition) {
  try {
    read(GetParam().text);
    FAIL() << "accepted: " << GetParam().text;
  } catch (const Error& error) {
    EXPECT_EQ(error.id(), GetParam().id) << error.what();
    ASSERT_TRUE(error.details().position) << error.what();
    EXPECT_EQ(error.details().position->line, 1U) << error.what();
    EXPECT_EQ(error.details().position->column, GetParam().column) << error.what();
  }
}

// Columns counted by hand; a text begins after its quote.
INSTANTIATE_TEST_SUITE_P(
    Texts, OpenscadRefused,
    testing::Values(
        Refused{"cubes(1);", ErrorId::UnknownNode, 1},
        Refused{"group() { translate([1, 2, 3]) { cube(); } }", ErrorId::UnknownNode, 11},
        Refused{"group() { fill() { square(); } }", ErrorId::UnsupportedNode, 11},
        Refused{"fill() { square(); }", ErrorId::UnsupportedNode, 1},
        Refused{"text(\"a\");", ErrorId::NotThreeDimensional, 1},
        Refused{"linear_extrude(1) { text([1]); }", ErrorId::BadArgument, 26},
        Refused{"linear_extrude(height = 1, v = [1, 0, 0]) { square(1); }",
                ErrorId::UnsupportedNode, 32},
        Refused{"cube(size = [1, -2, 3]);", ErrorId::BadArgument, 13},
        Refused{"cube(size = -1);", ErrorId::BadArgument, 13},
        Refused{"cube(size = [1, 2]);", ErrorId::BadArgument, 13},
        Refused{"cube(size = \"a\");", ErrorId::BadArgument, 14},
        Refused{"cube(center = 1);", ErrorId::BadArgument, 15},
        Refused{"cube(size = [1, true, 2]);", ErrorId::BadArgument, 17},
        Refused{"sphere(r = -1);", ErrorId::BadArgument, 12},
        Refused{"cylinder(r1 = -1);", ErrorId::BadArgument, 15},
        Refused{"cylinder(h = -1);", ErrorId::BadArgument, 14},
        Refused{"sphere(r = 1e308);", ErrorId::NumberOutOfRange, 12},
        Refused{"sphere(r = 1e9999);", ErrorId::NumberOutOfRange, 12},
        Refused{"sphere($fn = 1e9);", ErrorId::TooLarge, 1},
        Refused{"linear_extrude(height = 1, twist = 90, slices = 1e9) { square(1); }",
                ErrorId::TooLarge, 49},
        Refused{"multmatrix([[1, 2, 3, 4, 5]]) { cube(); }", ErrorId::BadArgument, 13},
        Refused{"multmatrix([[1, \"a\"]]) { cube(); }", ErrorId::BadArgument, 18},
        Refused{"square(1);", ErrorId::NotThreeDimensional, 1},
        Refused{"group() { circle(1); cube(); }", ErrorId::NotThreeDimensional, 1},
        Refused{"offset(r = \"a\") { square(1); }", ErrorId::BadArgument, 13},
        Refused{"offset(delta = [1]) { square(1); }", ErrorId::BadArgument, 16},
        Refused{"offset(delta = 1, chamfer = 1) { square(1); }", ErrorId::BadArgument, 29},
        Refused{"offset(r = 1e6, $fn = 1e9) { square(1); }", ErrorId::TooLarge, 1},
        Refused{"projection(cut = 1) { cube(1); }", ErrorId::BadArgument, 18},
        Refused{"resize(newsize = 1) { cube(1); }", ErrorId::BadArgument, 18},
        Refused{"resize(newsize = [1, -1, 0]) { cube(1); }", ErrorId::BadArgument, 22},
        Refused{"resize(newsize = [1, 1, 1, 1]) { cube(1); }", ErrorId::BadArgument, 18},
        Refused{"resize([1], auto = \"x\") { cube(1); }", ErrorId::BadArgument, 21},
        Refused{"import();", ErrorId::BadArgument, 1},
        Refused{"import(file = 1);", ErrorId::BadArgument, 15},
        Refused{"import(file = \"a.dxf\");", ErrorId::UnsupportedNode, 16},
        Refused{"surface(file = \"a.png\");", ErrorId::UnsupportedNode, 17},
        Refused{"surface(file = \"\");", ErrorId::BadArgument, 17},
        // A text alone reads no files.
        Refused{"import(file = \"a.off\");", ErrorId::FileNotReadable, 16},
        Refused{"surface(file = \"/dev/zero\");", ErrorId::FileNotReadable, 17},
        Refused{"polyhedron();", ErrorId::BadArgument, 1},
        Refused{"polyhedron([[0,0]], []);", ErrorId::BadArgument, 13},
        Refused{"polyhedron([[0,0,0]], [[0,0,1]]);", ErrorId::UnknownVertex, 29},
        Refused{"polyhedron([[0,0,0]], [[0.5]]);", ErrorId::BadArgument, 25},
        Refused{"polyhedron([[0,0,0]], [[-1]]);", ErrorId::UnknownVertex, 25},
        Refused{"polygon([[0,0,0]]);", ErrorId::BadArgument, 10},
        Refused{"linear_extrude(height = 1) { polygon([[0,0],[1,0],[0,1]], [[0,1,3]]); }",
                ErrorId::UnknownVertex, 65},
        Refused{"rotate_extrude() { square(1, true); }", ErrorId::BadArgument, 1},
        Refused{"rotate_extrude(angle = 200, $fn = 3) { square(1); }", ErrorId::BadArgument, 1}));

std::string polyhedron(const std::string& faces, const std::string& points =
                                                     "[[0,0,0],[1,0,0],[1,1,0],[0,1,0],"
                                                     "[0,0,1],[1,0,1],[1,1,1],[0,1,1]]") {
  return "polyhedron(points = " + points + ", faces = " + faces + ");";
}

ErrorId refusal(const std::string& text) {
  try {
    read(text);
  } catch (const Error& error) {
    EXPECT_TRUE(error.details().position) << error.what();
    return error.id();
  }
  ADD_FAILURE() << "accepted: " << text;
  return ErrorId::InternalError;
}

// A unit cube, clockwise from outside as OpenSCAD wants it.
constexpr const char* cube_faces = "[[0,1,2,3],[7,6,5,4],[4,5,1,0],[5,6,2,1],[6,7,3,2],[7,4,0,3]]";

TEST(OpenscadPolyhedron, ReadsAConvexOne) {
  const Model model = read(polyhedron(cube_faces));
  EXPECT_TRUE(std::holds_alternative<ConvexPolytope>(model.solid.primitive().shape));
  EXPECT_EQ(volume(polyhedron(cube_faces)), 1);
}

TEST(OpenscadPolyhedron, RefusesWhatIsNoClosedSurfaceByName) {
  EXPECT_EQ(refusal(polyhedron("[[0,1,2,3],[7,6,5,4],[4,5,1,0],[5,6,2,1],[6,7,3,2]]")),
            ErrorId::OpenMesh);
  EXPECT_EQ(refusal(polyhedron("[[3,2,1,0],[4,5,6,7],[0,1,5,4],[1,2,6,5],[2,3,7,6],[3,0,4,7]]")),
            ErrorId::InvertedMesh);
  // One face turned round.
  EXPECT_EQ(refusal(polyhedron("[[3,2,1,0],[7,6,5,4],[4,5,1,0],[5,6,2,1],[6,7,3,2],[7,4,0,3]]")),
            ErrorId::OpenMesh);
  EXPECT_EQ(refusal(polyhedron("[]")), ErrorId::OpenMesh);
  EXPECT_EQ(refusal(polyhedron("[[0,1,2]]", "[[0,0,0],[1,0,0],[2,0,0]]")),
            ErrorId::DegenerateFacet);
}

// Prism over an L: volume 3 of the 2 x 2 x 1 block's 4; its caps are not convex.
TEST(OpenscadPolyhedron, ReadsANonConvexOne) {
  const std::string text = polyhedron(
      "[[0,1,2,3,4,5],[11,10,9,8,7,6],[6,7,1,0],[7,8,2,1],[8,9,3,2],[9,10,4,3],[10,11,5,4],[11,6,0,"
      "5]]",
      "[[0,0,0],[2,0,0],[2,1,0],[1,1,0],[1,2,0],[0,2,0],[0,0,1],[2,0,1],[2,1,1],[1,1,1],[1,2,1],[0,"
      "2,1]]");
  const Model model = read(text);
  EXPECT_TRUE(std::holds_alternative<PolyhedralMesh>(model.solid.primitive().shape));
  EXPECT_TRUE(model.warnings.empty());
  EXPECT_EQ(volume(text), 3);
}

// Points that are given twice, a face that repeats a vertex, one with two different vertices only.
TEST(OpenscadPolyhedron, WeldsEqualPoints) {
  EXPECT_EQ(volume(polyhedron(
                "[[0,1,2,3],[7,6,5,4],[8,5,1,0],[5,6,2,1,1],[6,7,3,2],[7,4,0,3],[4,8,0]]",
                "[[0,0,0],[1,0,0],[1,1,0],[0,1,0],[0,0,1],[1,0,1],[1,1,1],[0,1,1],[0,0,1]]")),
            1);
}

// A corner of the cube lifted by a millionth.
TEST(OpenscadPolyhedron, SplitsFacesThatAreNotQuitePlanarAndSaysSo) {
  const Model model = read(polyhedron(cube_faces,
                                      "[[0,0,0],[1,0,0],[1,1,0],[0,1,0],[0,0,1],[1,0,1],"
                                      "[1,1,1.000001],[0,1,1]]"));
  ASSERT_FALSE(model.warnings.empty());
  EXPECT_THAT(model.warnings[0].text, testing::HasSubstr("not exactly planar"));
  const Rational found = *exact_volume(evaluate(model.solid));
  // Only the face z = 1 bends (the others hold the moved corner in their planes x = 1 and y = 1).
  // Its triangles have area 1/2 each; the moved vertex carries one of them, or both if the diagonal
  // ends in it: an additional volume of 1/6 or 1/3 of a millionth.
  const Rational more = (found - 1) * 1'000'000;
  EXPECT_TRUE(more == Rational(1, 6) || more == Rational(1, 3)) << more;
}

// Two cubes in one polyhedron that share an edge are one mesh; that pass through each other are
// not.
TEST(OpenscadPolyhedron, RefusesSurfacesThatCrossThemselves) {
  const std::string first = "[0,0,0],[1,0,0],[1,1,0],[0,1,0],[0,0,1],[1,0,1],[1,1,1],[0,1,1]";
  const std::string faces =
      "[[0,1,2,3],[7,6,5,4],[4,5,1,0],[5,6,2,1],[6,7,3,2],[7,4,0,3],"
      "[8,9,10,11],[15,14,13,12],[12,13,9,8],[13,14,10,9],[14,15,11,10],[15,12,8,11]]";
  const std::string crossing =
      ",[.5,.5,.5],[2,.5,.5],[2,2,.5],[.5,2,.5],[.5,.5,2],[2,.5,2],[2,2,2],[.5,2,2]";
  EXPECT_EQ(refusal(polyhedron(faces, "[" + first + crossing + "]")),
            ErrorId::SelfIntersectingMesh);
  const std::string apart = ",[3,0,0],[4,0,0],[4,1,0],[3,1,0],[3,0,1],[4,0,1],[4,1,1],[3,1,1]";
  EXPECT_EQ(volume(polyhedron(faces, "[" + first + apart + "]")), 2);
}

}  // namespace
}  // namespace exactcsg::io
