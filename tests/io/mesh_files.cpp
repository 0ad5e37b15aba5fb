// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "exactcsg/io/mesh/mesh_file.hpp"
#include "exactcsg/io/mesh/written_surface.hpp"
#include "planar_support.hpp"
#include "temporary_folder.hpp"

namespace exactcsg::io::test {
namespace {

namespace fs = std::filesystem;

class MeshFiles : public ::testing::Test {
 protected:
  PolygonSoup read(const std::string& name, const std::string& bytes) const {
    return read_polygon_soup(folder_.write(name, bytes));
  }

  const exactcsg::test::Folder folder_;
};

Rational one_tenth() { return {1, 10}; }

std::string float_bytes(float value, bool big_endian = false) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  std::string bytes;
  for (unsigned i = 0; i < 4; ++i) {
    bytes += static_cast<char>((bits >> (8 * (big_endian ? 3 - i : i))) & 0xFFU);
  }
  return bytes;
}

// One triangle (0.1, 0, 0), (1, 0, 0), (0, 1, 0).
std::string binary_stl(std::uint32_t announced = 1) {
  std::string bytes = "solid, but binary";
  bytes.resize(80, '\0');
  for (unsigned i = 0; i < 4; ++i) bytes += static_cast<char>((announced >> (8 * i)) & 0xFFU);
  bytes.append(12, '\0');
  for (const float value : {0.1F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F}) {
    bytes += float_bytes(value);
  }
  return bytes + std::string(2, '\0');
}

const std::string ascii_facet =
    "facet normal 0 0 1\n outer loop\n  vertex 0.1 0 0\n  vertex 1 0 0\n  vertex 0 1 0\n"
    " endloop\nendfacet\n";
const std::string ply_header =
    "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n";

TEST_F(MeshFiles, ADecimalMeansThatDecimal) {
  const std::map<std::string, std::string> files{
      {"a.off", "OFF\n3 1 0\n0.1 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
      {"b.off", "OFF 3 1 0\n0.1 0 0\n1 0 0\n0 1 0\n3 0 1 2 \n"},  // as OpenSCAD writes it
      {"c.off", "# c\nOFF # d\n\n# e\n3 1 3\n1e-1 0 0\n1 0 0 # f\n\n0 1 0\n3 0 1 2 255 0 0\n# g\n"},
      {"d.OFF", "\xEF\xBB\xBFOFF\r\n3 1 0\r\n+.1 -0 0.0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2\r\n"},
      {"e.off", "COFF\n3 1 0\n0.1 0 0 255 0 0 1\n1 0 0 1 1 1 1\n0 1 0 0 0 0 1\n3 0 1 2 7\n"},
      {"a.stl", "solid a b\n" + ascii_facet + "endsolid a b\n"},
      {"b.stl", "SOLID\n" + ascii_facet + "ENDSOLID"},
      {"a.obj", "# c\no x\nv 0.1 0 0\nv 1 0 0\nv 0 1 0 1\nvn 0 0 1\nf 1//1 2//1 3//1\n"},
      {"b.obj", "v 0.1 0 0 1 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\ns off\nf -3/1 \\\n -2 -1\n"},
      {"a.ply",
       "ply\nformat ascii 1.0\ncomment x y\n" + ply_header + "0.1 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"}};
  for (const auto& [name, text] : files) {
    const PolygonSoup soup = read(name, text);
    ASSERT_EQ(soup.vertices.size(), 3U) << name;
    EXPECT_EQ(soup.vertices[0].x, one_tenth()) << name;
    EXPECT_EQ(soup.vertices[2], (Point3{0, 1, 0})) << name;
    ASSERT_EQ(soup.facets.size(), 1U) << name;
    EXPECT_EQ(soup.facets[0], (std::vector<std::uint32_t>{0, 1, 2})) << name;
  }
}

TEST_F(MeshFiles, BinaryFilesHoldTheirFloats) {
  const PolygonSoup stl = read("a.stl", binary_stl());
  EXPECT_EQ(stl.format, MeshFormat::StlBinary);
  EXPECT_EQ(stl.vertices[0].x, rational_of(double{0.1F}));
  // The largest coordinate is 1 = 1.0 * 2^0: a unit in the last place is 2^-23.
  EXPECT_EQ(stl.rounding_bound, Rational(1, 1 << 24));
  for (const bool big : {false, true}) {
    std::string body;
    for (const float value : {0.1F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F}) {
      body += float_bytes(value, big);
    }
    body += '\3';
    for (const std::uint32_t v : {0U, 1U, 2U}) body += float_bytes(std::bit_cast<float>(v), big);
    const PolygonSoup ply =
        read("a.ply", std::string("ply\nformat binary_") + (big ? "big" : "little") +
                          "_endian 1.0\n" + ply_header + body);
    EXPECT_EQ(ply.vertices[0].x, rational_of(double{0.1F}));
    EXPECT_EQ(ply.facets[0], (std::vector<std::uint32_t>{0, 1, 2}));
  }
}

TEST_F(MeshFiles, EqualCoordinatesOfStlAreOneVertex) {
  const PolygonSoup soup =
      read("a.stl", "solid\n" + ascii_facet +
                        "facet normal nan nan nan\nouter loop\nvertex 1e-1 0.0 -0\nvertex 0 1 0\n"
                        "vertex 0 0 1\nendloop\nendfacet\nendsolid\nsolid b\n" +
                        ascii_facet + "endsolid b\n");
  EXPECT_EQ(soup.vertices.size(), 4U);
  EXPECT_EQ(soup.facets.size(), 3U);  // nothing else is merged or repaired
  EXPECT_EQ(soup.facets[1], (std::vector<std::uint32_t>{0, 2, 3}));
}

TEST_F(MeshFiles, NonManifoldFacetsAreKept) {
  // Three facets on one edge, and one facet twice: OpenMesh would drop some.
  const PolygonSoup soup =
      read("a.off",
           "OFF\n5 4 0\n0 0 0\n1 0 0\n0 1 0\n0 -1 0\n0 0 1\n3 0 1 2\n3 0 1 3\n3 0 1 4\n3 0 1 2\n");
  EXPECT_EQ(soup.facets.size(), 4U);
}

TEST_F(MeshFiles, RoundingBounds) {
  const auto bound = [&](const std::string& coordinate) {
    return read("a.off", "OFF\n3 1 0\n" + coordinate + " 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
        .rounding_bound;
  };
  // Six digits at 123.456 are units of 0.001; a float32 there has 2^-17.
  EXPECT_EQ(bound("123.456"), Rational(1, 2000) + Rational(1, 1 << 18));
  EXPECT_EQ(bound("5"), Rational(1, 200000) + Rational(1, 1 << 22));
  // Nine digits seen: units of 1e-6.
  EXPECT_EQ(bound("123.456789"), Rational(1, 2000000) + Rational(1, 1 << 18));
  // Seventeen: no float was there.
  EXPECT_EQ(bound("1.2345678901234567"), Rational(1, 2) / Rational("10000000000000000"));
  EXPECT_EQ(bound("100000"),
            Rational(1, 2) + Rational(1, 1 << 8));  // a power of ten counts as it is
}

struct Damaged {
  const char* name;
  std::string bytes;
  ErrorId id;
  std::size_t line;  // 0: no line is named
};

TEST_F(MeshFiles, DamagedFilesAreRefusedByName) {
  const std::string off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  const std::string ply = "ply\nformat ascii 1.0\n" + ply_header;
  const std::vector<Damaged> table{
      {"empty.off", "", ErrorId::EmptyFile, 0},
      {"zip.off", std::string("PK\x03\x04\0\0", 6), ErrorId::UnknownFormat, 0},
      {"zip.stl", std::string("PK\x03\x04") + std::string(200, '\0'), ErrorId::UnknownFormat, 0},
      {"a.txt", off, ErrorId::UnknownFormat, 0},
      {"a", off, ErrorId::UnknownFormat, 0},
      {"stl.off", "solid x\n", ErrorId::UnknownFormat, 1},
      {"binary.off", "OFF BINARY\n\1\2\3", ErrorId::UnknownFormat, 1},
      {"header.off", "OFF", ErrorId::TruncatedInput, 1},
      {"counts.off", "OFF\n3", ErrorId::TruncatedInput, 2},
      {"negative.off", "OFF\n-3 1 0\n0 0 0\n", ErrorId::UnexpectedText, 2},
      {"hostile.off", "OFF\n99999999999999999 1 0\n0 0 0\n", ErrorId::TruncatedInput, 4},
      {"overflow.off", "OFF\n99999999999999999999999 1 0\n0 0 0\n", ErrorId::NumberOutOfRange, 2},
      {"vertex.off", "OFF\n3 1 0\n0 0 0\n1 0\n", ErrorId::TruncatedInput, 5},
      {"word.off", "OFF\n3 1 0\n0 0 zero\n1 0 0\n0 1 0\n3 0 1 2\n", ErrorId::UnexpectedText, 3},
      {"fraction.off", "OFF\n3 1 0\n0 0 1/2\n1 0 0\n0 1 0\n3 0 1 2\n", ErrorId::UnexpectedText, 3},
      {"nan.off", "OFF\n3 1 0\n0 0 nan\n1 0 0\n0 1 0\n3 0 1 2\n", ErrorId::NumberOutOfRange, 3},
      {"inf.off", "OFF\n3 1 0\n0 0 0\n-inf 0 0\n0 1 0\n3 0 1 2\n", ErrorId::NumberOutOfRange, 4},
      {"huge.off", "OFF\n3 1 0\n0 0 1e308\n1 0 0\n0 1 0\n3 0 1 2\n", ErrorId::NumberOutOfRange, 3},
      {"exponent.off", "OFF\n3 1 0\n0 0 1e999999999\n1 0 0\n0 1 0\n3 0 1 2\n",
       ErrorId::NumberOutOfRange, 3},
      {"index.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", ErrorId::UnknownVertex, 6},
      {"minus.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n", ErrorId::UnknownVertex, 6},
      {"two.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n", ErrorId::UnexpectedText, 6},
      {"more.off", off + "3 0 1 2\n", ErrorId::UnexpectedText, 7},
      {"less.off", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", ErrorId::TruncatedInput, 7},
      {"cut.stl", "solid\n" + ascii_facet, ErrorId::TruncatedInput, 9},
      {"cut2.stl", "solid\n" + ascii_facet.substr(0, 60), ErrorId::TruncatedInput, 5},
      {"cut3.stl", binary_stl(2), ErrorId::TruncatedInput, 0},
      {"cut4.stl", binary_stl().substr(0, 100), ErrorId::TruncatedInput, 0},
      {"cut5.stl", binary_stl().substr(0, 50), ErrorId::TruncatedInput, 0},
      {"long.stl", binary_stl(0), ErrorId::UnexpectedText, 0},
      {"nan.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex nan 0 0\n",
       ErrorId::NumberOutOfRange, 4},
      {"quad.stl",
       "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 "
       "1 0\n",
       ErrorId::UnexpectedText, 7},
      {"after.stl", "solid\nendsolid\nnonsense\n", ErrorId::UnexpectedText, 3},
      {"text.stl", "this is no mesh\n", ErrorId::UnknownFormat, 0},
      {"index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", ErrorId::UnknownVertex, 4},
      {"zero.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", ErrorId::UnknownVertex, 4},
      {"back.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -4 -2 -1\n", ErrorId::UnknownVertex, 4},
      {"two.obj", "v 0 0 0\nv 1 0 0\nf 1 2\n# end\n", ErrorId::UnexpectedText, 3},
      {"cut.obj", "v 0 0 0\nv 1 0 0\nv 0 1", ErrorId::TruncatedInput, 3},
      {"cut2.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2", ErrorId::TruncatedInput, 4},
      {"weight.obj", "v 0 0 0 2\n", ErrorId::UnexpectedText, 1},
      {"curve.obj", "cstype bezier\n", ErrorId::UnexpectedText, 1},
      {"nan.obj", "v 0 0 NaN\n", ErrorId::NumberOutOfRange, 1},
      {"text.obj", "f 1/x 2 3\n", ErrorId::UnexpectedText, 1},
      {"no.ply", "obj\n", ErrorId::UnknownFormat, 1},
      {"format.ply", "ply\nformat ebcdic 1.0\n", ErrorId::UnexpectedText, 2},
      {"type.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty real x\n",
       ErrorId::UnexpectedText, 4},
      {"header.ply", "ply\nformat ascii 1.0\nelement vertex 3\n", ErrorId::TruncatedInput, 4},
      {"noz.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n",
       ErrorId::UnexpectedText, 5},
      {"cut.ply", ply + "0 0 0\n1 0 0\n0 1 0\n3 0 1\n", ErrorId::TruncatedInput, 14},
      {"index.ply", ply + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", ErrorId::UnknownVertex, 13},
      {"more.ply", ply + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n7\n", ErrorId::UnexpectedText, 14},
      {"inf.ply", ply + "0 0 0\n1 0 inf\n0 1 0\n3 0 1 2\n", ErrorId::NumberOutOfRange, 11},
      {"binary.ply", "ply\nformat binary_little_endian 1.0\n" + ply_header + "0123",
       ErrorId::TruncatedInput, 0},
  };
  for (const Damaged& damaged : table) {
    try {
      read(damaged.name, damaged.bytes);
      ADD_FAILURE() << damaged.name << " was read";
    } catch (const Error& error) {
      EXPECT_EQ(error.id(), damaged.id) << damaged.name << ": " << error.what();
      ASSERT_TRUE(error.details().position) << damaged.name << ": " << error.what();
      EXPECT_EQ(error.details().position->line, damaged.line) << error.what();
    }
  }
}

TEST_F(MeshFiles, FilesThatAreNone) {
  const auto id_of = [](const fs::path& file) {
    try {
      read_polygon_soup(file);
    } catch (const Error& error) {
      return error.id();
    }
    return ErrorId::Usage;
  };
  EXPECT_EQ(id_of(folder_ / "missing.off"), ErrorId::FileNotReadable);
  fs::create_directories(folder_ / "folder.stl");
  EXPECT_EQ(id_of(folder_ / "folder.stl"), ErrorId::FileNotReadable);
}

// A cut anywhere in a file is refused, or (between two numbers that are both allowed) changes
// nothing but a number: it never gives the whole soup back from less text.
TEST_F(MeshFiles, EveryPrefixOfAFileIsRefusedOrSmaller) {
  const std::map<std::string, std::string> files{
      {"p.off", "OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n3 0 1 3\n"},
      {"p.stl", "solid\n" + ascii_facet + ascii_facet + "endsolid\n"},
      {"q.stl", binary_stl()},
      {"p.ply", "ply\nformat ascii 1.0\n" + ply_header + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"}};
  for (const auto& [name, bytes] : files) {
    for (std::size_t length = 0; length + 2 < bytes.size(); ++length) {
      EXPECT_THROW(read(name, bytes.substr(0, length)), Error) << name << " cut at " << length;
    }
  }
}

// --- boundaries ---

// A square frame in a cube's face: the top face of a cube of side 4 with a blind hole of side 2,
// depth
// 1. Written by hand as a canonical boundary would be: 16 vertices, 11 faces.
Boundary cube_with_hole() {
  Boundary boundary;
  const auto add = [&](int x, int y, int z) {
    // A third, so that no coordinate is a double.
    boundary.vertices.push_back({Rational(x) / 3, Rational(y) / 3, Rational(z) / 3});
  };
  for (const int z : {0, 4}) {
    for (const auto& [x, y] : {std::pair(0, 0), {4, 0}, {4, 4}, {0, 4}}) add(x, y, z);
  }
  for (const int z : {3, 4}) {
    for (const auto& [x, y] : {std::pair(1, 1), {3, 1}, {3, 3}, {1, 3}}) add(x, y, z);
  }
  for (const Point3& p : boundary.vertices) {
    boundary.approximate.push_back({nearest_double(p.x), nearest_double(p.y), nearest_double(p.z)});
  }
  const auto face = [&](std::vector<std::vector<std::uint32_t>> loops) {
    boundary.faces.push_back({boundary.plane_count++, std::move(loops)});
  };
  face({{0, 3, 2, 1}});
  face({{4, 5, 6, 7}, {12, 15, 14, 13}});
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t j = (i + 1) % 4;
    face({{i, j, 4 + j, 4 + i}});
    face({{8 + j, 8 + i, 12 + i, 12 + j}});
  }
  face({{8, 9, 10, 11}});
  return boundary;
}

Rational volume_of(const std::vector<Point3>& vertices,
                   const std::vector<std::vector<std::uint32_t>>& facets) {
  return volume(Polyhedron{vertices, facets});
}

bool edges_balance(const std::vector<std::vector<std::uint32_t>>& facets) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
  for (const auto& facet : facets) {
    for (std::size_t i = 0; i < facet.size(); ++i) {
      const std::uint32_t a = facet[i];
      const std::uint32_t b = facet[(i + 1) % facet.size()];
      balance[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  }
  return std::all_of(balance.begin(), balance.end(), [](const auto& e) { return e.second == 0; });
}

TEST(MeshTriangulate, FacesWithHolesWithoutNewVertices) {
  const Boundary boundary = cube_with_hole();
  std::vector<std::vector<std::uint32_t>> facets;
  for (const auto& t : triangulate(boundary)) facets.push_back({t.begin(), t.end()});
  // A closed surface of genus 0 with V vertices has 2 V - 4 triangles.
  EXPECT_EQ(facets.size(), 2U * 16 - 4);
  EXPECT_TRUE(edges_balance(facets));
  EXPECT_EQ(volume_of(to_vector(boundary.vertices), facets), Rational(64 - 4) / 27);
  make_mesh({to_vector(boundary.vertices), facets});  // planar, closed, not crossing
}

TEST(MeshTriangulate, FacesThatTouchThemselvesAndAreTilted) {
  // A pinched ring and a bow tie's two lobes on a tilted plane: the area is kept.
  const std::vector<std::vector<std::vector<std::uint32_t>>> shapes{
      {{0, 1, 2, 3}, {0, 4, 5, 6}},  // a hole that touches the outer loop in vertex 0
      {{0, 1, 4, 3, 2, 4}},          // one loop through vertex 4 twice
  };
  const std::vector<std::vector<Point2>> points{
      {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {1, 3}, {3, 3}, {3, 1}},
      {{0, 0}, {2, 0}, {0, 2}, {2, 2}, {1, 1}}};
  const std::vector<Rational> areas{16 - 6, 2};
  for (std::size_t s = 0; s < shapes.size(); ++s) {
    Boundary boundary;
    for (const Point2& p : points[s]) {
      boundary.vertices.push_back({p.x, p.y, (p.x + 2 * p.y) / 7});
      const Point3& q = boundary.vertices.back();
      boundary.approximate.push_back(
          {nearest_double(q.x), nearest_double(q.y), nearest_double(q.z)});
    }
    boundary.plane_count = 1;
    boundary.faces.push_back({0, shapes[s]});
    Rational sum = 0;
    for (const auto& t : triangulate(boundary)) {
      const Rational part = area(Path{points[s][t[0]], points[s][t[1]], points[s][t[2]]});
      EXPECT_GT(part, 0);
      sum += part;
    }
    EXPECT_EQ(sum, areas[s]);
  }
}

TEST_F(MeshFiles, WritesWhatItReads) {
  const Boundary boundary = cube_with_hole();
  for (const std::string name : {"w.off", "w.obj", "w.ply", "w.stl"}) {
    const fs::path file = folder_ / name;
    const WriteReport report = write_boundary(boundary, file);
    EXPECT_EQ(report.triangles, 28U);
    EXPECT_EQ(report.merged_vertices, 0U);
    EXPECT_EQ(report.degenerate_triangles, 0U);
    const PolygonSoup soup = read_polygon_soup(file);
    EXPECT_EQ(soup.facets.size(), 28U);
    EXPECT_EQ(soup.vertices.size(), 16U);
    EXPECT_TRUE(edges_balance(soup.facets));
    // Thirds are rounded: by half a unit of 4/3 at most, 2^-53 or 2^-24.
    const double unit = name == "w.stl" ? std::ldexp(1, -24) : std::ldexp(1, -53);
    EXPECT_GT(report.largest_rounding, 0);
    EXPECT_LE(report.largest_rounding, unit);
    for (std::size_t v = 0; v < soup.vertices.size() && name != "w.stl"; ++v) {
      // 17 digits give the double back: the decimal is nearest to no other.
      EXPECT_EQ(nearest_double(soup.vertices[v].x), boundary.approximate[v][0]);
    }
    EXPECT_NEAR(volume_of(soup.vertices, soup.facets).get_d(), 60.0 / 27, 1e-5);

    // A second opinion: OpenMesh reads the same closed surface.
    OpenMesh::PolyMesh_ArrayKernelT<> mesh;
    ASSERT_TRUE(OpenMesh::IO::read_mesh(mesh, file.string())) << name;
    EXPECT_EQ(mesh.n_faces(), 28U) << name;
    EXPECT_EQ(mesh.n_vertices(), 16U) << name;
    for (const auto edge : mesh.edges()) EXPECT_FALSE(mesh.is_boundary(edge)) << name;
  }
}

TEST_F(MeshFiles, TheReportCountsWhatRoundingDoes) {
  // A tetrahedron thinner than float32 resolves: far from the origin two vertices merge, and the
  // two triangles on that edge have no area any more; the other two become equal up to sense.
  Boundary boundary;
  const Rational tiny(1, 1 << 20);
  boundary.vertices = {{1000, 0, 0}, {1000 + tiny, 0, 0}, {1000, 1, 0}, {1000, 0, 1}};
  for (const Point3& p : boundary.vertices) {
    boundary.approximate.push_back({nearest_double(p.x), nearest_double(p.y), nearest_double(p.z)});
  }
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    boundary.faces.push_back({boundary.plane_count++, {{a, b, c}}});
  };
  add(0, 2, 1);
  add(0, 1, 3);
  add(0, 3, 2);
  add(1, 2, 3);
  const WriteReport single = write_boundary(boundary, folder_ / "t.stl");
  EXPECT_EQ(single.merged_vertices, 1U);
  EXPECT_EQ(single.degenerate_triangles, 2U);
  EXPECT_EQ(single.largest_rounding, std::ldexp(1, -20));
  const WriteReport exact = write_boundary(boundary, folder_ / "t.off");
  EXPECT_EQ(exact.merged_vertices, 0U);
  EXPECT_EQ(exact.degenerate_triangles, 0U);
  EXPECT_EQ(exact.largest_rounding, 0);
}

// Expected: what the change does to a cube with a hole, by its construction.
TEST_F(MeshFiles, FindsWhatRoundingDoesToASurface) {
  const fs::path file = folder_ / "r.off";
  write_boundary(cube_with_hole(), file);
  const PolygonSoup sound = read_polygon_soup(file);
  EXPECT_FALSE(fault_of(sound));
  EXPECT_EQ(count_pieces(sound), 1U);
  EXPECT_EQ(count_pieces(cube_with_hole()), 1U);

  const auto fault_id = [](const PolygonSoup& soup) {
    const std::optional<Error> fault = fault_of(soup);
    return fault ? fault->id() : ErrorId::Usage;
  };
  PolygonSoup open = sound;
  open.facets.pop_back();
  EXPECT_EQ(fault_id(open), ErrorId::OpenMesh);

  PolygonSoup inverted = sound;
  for (auto& facet : inverted.facets) std::swap(facet[0], facet[1]);
  EXPECT_EQ(fault_id(inverted), ErrorId::InvertedMesh);

  PolygonSoup crossing = sound;
  crossing.vertices.front().x += 5;
  EXPECT_EQ(fault_id(crossing), ErrorId::SelfIntersectingMesh);

  // A facet whose corners come to lie on a line.
  PolygonSoup flat = sound;
  const auto& corners = flat.facets.front();
  const Point3 p = flat.vertices[corners[0]];
  const Point3 q = flat.vertices[corners[1]];
  flat.vertices[corners[2]] = {(p.x + q.x) / 2, (p.y + q.y) / 2, (p.z + q.z) / 2};
  EXPECT_EQ(fault_id(flat), ErrorId::DegenerateFacet);

  // Two bodies that come to touch are one piece.
  PolygonSoup two = sound;
  const auto count = static_cast<std::uint32_t>(sound.vertices.size());
  for (const Point3& v : sound.vertices) two.vertices.push_back({v.x + 10, v.y, v.z});
  for (auto facet : sound.facets) {
    for (std::uint32_t& v : facet) v += count;
    two.facets.push_back(facet);
  }
  EXPECT_EQ(count_pieces(two), 2U);
  EXPECT_FALSE(fault_of(two));
  two.vertices[count] = two.vertices[0];
  EXPECT_EQ(count_pieces(two), 1U);
}

TEST_F(MeshFiles, WritingIsRefusedByName) {
  const auto id_of = [&](const fs::path& file) {
    try {
      write_boundary(cube_with_hole(), file);
    } catch (const Error& error) {
      return error.id();
    }
    return ErrorId::Usage;
  };
  EXPECT_EQ(id_of(folder_ / "a.step"), ErrorId::UnknownFormat);
  EXPECT_EQ(id_of(folder_ / "no/folder/a.off"), ErrorId::FileNotWritable);
}

}  // namespace
}  // namespace exactcsg::io::test
