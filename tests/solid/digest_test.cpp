// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <numeric>

#include "exactcsg/solid/boundary.hpp"
#include "solid/boundary_builder.hpp"

namespace exactcsg {
namespace {

using namespace test;

// The value is what the Python program in docs/digest.md prints, which shares no code with ours.
TEST(Digest, UnitCubeAsADocumentReaderRecomputesIt) {
  EXPECT_EQ(digest(boundary_of_cells({{0, 0, 0}})),
            "5fc5968064ce6f99d77bad4c023810045ff2d2390f8d9aaba46175ca7b531b67");
}

// By the same program with the corners of a box that is not a cube, and `format(numerator, "x")`,
// "/" and the same of the denominator, unless that is 1, for each coordinate: numbers of several
// limbs that show every digit, and denominators of all kinds.
TEST(Digest, LongNumbersAsADocumentReaderRecomputesThem) {
  const auto hexadecimal = [](const char* numerator, const char* denominator) {
    Rational value(Integer(numerator, 16), Integer(denominator, 16));
    value.canonicalize();
    return value;
  };
  const Point3 low{hexadecimal("-123456789abcdef0fedcba9876543210a5", "7"), 0,
                   hexadecimal("1", "400000000000000000")};
  const Point3 high{hexadecimal("10", "3"),
                    hexadecimal("fedcba98765432100123456789abcdef", "abcdef0123456789b"),
                    hexadecimal("deadbeef0badf00d00000000000000000000001", "8")};
  EXPECT_EQ(digest(boundary_of(to_polyhedron(*make_box(low, high).polyhedron))),
            "36b50d345949b2519a6295507a115c3b37bbdec0f609e9d5a88cfd29b2f8a493");
}

// sha256sum of "exactcsg.boundary/3\nvertices 0\nedges 0\nplanes 0\nsides 0\n"
TEST(Digest, TheEmptySolid) {
  EXPECT_EQ(digest(Boundary{}), "7136f9c332a27f3f2a34a7fcaf8a91b98783e3f429c9a593a1304b5bc8ce68b6");
}

TEST(Digest, TellsSolidsApart) {
  const std::string cube = digest(boundary_of_cells({{0, 0, 0}}));
  EXPECT_EQ(cube, digest(boundary_of(to_polyhedron(*make_box({0, 0, 0}, {1, 1, 1}).polyhedron))));
  EXPECT_NE(cube, digest(boundary_of_cells({{0, 0, 1}})));
  EXPECT_NE(cube,
            digest(boundary_of(to_polyhedron(
                *make_box({0, 0, 0}, {1, 1, 1 + parse_rational("1e-30").value()}).polyhedron))));
}

// LAW digest.2
TEST(Digest, DoesNotDependOnOrder) {
  const Boundary b = boundary_of_cells(without(block({0, 0, 0}, {3, 3, 1}), {{1, 1, 0}}));
  Boundary shuffled = b;
  const auto n = static_cast<std::uint32_t>(b.vertices.size());
  const auto renamed = [&](std::uint32_t v) { return n - 1 - v; };
  std::vector<Point3> vertices = to_vector(b.vertices);
  std::reverse(vertices.begin(), vertices.end());
  shuffled.vertices = ExactPoints(vertices);
  std::reverse(shuffled.approximate.begin(), shuffled.approximate.end());
  std::reverse(shuffled.edges.begin(), shuffled.edges.end());
  for (BoundaryEdge& e : shuffled.edges) e = {renamed(e.to), renamed(e.from)};
  std::reverse(shuffled.faces.begin(), shuffled.faces.end());
  for (BoundaryFace& f : shuffled.faces) {
    f.plane = b.plane_count - 1 - f.plane;
    std::reverse(f.loops.begin(), f.loops.end());
    for (auto& loop : f.loops) {
      for (auto& v : loop) v = renamed(v);
      std::rotate(loop.begin(), loop.begin() + 1, loop.end());
    }
  }
  EXPECT_EQ(digest(shuffled), digest(b));
}

// Six cubes round a place that is filled or not: the same vertices, edges and (thanks to six more
// cubes elsewhere) oriented planes. LAW digest.1 needs the sides.
TEST(Digest, VerticesEdgesAndPlanesAreNotEnough) {
  const std::set<Cell> arms{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1},
                            {1, 5, 5}, {-1, 5, 5}, {5, 1, 5}, {5, -1, 5}, {5, 5, 1}, {5, 5, -1}};
  const Boundary hollow = boundary_of_cells(arms);
  const Boundary filled = boundary_of_cells(with(arms, {{0, 0, 0}}));
  EXPECT_EQ(hollow.vertices, filled.vertices);
  EXPECT_EQ(hollow.edges, filled.edges);
  EXPECT_EQ(sorted_planes(hollow), sorted_planes(filled));
  EXPECT_NE(digest(hollow), digest(filled));
  EXPECT_EQ(topology(hollow).cavities, 1U);
  EXPECT_EQ(topology(filled).cavities, 0U);
}

}  // namespace
}  // namespace exactcsg
