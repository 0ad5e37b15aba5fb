// SPDX-License-Identifier: GPL-3.0-or-later
// Expected corners: those that OpenSCAD 2021.01 wrote for the same text with
// `openscad --render=cgal -o x.nef3 x.csg`, as homogeneous integers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "exactcsg/io/model.hpp"
#include "exactcsg/solid/evaluate.hpp"

namespace exactcsg::io {
namespace {

std::vector<Point3> corners(std::string_view text) {
  ReadOptions options;
  options.rounding = Rounding::OpenScadGrid;
  return to_vector(evaluate(read_openscad_csg(text, "x.csg", options).solid).vertices);
}

Point3 on_grid(long x, long y, long z) {
  const Rational cell(1, 1048576);
  return {x * cell, y * cell, z * cell};
}

const std::string turn =
    "multmatrix([[0.866025, -0.5, 0, 0.1], [0.5, 0.866025, 0, 0.2], [0, 0, 1, 0.3], [0, 0, 0, 1]])";

TEST(OpenscadGrid, CutsALonePrimitive) {
  const auto found = corners("sphere($fn = 8, $fa = 12, $fs = 2, r = 1.3);");
  EXPECT_EQ(found.size(), 32U);
  EXPECT_THAT(found, testing::IsSupersetOf(
                         {on_grid(-890519, -890519, -521654), on_grid(-1259385, 0, 521654),
                          on_grid(521654, 0, 1259385), on_grid(890519, 890519, 521654)}));
}

TEST(OpenscadGrid, MapsPolygonsInDoubleBeforeItCutsThem) {
  const auto found = corners(turn + "{ cube(size = [1, 2, 3], center = false); }");
  EXPECT_THAT(found, testing::UnorderedElementsAre(
                         on_grid(-943718, 2025901, 3460300), on_grid(-35625, 2550189, 3460300),
                         on_grid(104857, 209715, 3460300), on_grid(-35625, 2550189, 314572),
                         on_grid(1012950, 734003, 3460300), on_grid(1012950, 734003, 314572),
                         on_grid(104857, 209715, 314572), on_grid(-943718, 2025901, 314572)));
}

TEST(OpenscadGrid, LeavesAUnionWithOneOperandUncut) {
  const std::string cube = "cube(size = [1, 2, 3]);";
  EXPECT_EQ(corners(turn + "{ union() { group(); " + cube + " cube(0); } }"),
            corners(turn + "{ " + cube + " }"));
}

// Here the empty group is an operand, so the cube is cut first and then mapped exactly.
TEST(OpenscadGrid, MapsResultsOfBooleansExactly) {
  const auto found = corners(turn + "{ difference() { cube(size = [1, 2, 3]); group(); } }");
  Point3 expected{Rational("-32425917317067571/36028797018963968"),
                  Rational("69609437280489338/36028797018963968"),
                  Rational("118895030162581094/36028797018963968")};
  for (Rational* c : {&expected.x, &expected.y, &expected.z}) c->canonicalize();
  EXPECT_THAT(found, testing::Contains(expected));
}

TEST(OpenscadGrid, SendsPlanarOperationsThroughTheClippingGrid) {
  const std::string circle = "circle(r = 1.23457, $fn = 5);";
  EXPECT_THAT(corners("linear_extrude(height = 1) { " + circle + " }"),
              testing::Contains(on_grid(323635 * 4, 0, 0)));
  EXPECT_THAT(corners("linear_extrude(height = 1) { group(); " + circle + " }"),
              testing::Contains(on_grid(20227 * 64, 0, 1048576)));
}

// Crossings are rounded by the clipping library in its own way.
TEST(OpenscadGrid, RoundsCrossingsAsTheClippingLibraryDoes) {
  const auto found = corners(
      "linear_extrude(height = 1) { difference() { circle(r = 3, $fn = 7); square(2.34567); } }");
  EXPECT_EQ(found.size(), 22U);
  for (const long z : {0L, 1048576L}) {
    EXPECT_THAT(found,
                testing::IsSupersetOf(
                    {on_grid(122583 * 16, -153714 * 16, z), on_grid(122535 * 16, 153725 * 16, z),
                     on_grid(153725 * 16, 89047 * 16, z), on_grid(-177137 * 16, 85305 * 16, z)}));
  }
}

TEST(OpenscadGrid, OffsetsAsTheClippingLibraryDoes) {
  const auto found = corners(
      "linear_extrude(height = 1) { offset(r = 2, $fn = 20) { square(size = [10, 10]); } }");
  EXPECT_EQ(found.size(), 48U);
  EXPECT_THAT(found, testing::IsSupersetOf({on_grid(-124657 * 16, -40503 * 16, 0),
                                            on_grid(-124657 * 16, 695863 * 16, 0),
                                            on_grid(-106039 * 16, -38521 * 32, 1048576)}));
}

// A cube that is turned and cut has faces of two triangles, which a section shows.
TEST(OpenscadGrid, CutsBodiesBeforeTheirSections) {
  EXPECT_EQ(corners("linear_extrude(height = 1) { projection(cut = true) { " + turn +
                    "{ multmatrix([[1,0,0,0],[0,0.8,-0.6,0],[0,0.6,0.8,0],[0,0,0,1]]) "
                    "{ cube(size = [1, 2, 3], center = true); } } } }")
                .size(),
            12U);
}

TEST(OpenscadGrid, CutsTheConvexOperandsOfAMinkowskiSum) {
  const auto found =
      corners("minkowski() { " + turn +
              "{ cube(size = [1, 2, 3]); } group(); cylinder($fn = 3, h = 0.7, r = 0.3); }");
  std::vector<Point3> expected;
  for (const long z : {314572L, 4194303L}) {
    for (const auto& [x, y] : std::initializer_list<std::pair<long, long>>{{855664, 461575},
                                                                           {-52429, -62713},
                                                                           {1327522, 734003},
                                                                           {-1101004, 1753473},
                                                                           {-1101004, 2298329},
                                                                           {278947, 2550189},
                                                                           {-192911, 2822617}}) {
      expected.push_back(on_grid(x, y, z));
    }
  }
  EXPECT_THAT(found, testing::UnorderedElementsAreArray(expected));
}

// As `corners` of the lower face, in cells of the clipping grid.
std::vector<Point3> plate_on_clipping_grid(std::initializer_list<std::pair<long, long>> outline) {
  std::vector<Point3> result;
  for (const long z : {0L, 1048576L}) {
    for (const auto& [x, y] : outline) result.push_back(on_grid(16 * x, 16 * y, z));
  }
  return result;
}

TEST(OpenscadGrid, AddsPlanarFiguresAsTheClippingLibraryDoes) {
  const auto found = corners(
      "linear_extrude(height = 1) { minkowski() { circle(r = 1.23457, $fn = 5); "
      "square(size = [0.7, 0.3]); circle(r = 0.3, $fn = 3); } }");
  EXPECT_THAT(found,
              testing::UnorderedElementsAreArray(plate_on_clipping_grid({{90537, -76948},
                                                                         {90537, 96608},
                                                                         {61047, 113634},
                                                                         {2 * -37643, 2 * 42121},
                                                                         {2 * -37643, 2 * -32291},
                                                                         {2 * 7586, 2 * -46987},
                                                                         {146443, 0},
                                                                         {146443, 19660},
                                                                         {2 * 7586, 2 * 56817},
                                                                         {61047, -93974}})));
}

TEST(OpenscadGrid, UnitesFacetsToShadowsAsTheClippingLibraryDoes) {
  const auto found = corners("linear_extrude(height = 1) { projection() { " + turn +
                             "{ multmatrix([[1,0,0,0],[0,0.8,-0.6,0],[0,0.6,0.8,0],[0,0,0,1]]) { "
                             "cube(size = [1, 2, 3], center = true); } } "
                             "sphere($fn = 5, r = 1.3); } }");
  EXPECT_THAT(found,
              testing::UnorderedElementsAreArray(plate_on_clipping_grid({{2 * -27601, 2 * 27268},
                                                                         {2 * -10387, 2 * 62988},
                                                                         {-77529, 93208},
                                                                         {22311, -79721},
                                                                         {90637, -66993},
                                                                         {66675, -25491},
                                                                         {4 * 21299, 0},
                                                                         {2 * 4259, 2 * 37620},
                                                                         {26327, 81026},
                                                                         {-68925, -50077},
                                                                         {-68925, 50077},
                                                                         {33881, -99761}})));
}

TEST(OpenscadGrid, RefusesWhatOpenscadRoundsOnTheWay) {
  const std::string frame =
      "difference() { cube(3); multmatrix([[1,0,0,1],[0,1,0,1],"
      "[0,0,1,-1],[0,0,0,1]]) { cube([1, 1, 9]); } }";
  for (const std::string& text :
       {"minkowski() { cube(1); " + frame + " }",
        "linear_extrude(height = 1) { projection() { " + frame + " } }"}) {
    try {
      corners(text);
      ADD_FAILURE() << "accepted: " << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.id(), ErrorId::UnsupportedNode) << error.what();
      EXPECT_TRUE(error.details().position);
    }
  }
}

TEST(OpenscadGrid, RefusesWhatOpenscadsChoicesDecide) {
  ReadOptions options;
  options.rounding = Rounding::OpenScadGrid;
  // A prism over an L whose faces of four and six corners are not planar once turned and cut.
  const std::string prism =
      "polyhedron(points = [[0,0,0],[3,0,0],[3,1,0],[1,1,0],[1,2,0],[0,2,0],"
      "[0,0,1],[3,0,1],[3,1,1],[1,1,1],[1,2,1],[0,2,1]], "
      "faces = [[0,1,2,3,4,5],[11,10,9,8,7,6],[6,7,1,0],[7,8,2,1],[8,9,3,2],[9,10,4,3],[10,11,5,4],"
      "[11,6,0,5]]);";
  const std::string tilt =
      "multmatrix([[0.866025, -0.433013, 0.25, 0.1], [0.5, 0.75, -0.433013, 0.2], "
      "[0, 0.5, 0.866025, 0.3], [0, 0, 0, 1]])";
  EXPECT_EQ(evaluate(read_openscad_csg(prism, "x.csg", options).solid).vertices.size(), 12U);
  try {
    read_openscad_csg(tilt + "{ " + prism + " }", "x.csg", options);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.id(), ErrorId::UnsupportedNode) << error.what();
    EXPECT_TRUE(error.details().position);
  }
}

}  // namespace
}  // namespace exactcsg::io
