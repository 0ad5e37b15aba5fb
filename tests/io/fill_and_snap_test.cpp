// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes that meet themselves, read with a rule for their inside, by closed forms; and boundaries
// rounded to single precision and repaired, by the independent examination of the result.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include "exactcsg/io/mesh/snap.hpp"
#include "exactcsg/io/mesh/written_surface.hpp"
#include "exactcsg/io/model.hpp"
#include "exactcsg/solid/evaluate.hpp"
#include "exactcsg/solid/measures.hpp"
#include "temporary_folder.hpp"
#include "two_cubes.hpp"

namespace exactcsg::io {
namespace {

namespace fs = std::filesystem;

class FillAndSnap : public testing::Test {
 protected:
  const exactcsg::test::Folder folder_;
};

ErrorId refusal(const fs::path& file) {
  try {
    read_model(file);
  } catch (const Error& error) {
    return error.id();
  }
  return ErrorId::InternalError;
}

Rational filled_volume(const fs::path& file, FillRule rule) {
  ReadOptions options;
  options.fill = rule;
  const Boundary boundary = evaluate(read_model(file, options).solid);
  return boundary.empty() ? Rational(0) : exact_volume(boundary).value();
}

using exactcsg::test::two_cubes;

TEST_F(FillAndSnap, MeshFileOfTwoCubes) {
  const fs::path file = folder_.write("cubes.off", two_cubes);
  EXPECT_EQ(refusal(file), ErrorId::SelfIntersectingMesh);
  EXPECT_EQ(filled_volume(file, FillRule::NonZero), 15);
  EXPECT_EQ(filled_volume(file, FillRule::Positive), 15);
  EXPECT_EQ(filled_volume(file, FillRule::EvenOdd), 14);
  ReadOptions options;
  options.fill = FillRule::NonZero;
  EXPECT_EQ(read_model(file, options).warnings.size(), 1U);
}

TEST_F(FillAndSnap, ImportedMeshIsMovedWithItsNode) {
  folder_.write("cubes.off", two_cubes);
  const fs::path file = folder_.write("part.csg",
                                      "difference() {\n"
                                      "multmatrix([[2,0,0,5],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) {\n"
                                      "import(file = \"cubes.off\");\n}\n"
                                      "cube(size = [100, 100, 1]);\n}\n");
  EXPECT_EQ(refusal(file), ErrorId::SelfIntersectingMesh);
  // 15, less the lower half of the first cube, twice as long.
  EXPECT_EQ(filled_volume(file, FillRule::NonZero), 2 * (15 - 4));
}

// The outline of the ends crosses itself in the middle of the unit square; OpenSCAD's faces are
// clockwise seen from outside. One of the triangles, of area 1/4, is inside out.
TEST_F(FillAndSnap, PolyhedronWithFacesThatCrossThemselves) {
  const fs::path file = folder_.write(
      "bow_tie.csg",
      "polyhedron(points = [[0,0,0],[1,1,0],[1,0,0],[0,1,0],[0,0,1],[1,1,1],[1,0,1],[0,1,1]],\n"
      " faces = [[0,1,2,3],[7,6,5,4],[4,5,1,0],[5,6,2,1],[6,7,3,2],[7,4,0,3]]);\n");
  EXPECT_NE(refusal(file), ErrorId::InternalError);
  EXPECT_EQ(filled_volume(file, FillRule::NonZero), Rational(1, 2));
  EXPECT_EQ(filled_volume(file, FillRule::EvenOdd), Rational(1, 2));
  EXPECT_EQ(filled_volume(file, FillRule::Positive), Rational(1, 4));
}

// LAW mesh.1: a sound mesh is what it is; one that is inside out is turned round or empty.
TEST_F(FillAndSnap, CubesThatDoNotMeetThemselves) {
  const std::string points = "polyhedron(points = [[0,0,0],[1,0,0],[0,1,0],[0,0,1]], faces = ";
  const fs::path sound =
      folder_.write("sound.csg", points + "[[0,1,2],[0,3,1],[0,2,3],[1,3,2]]);\n");
  const fs::path inverted =
      folder_.write("inverted.csg", points + "[[2,1,0],[1,3,0],[3,2,0],[2,3,1]]);\n");
  EXPECT_EQ(refusal(inverted), ErrorId::InvertedMesh);
  EXPECT_EQ(filled_volume(sound, FillRule::Positive), Rational(1, 6));
  EXPECT_EQ(filled_volume(inverted, FillRule::NonZero), Rational(1, 6));
  EXPECT_EQ(filled_volume(inverted, FillRule::Positive), 0);
}

TEST_F(FillAndSnap, ExtrusionTwistedUntilItsSidesCross) {
  const fs::path file = folder_.write("twisted.csg",
                                      "linear_extrude(height = 1, twist = 180, slices = 1) {\n"
                                      "polygon(points = [[3,0],[4,0],[4,1],[3,1]], "
                                      "paths = [[0,1,2,3]]);\n}\n");
  EXPECT_EQ(refusal(file), ErrorId::SelfIntersectingMesh);
  const Rational nonzero = filled_volume(file, FillRule::NonZero);
  EXPECT_GT(nonzero, 0);
  EXPECT_LT(nonzero, 16);  // within the box round both ends
}

Boundary boundary_of_model(const std::string& name) {
  return evaluate(
      read_model(fs::path(EXACTCSG_SOURCE_DIR) / "data" / "openscad" / (name + ".csg")).solid);
}

Polyhedron polyhedron_of(const RoundedSurface& surface) {
  Polyhedron result;
  for (const auto& p : surface.points) {
    result.vertices.push_back({rational_of(p[0]), rational_of(p[1]), rational_of(p[2])});
  }
  for (const auto& [a, b, c] : surface.triangles) result.facets.push_back({a, b, c});
  return result;
}

Rational volume_of(const Polyhedron& mesh) {
  Rational six = 0;
  const Point3 origin{0, 0, 0};
  for (const Facet& f : mesh.facets) {
    six += dot(mesh.vertices[f[0]] - origin,
               cross(mesh.vertices[f[1]] - origin, mesh.vertices[f[2]] - origin));
  }
  return six / 6;
}

void expect_sound(const SnappedSurface& snapped, bool single_precision) {
  const SurfaceFinding finding = examine(polyhedron_of(snapped.surface));
  EXPECT_FALSE(finding.fault) << finding.fault->what();
  for (const auto& point : snapped.surface.points) {
    for (const double value : point) {
      if (single_precision) {
        EXPECT_EQ(value, double{static_cast<float>(value)});
      }
    }
  }
}

// LAW snap.1, on the models whose rounding to single precision has facets without area.
TEST_F(FillAndSnap, ModelsThatSinglePrecisionBreaks) {
  for (const char* name : {"near_coplanar_turns", "near_coplanar_cuts", "knurled_knob"}) {
    const Boundary boundary = boundary_of_model(name);
    const fs::path plain = folder_ / "plain.stl";
    write_boundary(boundary, plain);
    EXPECT_TRUE(fault_of(read_polygon_soup(plain))) << name;
    const SnappedSurface snapped = snap(boundary, true);
    expect_sound(snapped, true);
    const fs::path file = folder_ / "snapped.stl";
    write_surface(snapped.surface, file);
    const PolygonSoup soup = read_polygon_soup(file);
    EXPECT_FALSE(fault_of(soup)) << name;
    EXPECT_LE(count_pieces(soup), count_pieces(boundary)) << name;  // thin ones may be lost
    // Within half a unit in the last place of 128, and the volume that such a layer can have.
    EXPECT_LE(snapped.largest_move, 0x1p-17) << name;
    const Enclosure volume = enclose_volume(boundary, 128);
    const Enclosure area = enclose_area(boundary, 128);
    EXPECT_LE(std::abs(snapped.volume_change), 4 * 0x1p-17 * area.upper.get_d()) << name;
    EXPECT_NEAR(volume_of(polyhedron_of(snapped.surface)).get_d(),
                volume.lower.get_d() + snapped.volume_change, 1e-9 * volume.lower.get_d());
  }
}

// LAW snap.2
TEST_F(FillAndSnap, SoundRoundingIsLeftAlone) {
  const Boundary boundary = boundary_of_model("bracket");
  write_boundary(boundary, folder_ / "plain.stl");
  const SnappedSurface snapped = snap(boundary, true);
  EXPECT_EQ(snapped.rounds, 0U);
  EXPECT_EQ(snapped.flat_triangles, 0U);
  write_surface(snapped.surface, folder_ / "snapped.stl");
  const PolygonSoup plain = read_polygon_soup(folder_ / "plain.stl");
  const PolygonSoup again = read_polygon_soup(folder_ / "snapped.stl");
  EXPECT_EQ(plain.vertices, again.vertices);
  EXPECT_EQ(plain.facets, again.facets);
}

Solid box(const Point3& lower, const Point3& upper) {
  return Solid::primitive({make_box(lower, upper)});
}

// Facing sides that fall together vanish: 1000 + 1.
TEST_F(FillAndSnap, GapThatClosesIsNone) {
  const Rational gap = Rational(1) / 1'000'000'000;
  const Boundary boundary = evaluate(
      csg::unite(box({0, 0, 0}, {1000, 1, 1}), box({1000 + gap, 0, 0}, {1001 + gap, 1, 1})));
  const SnappedSurface snapped = snap(boundary, true);
  expect_sound(snapped, true);
  EXPECT_EQ(volume_of(polyhedron_of(snapped.surface)), 1001);
}

TEST_F(FillAndSnap, BodyThatVanishesIsRefused) {
  const Rational thin = Rational(1) / 1'000'000'000;
  const Boundary plate = evaluate(box({0, 0, 1000}, {1, 1, 1000 + thin}));
  try {
    snap(plate, true);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.id(), ErrorId::DegenerateFacet);
  }
  expect_sound(snap(plate, false), false);
}

// Tetrahedra of a size of sixteen units in the last place: hardly a facet stays where it was.
TEST_F(FillAndSnap, UnionsOfBodiesHardlyLargerThanTheGrid) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> coordinate(0, 9999);
  int repaired = 0;
  for (int round = 0; round < 12; ++round) {
    Solid solid;
    for (int i = 0; i < 6; ++i) {
      std::array<Point3, 4> p;
      for (Point3& q : p) {
        const auto value = [&]() -> Rational {
          return 1'000'000 + Rational(coordinate(random)) / 10'000;
        };
        q = {value(), value(), value()};
      }
      if (dot(cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0]) < 0) std::swap(p[2], p[3]);
      const Solid body = Solid::primitive({make_convex_polytope(
          Polyhedron{{p.begin(), p.end()}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}})});
      solid = i == 0 ? body : csg::unite(solid, body);
    }
    const SnappedSurface snapped = snap(evaluate(solid), true);
    expect_sound(snapped, true);
    if (snapped.rounds > 0) ++repaired;
  }
  EXPECT_GE(repaired, 10);
}

}  // namespace
}  // namespace exactcsg::io
