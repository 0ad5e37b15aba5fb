// SPDX-License-Identifier: GPL-3.0-or-later
// offset, projection, resize, minkowski, import and surface of the .csg format. Expected values are
// closed forms, derived beside them, unless a comment says otherwise.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "exactcsg/io/model.hpp"
#include "exactcsg/solid/evaluate.hpp"
#include "exactcsg/solid/measures.hpp"
#include "temporary_folder.hpp"

namespace exactcsg::io {
namespace {

namespace fs = std::filesystem;

Model read(std::string_view text) { return read_openscad_csg(text, "x.csg"); }

Rational volume(std::string_view text) { return *exact_volume(evaluate(read(text).solid)); }

// Of a planar node: the volume of its prism of height 1.
Rational area(const std::string& text) {
  return volume("linear_extrude(height = 1) { " + text + " }");
}

struct PlanarCase {
  const char* text;
  Rational area;
};
class OpenscadPlanarNodes : public testing::TestWithParam<PlanarCase> {};
TEST_P(OpenscadPlanarNodes, HaveTheAreaOfTheClosedForm) {
  EXPECT_EQ(area(GetParam().text), GetParam().area) << GetParam().text;
}

INSTANTIATE_TEST_SUITE_P(
    Offset, OpenscadPlanarNodes,
    testing::Values(
        PlanarCase{"offset(delta = 1, chamfer = false) { square(10); }", 144},
        PlanarCase{"offset(delta = -1, chamfer = false) { square(10); }", 64},
        PlanarCase{"offset(delta = -5, chamfer = false) { square([10, 20]); }", 0},
        PlanarCase{"offset(delta = 0) { square(10); }", 100},
        PlanarCase{"offset(r = 0) { square(10); }", 100},
        // A hole shrinks as its surroundings grow: 12^2 - 2^2, 14^2 without a hole.
        PlanarCase{"offset(delta = 1) { difference() { square(10); "
                   "multmatrix([[1,0,0,3],[0,1,0,3]]) { square(4); } } }",
                   140},
        PlanarCase{"offset(delta = 2) { difference() { square(10); "
                   "multmatrix([[1,0,0,3],[0,1,0,3]]) { square(4); } } }",
                   196},
        // A triangle with incircle of radius 1, doubled in size.
        PlanarCase{"offset(delta = 1) { polygon([[0,0],[4,0],[0,3]]); }", 24},
        PlanarCase{"offset(delta = -0.5) { polygon([[0,0],[4,0],[0,3]]); }", Rational(3, 2)},
        // Two squares grow into one rectangle; a bar thinner than 2 vanishes.
        PlanarCase{"offset(delta = 1) { square(2); multmatrix([[1,0,0,3],[0,1,0,0]]) "
                   "{ square(2); } }",
                   28},
        PlanarCase{"offset(delta = -1) { square([20, 2]); square(5); }", 9},
        // Clipper's arcs have 4.35 pieces a turn at least: a quarter is one, cut straight.
        PlanarCase{"offset(r = 1, $fn = 4) { square(10); }", 142},
        // The matrix above counts after the offset.
        PlanarCase{"multmatrix([[2,0,0,7],[0,3,0,0]]) { offset(delta = 1) { square(10); } }", 864},
        PlanarCase{"offset(delta = 1) { multmatrix([[2,0,0,7],[0,3,0,0]]) { square(10); } }", 704},
        PlanarCase{"offset(delta = -2) { offset(delta = 2) { square(10); } }", 100},
        PlanarCase{"offset(delta = 1) { }", 0}, PlanarCase{"offset(delta = 1) { cube(1); }", 0},
        // A radius goes before a delta. An L: 36 + its perimeter less what is counted twice at the
        // inner corner + five corners of a half.
        PlanarCase{"offset(r = 1, delta = 3, $fn = 4) { square(10); }", 142},
        PlanarCase{"offset(r = 1, $fn = 4) { square([10, 2]); square([2, 10]); }",
                   Rational(155, 2)}));

INSTANTIATE_TEST_SUITE_P(
    Projection, OpenscadPlanarNodes,
    testing::Values(
        // Turned about x by the angle of the triangle 3-4-5: 1 by 3/5 + 4/5.
        PlanarCase{"projection(cut = false) { multmatrix([[1,0,0,0],[0,0.6,-0.8,0],[0,0.8,0.6,0]]) "
                   "{ cube(1); } }",
                   Rational(7, 5)},
        PlanarCase{"projection() { cube(1); multmatrix([[1,0,0,0],[0,1,0,0],[0,0,1,5]]) "
                   "{ cube([2, 1, 1]); } }",
                   2},
        // Through hole and pocket.
        PlanarCase{"projection() { difference() { cube(4); multmatrix([[1,0,0,1],[0,1,0,1],"
                   "[0,0,1,-1]]) { cube([2, 2, 9]); } } }",
                   12},
        PlanarCase{"projection() { difference() { cube(4); multmatrix([[1,0,0,1],[0,1,0,1],"
                   "[0,0,1,1]]) { cube([2, 2, 9]); } } }",
                   16},
        PlanarCase{"projection(cut = true) { cube(size = [2, 3, 4], center = true); }", 6},
        // Standing on the plane, hanging from it, above it.
        PlanarCase{"projection(cut = true) { cube([2, 3, 4]); }", 6},
        PlanarCase{"projection(cut = true) { multmatrix([[1,0,0,0],[0,1,0,0],[0,0,1,-4]]) "
                   "{ cube([2, 3, 4]); } }",
                   6},
        PlanarCase{"projection(cut = true) { multmatrix([[1,0,0,0],[0,1,0,0],[0,0,1,1]]) "
                   "{ cube([2, 3, 4]); } }",
                   0},
        // One on each side of the plane, overlapping in a half.
        PlanarCase{"projection(cut = true) { cube(2); multmatrix([[1,0,0,1],[0,1,0,0],"
                   "[0,0,1,-2]]) { cube(2); } }",
                   6},
        // A cone of four fragments, radii 2 and 0, cut at half its height: 2 r^2 with r = 1.
        PlanarCase{"projection(cut = true) { multmatrix([[1,0,0,0],[0,1,0,0],[0,0,1,-1]]) "
                   "{ cylinder(h = 2, r1 = 2, r2 = 0, $fn = 4); } }",
                   2},
        PlanarCase{"projection(cut = true) { difference() { cube(size = 4, center = true); "
                   "cube(size = 2, center = true); } }",
                   12},
        PlanarCase{"projection() { square(5); cube(1); }", 1},
        PlanarCase{"multmatrix([[2,0,0,0],[0,2,0,0],[0,0,9,9]]) { projection() { cube(3); } }", 36},
        PlanarCase{"projection() { }", 0}));

INSTANTIATE_TEST_SUITE_P(
    ResizeAndMinkowski, OpenscadPlanarNodes,
    testing::Values(
        PlanarCase{"resize(newsize = [4,0,0], auto = [0,1,0]) { square([1, 2]); }", 32},
        PlanarCase{"resize(newsize = [4,0,7], auto = [1,1,1]) { square([1, 2]); }", 32},
        PlanarCase{"resize(newsize = [4,3,0], auto = [0,0,0]) { square([1, 2]); }", 12},
        PlanarCase{"resize(newsize = [4,0,0], auto = [0,0,0]) { square([1, 2]); }", 8},
        PlanarCase{"minkowski(convexity = 0) { square(3); square([2, 1]); }", 20},
        // Square and square on its tip: 100 + 4 * 10 * 1 + 2.
        PlanarCase{"minkowski() { square(10); circle(r = 1, $fn = 4); }", 142},
        // The frame's hole shrinks by 2: 12^2 - 2^2.
        PlanarCase{"minkowski() { difference() { square(10); multmatrix([[1,0,0,3],[0,1,0,3]]) "
                   "{ square(4); } } square(size = 2, center = true); }",
                   140},
        // As OpenSCAD: other operands that are empty do not count, an empty first one does.
        PlanarCase{"minkowski() { square(3); square(0); square(1); }", 16},
        PlanarCase{"minkowski() { square(0); square(3); square(1); }", 0},
        PlanarCase{"minkowski() { square(3); }", 9}));

struct SolidCase {
  const char* text;
  Rational volume;
};
class OpenscadSolidNodes : public testing::TestWithParam<SolidCase> {};
TEST_P(OpenscadSolidNodes, HaveTheVolumeOfTheClosedForm) {
  EXPECT_EQ(volume(GetParam().text), GetParam().volume) << GetParam().text;
}

INSTANTIATE_TEST_SUITE_P(
    Resize, OpenscadSolidNodes,
    testing::Values(
        SolidCase{"resize(newsize = [10,0,5], auto = [1,1,0]) { cube([1, 2, 3]); }", 1000},
        SolidCase{"resize(newsize = [4,5,0], auto = [0,0,0]) { cube([1, 2, 3]); }", 60},
        SolidCase{"resize(newsize = [4], auto = true) { cube([1, 2, 3]); }", 4 * 8 * 12},
        SolidCase{"resize(newsize = [0,0,0]) { cube([1, 2, 3]); }", 6},
        // The extents are those of the result, not of the operands: a corner of side 3.
        SolidCase{"resize(newsize = [6,6,6]) { intersection() { cube(9); cube(3); } }", 216},
        SolidCase{"multmatrix([[1,0,0,5],[0,1,0,0],[0,0,2,0]]) { resize([2, 2, 2]) { cube(9); } }",
                  16},
        SolidCase{"resize([2, 2, 2]) { multmatrix([[1,0,0,5],[0,1,0,0],[0,0,2,0]]) { cube(9); } }",
                  8},
        SolidCase{"resize([2, 2, 2]) { }", 0},
        SolidCase{"resize([2, 2, 2]) { difference() { cube(1); cube(2); } }", 0}));

// Unit cubes: the sum of two of them, at a and b, is the cube of side 2 at a + b.
INSTANTIATE_TEST_SUITE_P(
    Minkowski, OpenscadSolidNodes,
    testing::Values(
        SolidCase{"minkowski(convexity = 0) { cube(3); cube(2); }", 125},
        SolidCase{"minkowski() { cube(3); group(); cube(2); cube(1); }", 216},
        SolidCase{"minkowski() { intersection() { cube(1); multmatrix([[1,0,0,5]]) { cube(1); } } "
                  "cube(2); }",
                  8},
        SolidCase{"minkowski() { cube(2); square(1); cube(1); }", 27},
        // Octahedron and cube of side 2: V(K + B) = V(B) + faces + edges + V(K) for the cube B
        // = [-1, 1]^3 and K = {|x| + |y| + |z| <= 1}: 8 + 6 * 4 * 1 + 12 * 2 * (1/2) + 4/3.
        SolidCase{"minkowski() { cube(size = 2, center = true); polyhedron([[1,0,0],[-1,0,0],"
                  "[0,1,0],[0,-1,0],[0,0,1],[0,0,-1]], [[0,4,2],[2,4,1],[1,4,3],[3,4,0],[2,5,0],"
                  "[1,5,2],[3,5,1],[0,5,3]]); }",
                  Rational(136, 3)},
        // A union is taken apart: an L of two bars, thickened by a cube of side 1.
        SolidCase{"minkowski() { union() { cube([10, 1, 1]); cube([1, 10, 1]); } cube(1); }",
                  2 * (11 * 2 + 11 * 2 - 4)},
        // A frame whose hole shrinks by the cube's side; one whose hole closes.
        SolidCase{"minkowski() { difference() { cube([10, 10, 2]); multmatrix([[1,0,0,3],[0,1,0,3],"
                  "[0,0,1,-1]]) { cube([4, 4, 9]); } } cube(1); }",
                  3 * (121 - 9)},
        SolidCase{"minkowski() { cube(4); difference() { cube([10, 10, 2]); multmatrix([[1,0,0,3],"
                  "[0,1,0,3],[0,0,1,-1]]) { cube([4, 4, 9]); } } }",
                  6 * 14 * 14},
        // A cavity shrinks likewise: 11^3 - 3^3.
        SolidCase{"minkowski() { difference() { cube(10); multmatrix([[1,0,0,3],[0,1,0,3],"
                  "[0,0,1,3]]) { cube(4); } } cube(1); }",
                  1331 - 27},
        SolidCase{"multmatrix([[2,0,0,0],[0,1,0,0],[0,0,1,0]]) { minkowski() { cube(1); cube(1); } "
                  "}",
                  16},
        SolidCase{"minkowski() { cube(3); }", 27}, SolidCase{"minkowski() { }", 0}));

// A corner is cut at the distance of its bisector: a triangle of height sqrt(2) - 1 and twice that
// base is missing from each corner of the square of side 12.
TEST(OpenscadOffset, CutsCornersSquare) {
  const double found = nearest_double(area("offset(delta = 1, chamfer = true) { square(10); }"));
  EXPECT_NEAR(found, 132 + 8 * std::sqrt(2), 1e-13);
}

// 20 pieces to a circle: the corners are together one regular 20-gon of radius 2.
TEST(OpenscadOffset, RoundsCornersAsManyTimesAsItsFragmentsSay) {
  const Model model =
      read("linear_extrude(height = 1) { offset(r = 2, $fn = 20) { square(10); } }");
  const Boundary boundary = evaluate(model.solid);
  EXPECT_EQ(boundary.vertices.size(), 2U * 4 * 6);
  EXPECT_NEAR(nearest_double(*exact_volume(boundary)), 100 + 80 + 10 * 4 * std::sin(2 * M_PI / 20),
              1e-12);
  EXPECT_GT(model.rounding_bound, 0);
  EXPECT_LT(model.rounding_bound, Rational(1, Integer(1) << 45U));
}

TEST(OpenscadOffset, IsExactWhereLengthsAreRational) {
  const Model model =
      read("linear_extrude(height = 1) { offset(delta = 0.1) { polygon([[0,0],[4,0],[0,3]]); } }");
  EXPECT_EQ(model.rounding_bound, 0);
}

class OpenscadNamedFiles : public testing::Test {
 protected:
  OpenscadNamedFiles() { fs::create_directory(folder_.path() / "parts"); }
  Rational volume_of(const std::string& text) const {
    return *exact_volume(evaluate(read_model(folder_.write("model.csg", text)).solid));
  }
  // The error that reading the text ends in; no position: it was accepted.
  Error::Details refusal(const std::string& text, ErrorId id) const {
    try {
      read_model(folder_.write("model.csg", text));
    } catch (const Error& error) {
      EXPECT_EQ(error.id(), id) << error.what();
      return error.details();
    }
    ADD_FAILURE() << "accepted: " << text;
    return {};
  }
  const exactcsg::test::Folder folder_;
};

constexpr const char* corner_of_a_cube =
    "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";

TEST_F(OpenscadNamedFiles, AreImportedFromTheModelsFolder) {
  folder_.write("parts/corner.off", corner_of_a_cube);
  const std::string import =
      "import(file = \"parts/corner.off\", layer = \"\", origin = [0, 0], "
      "scale = 1, convexity = 1, $fn = 0, $fa = 12, $fs = 2, timestamp = 1);";
  EXPECT_EQ(volume_of(import), Rational(1, 6));
  EXPECT_EQ(volume_of("multmatrix([[2,0,0,0],[0,3,0,0],[0,0,4,0]]) { " + import + " }"), 4);
  EXPECT_EQ(volume_of("difference() { cube(1); " + import + " }"), Rational(5, 6));
  const std::string absolute = folder_ / "parts/corner.off";
  EXPECT_EQ(volume_of("import(file = \"" + absolute + "\");"), Rational(1, 6));
}

TEST_F(OpenscadNamedFiles, AreImportedFromStl) {
  std::string stl = "solid corner\n";
  for (const char* triangle :
       {"0 0 0 0 1 0 1 0 0", "0 0 0 1 0 0 0 0 1", "1 0 0 0 1 0 0 0 1", "0 0 0 0 0 1 0 1 0"}) {
    std::istringstream numbers(triangle);
    stl += "facet normal 0 0 0\nouter loop\n";
    std::string x, y, z;
    while (numbers >> x >> y >> z) stl += "vertex " + x + " " + y + " " + z + "\n";
    stl += "endloop\nendfacet\n";
  }
  folder_.write("a b\\.STL", stl + "endsolid corner\n");
  EXPECT_EQ(volume_of("import(file = \"a b\\\\.STL\");"), Rational(1, 6));
}

TEST_F(OpenscadNamedFiles, AreRefusedByNameAndPlace) {
  const auto place = [](const Error::Details& details) {
    EXPECT_TRUE(details.position);
    return details.position ? details.position->column : 0;
  };
  EXPECT_EQ(place(refusal("import(file = \"no.off\");", ErrorId::FileNotReadable)), 16U);
  EXPECT_EQ(place(refusal("surface(file = \"no.dat\");", ErrorId::FileNotReadable)), 17U);
  fs::create_directory(folder_ / "folder.off");
  EXPECT_EQ(place(refusal("import(file = \"folder.off\");", ErrorId::FileNotReadable)), 16U);
  // What is wrong inside the file is said of a place in it.
  folder_.write("short.off", "OFF\n4 4 0\n0 0 0\n");
  const Error::Details truncated =
      refusal("import(file = \"short.off\");", ErrorId::TruncatedInput);
  ASSERT_TRUE(truncated.position);
  EXPECT_THAT(truncated.position->file, testing::EndsWith("short.off"));
  // What is wrong with the solid, of the node.
  folder_.write("open.off", "OFF\n4 3 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n");
  EXPECT_EQ(place(refusal("cube(1); import(file = \"open.off\");", ErrorId::OpenMesh)), 10U);
}

// Under a square of heights of sum S the volume is S / 4, because the middle is their mean.
TEST_F(OpenscadNamedFiles, AreSurfaces) {
  folder_.write("s.dat", "# heights\n1 2 3\n\n 4\t5 6\n");
  EXPECT_EQ(volume_of("surface(file = \"s.dat\", center = false, invert = false);"), (12 + 16) / 4);
  // The floor is one below the least height, if that is below 0.
  folder_.write("low.dat", "-1.5 2 3\n4 5 6\n");
  EXPECT_EQ(volume_of("surface(file = \"low.dat\");"), Rational(19, 8) + 4 + Rational(5, 2) * 2);
  const Boundary centred = evaluate(
      read_model(folder_.write("c.csg", "surface(file = \"low.dat\", center = true);")).solid);
  EXPECT_EQ(centred.vertices.front(), (Point3{-1, Rational(-1, 2), Rational(-5, 2)}));
  EXPECT_EQ(centred.vertices.back(), (Point3{1, Rational(1, 2), 6}));
  folder_.write("row.dat", "1 2 3\n");
  EXPECT_EQ(volume_of("cube(1); surface(file = \"row.dat\");"), 1);
  folder_.write("ragged.dat", "1 2 3\n4 5\n");
  EXPECT_THAT(refusal("surface(file = \"ragged.dat\");", ErrorId::UnexpectedText).position->line,
              2U);
  folder_.write("word.dat", "1 2\n4 x\n");
  refusal("surface(file = \"word.dat\");", ErrorId::UnexpectedText);
}

}  // namespace
}  // namespace exactcsg::io
