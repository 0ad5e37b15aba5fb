// SPDX-License-Identifier: GPL-3.0-or-later
// The constructors of primitives: what they accept, and each error their contract names.
#include "exactcsg/solid/primitive.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <set>

#include "exactcsg/solid/primitive_in_parallel.hpp"
#include "exactcsg/support/error.hpp"
#include "solid/polyhedra.hpp"
#include "time_limits.hpp"

namespace exactcsg {
namespace {

using namespace test;

// Six times the volume by the divergence theorem, in rationals only.
Rational six_volumes(const Polyhedron& p) {
  Rational sum = 0;
  const Point3 origin{0, 0, 0};
  for (const Facet& f : p.facets) {
    for (std::size_t k = 2; k < f.size(); ++k) {
      sum += dot(p.vertices[f[0]] - origin,
                 cross(p.vertices[f[k - 1]] - origin, p.vertices[f[k]] - origin));
    }
  }
  return sum;
}

template <class Action>
Error error_of(Action action) {
  try {
    action();
  } catch (const Error& e) {
    return e;
  }
  ADD_FAILURE() << "nothing was thrown";
  return Error(ErrorId::InternalError, {});
}

#define EXPECT_REFUSED(expression, error_id) \
  EXPECT_EQ(error_of([&] { (void)(expression); }).id(), ErrorId::error_id)

Polyhedron tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

// A closed grid surface: the torus-like or sphere-like tessellation with n x m quads in triangles.
Polyhedron double_sphere(unsigned n) {
  Polyhedron s;
  s.vertices.push_back({0, 0, 1});
  const auto ring = [&](unsigned i, unsigned j) { return 1 + (i - 1) * n + j % n; };
  for (unsigned i = 1; i < n; ++i) {
    for (unsigned j = 0; j < n; ++j) {
      const double u = 3.14159265358979 * i / n;
      const double v = 6.28318530717959 * j / n;
      s.vertices.push_back({rational_of(std::sin(u) * std::cos(v)),
                            rational_of(std::sin(u) * std::sin(v)), rational_of(std::cos(u))});
    }
  }
  s.vertices.push_back({0, 0, -1});
  const auto last = static_cast<std::uint32_t>(s.vertices.size() - 1);
  for (unsigned j = 0; j < n; ++j) {
    s.facets.push_back({0, ring(1, j), ring(1, j + 1)});
    for (unsigned i = 1; i + 1 < n; ++i) {
      s.facets.push_back({ring(i, j), ring(i + 1, j), ring(i + 1, j + 1)});
      s.facets.push_back({ring(i, j), ring(i + 1, j + 1), ring(i, j + 1)});
    }
    s.facets.push_back({ring(n - 1, j), last, ring(n - 1, j + 1)});
  }
  return s;
}

TEST(MakeBox, HasTheVolumeOfItsSides) {
  const ConvexPolytope box = make_box({0, 0, 0}, {2, 3, Rational(5, 7)});
  EXPECT_EQ(six_volumes(to_polyhedron(*box.polyhedron)), 6 * Rational(30, 7));
  // The checked constructor agrees that it is a convex polytope with these facets.
  const ConvexPolytope checked = make_convex_polytope(to_polyhedron(*box.polyhedron));
  EXPECT_EQ(checked.polyhedron->facets.size(), 6U);
  EXPECT_EQ(checked.polyhedron->vertices.size(), 8U);
}

TEST(MakeBox, RefusesFlatAndReversedBoxes) {
  EXPECT_REFUSED(make_box({0, 0, 0}, {1, 1, 0}), FlatPolytope);
  EXPECT_REFUSED(make_box({0, 0, 0}, {1, -1, 1}), FlatPolytope);
}

TEST(MakeHalfSpace, HasCoprimeCoefficients) {
  // x/2 + y/3 - 1 <= 0 is 3 x + 2 y - 6 <= 0.
  const HalfSpace h = make_half_space({1, 2}, {1, 3}, 0, -1);
  EXPECT_EQ(h.plane, (Plane{3, 2, 0, -6}));
  EXPECT_REFUSED(make_half_space(0, 0, 0, 1), DegenerateHalfSpace);
}

TEST(MakeConvexPolytope, MergesCoplanarNeighbours) {
  const ConvexPolytope box = make_convex_polytope(triangulated(box_polyhedron(0, 0, 0, 1, 2, 3)));
  EXPECT_EQ(box.polyhedron->facets.size(), 6U);
  EXPECT_EQ(box.polyhedron->vertices.size(), 8U);
  EXPECT_EQ(six_volumes(to_polyhedron(*box.polyhedron)), 36);
}

TEST(MakeConvexPolytope, DropsVerticesInTheMiddleOfSides) {
  // A cube whose top has a vertex in its middle and one in the middle of a side.
  Polyhedron p = box_polyhedron(0, 0, 0, 2, 2, 2);
  p.vertices.push_back({1, 1, 2});
  p.vertices.push_back({1, 0, 2});
  p.facets = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 9, 4}, {2, 6, 7, 3}, {0, 2, 3, 1},
              {4, 9, 8},    {9, 5, 8},    {5, 7, 8},       {7, 6, 8},    {6, 4, 8}};
  const ConvexPolytope cube = make_convex_polytope(p);
  EXPECT_EQ(cube.polyhedron->vertices.size(), 8U);
  EXPECT_EQ(cube.polyhedron->facets.size(), 6U);
  EXPECT_EQ(six_volumes(to_polyhedron(*cube.polyhedron)), 48);
}

TEST(MakeConvexPolytope, JoinsEqualVertices) {
  Polyhedron soup;  // every triangle with vertices of its own
  const Polyhedron t = tetrahedron();
  for (const Facet& f : t.facets) {
    Facet own;
    for (const auto v : f) {
      own.push_back(static_cast<std::uint32_t>(soup.vertices.size()));
      soup.vertices.push_back(t.vertices[v]);
    }
    soup.facets.push_back(own);
  }
  EXPECT_EQ(make_convex_polytope(soup).polyhedron->vertices.size(), 4U);
}

TEST(MakeConvexPolytope, RefusesWithTheErrorsOfItsContract) {
  Polyhedron p = tetrahedron();
  p.facets[1] = {0, 1, 9};
  EXPECT_REFUSED(make_convex_polytope(p), UnknownVertex);

  p = tetrahedron();
  p.facets[1] = {0, 1, 1};
  EXPECT_REFUSED(make_convex_polytope(p), DegenerateFacet);
  p.facets[1] = {0, 1};
  EXPECT_REFUSED(make_convex_polytope(p), DegenerateFacet);
  p = tetrahedron();
  p.vertices.push_back({2, 0, 0});
  p.facets.push_back({0, 1, 4});
  EXPECT_REFUSED(make_convex_polytope(p), DegenerateFacet);

  p = box_polyhedron(0, 0, 0, 1, 1, 1);
  // One part in 10^30 off the plane: no double sees it.
  p.vertices[7].z += parse_rational("1e-30").value();
  EXPECT_REFUSED(make_convex_polytope(p), NonPlanarFacet);

  // A quadrilateral with an inward corner, and a pentagram, whose turns all go left.
  p = {{{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}, {0, 0, 4}}, {{0, 1, 2, 3}}};
  EXPECT_REFUSED(make_convex_polytope(p), NonConvexFacet);
  p = {{{0, 3, 0}, {-3, 1, 0}, {-2, -3, 0}, {2, -3, 0}, {3, 1, 0}}, {{0, 2, 4, 1, 3}}};
  EXPECT_REFUSED(make_convex_polytope(p), NonConvexFacet);
  // A spike: straight on, but backwards.
  p = {{{0, 0, 0}, {2, 0, 0}, {1, 0, 0}, {1, 1, 0}}, {{0, 1, 2, 3}}};
  EXPECT_REFUSED(make_convex_polytope(p), NonConvexFacet);

  p = tetrahedron();
  p.facets.pop_back();
  EXPECT_REFUSED(make_convex_polytope(p), OpenMesh);
  EXPECT_REFUSED(make_convex_polytope(Polyhedron{}), OpenMesh);

  EXPECT_REFUSED(make_convex_polytope(reversed(tetrahedron())), InvertedMesh);

  // A tetrahedron's face pushed in: a point below the middle of {1, 2, 3}.
  p = tetrahedron();
  p.vertices.push_back({{1, 5}, {1, 5}, {1, 5}});
  p.facets = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 4}, {2, 3, 4}, {3, 1, 4}};
  EXPECT_REFUSED(make_convex_polytope(p), NotConvex);
  EXPECT_REFUSED(make_convex_polytope(together(tetrahedron(), box_polyhedron(5, 5, 5, 6, 6, 6))),
                 NotConvex);
  // The same tetrahedron twice is not one convex set's boundary.
  EXPECT_REFUSED(make_convex_polytope(together(tetrahedron(), tetrahedron())), NotConvex);

  p = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}};
  EXPECT_REFUSED(make_convex_polytope(p), FlatPolytope);
}

// Two cubes, one inside of the other: every edge is convex, a point lies inside of all planes, and
// only the ray of Mehlhorn et al. tells.
TEST(MakeConvexPolytope, RefusesACubeInACube) {
  EXPECT_REFUSED(make_convex_polytope(
                     together(box_polyhedron(1, 1, 1, 2, 2, 2), box_polyhedron(0, 0, 0, 3, 3, 3))),
                 NotConvex);
  EXPECT_REFUSED(make_convex_polytope(
                     together(box_polyhedron(0, 0, 0, 3, 3, 3), box_polyhedron(1, 1, 1, 2, 2, 2))),
                 NotConvex);
}

TEST(MakeConvexPolytope, MessagesNameFacetAndCoordinates) {
  Polyhedron p = box_polyhedron(0, 0, 0, 1, 1, 1);
  p.vertices[7].z = Rational(3, 2);
  const Error e = error_of([&] { make_convex_polytope(p); });
  EXPECT_NE(std::string(e.what()).find("facet 5"), std::string::npos) << e.what();
  EXPECT_NE(std::string(e.what()).find("(1, 1, 3/2)"), std::string::npos) << e.what();
}

std::vector<HalfSpace> unit_cube_half_spaces() {
  return {make_half_space(1, 0, 0, -1), make_half_space(0, 1, 0, -1), make_half_space(0, 0, 1, -1),
          make_half_space(-1, 0, 0, 0), make_half_space(0, -1, 0, 0), make_half_space(0, 0, -1, 0)};
}

TEST(HalfSpaceIntersection, CubeWithRedundantAndRepeatedPlanes) {
  std::vector<HalfSpace> h = unit_cube_half_spaces();
  h.push_back(h[0]);
  h.push_back(make_half_space(1, 0, 0, -7));  // redundant
  h.push_back(make_half_space(1, 1, 1, -3));  // touches at one vertex
  h.push_back(make_half_space(1, 1, 0, -2));  // touches along an edge
  const ConvexPolytope cube = make_convex_polytope(h);
  EXPECT_EQ(cube.polyhedron->facets.size(), 6U);
  EXPECT_EQ(six_volumes(to_polyhedron(*cube.polyhedron)), 6);
}

TEST(HalfSpaceIntersection, CutCorner) {
  // x + y + z <= 5/2 cuts a corner with legs 1/2 from the unit cube: 1 - 1/48.
  std::vector<HalfSpace> h = unit_cube_half_spaces();
  h.push_back(make_half_space(2, 2, 2, -5));
  const ConvexPolytope p = make_convex_polytope(h);
  EXPECT_EQ(p.polyhedron->facets.size(), 7U);
  EXPECT_EQ(p.polyhedron->vertices.size(), 10U);
  EXPECT_EQ(six_volumes(to_polyhedron(*p.polyhedron)), 6 * Rational(47, 48));
}

TEST(HalfSpaceIntersection, RefusesUnboundedAndFlatSets) {
  std::vector<HalfSpace> h = unit_cube_half_spaces();
  EXPECT_REFUSED(make_convex_polytope(std::span<const HalfSpace>{}), UnboundedSolid);
  EXPECT_REFUSED(make_convex_polytope(std::span(h).first(1)), UnboundedSolid);
  EXPECT_REFUSED(make_convex_polytope(std::span(h).first(3)), UnboundedSolid);
  EXPECT_REFUSED(make_convex_polytope(std::span(h).first(5)), UnboundedSolid);
  h.push_back(make_half_space(1, 0, 0, 0));  // x <= 0: a square is left
  EXPECT_REFUSED(make_convex_polytope(h), FlatPolytope);
  h.back() = make_half_space(1, 1, 1, 0);  // a point is left
  EXPECT_REFUSED(make_convex_polytope(h), FlatPolytope);
  h.back() = make_half_space(1, 0, 0, 1);  // nothing is left
  EXPECT_REFUSED(make_convex_polytope(h), FlatPolytope);
  // Unbounded, but without interior: the plane x = 0.
  EXPECT_REFUSED(make_convex_polytope(std::vector<HalfSpace>{make_half_space(1, 0, 0, 0),
                                                             make_half_space(-1, 0, 0, 0)}),
                 FlatPolytope);
}

TEST(MakeMesh, AcceptsWhatItsContractAllows) {
  EXPECT_NO_THROW(make_mesh(box_polyhedron(0, 0, 0, 1, 1, 1)));
  EXPECT_NO_THROW(make_mesh(triangulated(box_polyhedron(0, 0, 0, 1, 1, 1))));
  // Two boxes that share one edge, and two that share one vertex: touching along common edges and
  // at common vertices is allowed.
  EXPECT_NO_THROW(
      make_mesh(together(box_polyhedron(0, 0, 0, 1, 1, 1), box_polyhedron(1, 1, 0, 2, 2, 1))));
  EXPECT_NO_THROW(
      make_mesh(together(box_polyhedron(0, 0, 0, 1, 1, 1), box_polyhedron(1, 1, 1, 2, 2, 2))));
  // A cavity faces inwards.
  const PolyhedralMesh hollow = make_mesh(
      together(box_polyhedron(0, 0, 0, 3, 3, 3), reversed(box_polyhedron(1, 1, 1, 2, 2, 2))));
  EXPECT_EQ(six_volumes(to_polyhedron(*hollow.polyhedron)), 6 * (27 - 1));
  // An island in a cavity.
  EXPECT_NO_THROW(make_mesh(together(
      together(box_polyhedron(0, 0, 0, 9, 9, 9), reversed(box_polyhedron(1, 1, 1, 8, 8, 8))),
      box_polyhedron(3, 3, 3, 4, 4, 4))));
  // A vertex in the middle of a straight side, shared by both neighbours.
  Polyhedron p = box_polyhedron(0, 0, 0, 2, 2, 2);
  p.vertices.push_back({1, 0, 2});
  p.facets[2] = {0, 1, 5, 8, 4};
  p.facets[5] = {4, 8, 5, 7, 6};
  EXPECT_NO_THROW(make_mesh(p));
}

TEST(MakeMesh, RefusesWithTheErrorsOfItsContract) {
  Polyhedron p = tetrahedron();
  p.facets[1] = {0, 1, 9};
  EXPECT_REFUSED(make_mesh(p), UnknownVertex);
  p.facets[1] = {0, 1, 0};
  EXPECT_REFUSED(make_mesh(p), DegenerateFacet);
  p = box_polyhedron(0, 0, 0, 1, 1, 1);
  p.vertices[7].z += parse_rational("1e-30").value();
  EXPECT_REFUSED(make_mesh(p), NonPlanarFacet);
  p = {{{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}, {0, 0, 4}}, {{0, 1, 2, 3}}};
  EXPECT_REFUSED(make_mesh(p), NonConvexFacet);
  p = tetrahedron();
  p.facets.pop_back();
  EXPECT_REFUSED(make_mesh(p), OpenMesh);
  p = tetrahedron();
  std::reverse(p.facets[2].begin(), p.facets[2].end());
  EXPECT_REFUSED(make_mesh(p), OpenMesh);
  EXPECT_REFUSED(make_mesh(reversed(tetrahedron())), InvertedMesh);
  EXPECT_REFUSED(make_mesh_unchecked(reversed(tetrahedron())), InvertedMesh);
  EXPECT_REFUSED(make_mesh_unchecked(Polyhedron{}), OpenMesh);
}

TEST(MakeMesh, RefusesShellsThatFaceTheWrongWay) {
  // The volume is positive in both cases; only winding numbers tell.
  EXPECT_REFUSED(
      make_mesh(together(box_polyhedron(0, 0, 0, 3, 3, 3), box_polyhedron(1, 1, 1, 2, 2, 2))),
      InvertedMesh);
  EXPECT_REFUSED(make_mesh(together(box_polyhedron(0, 0, 0, 3, 3, 3),
                                    reversed(box_polyhedron(5, 5, 5, 6, 6, 6)))),
                 InvertedMesh);
}

TEST(MakeMesh, RefusesFacetsThatCross) {
  const Polyhedron cube = box_polyhedron(0, 0, 0, 2, 2, 2);
  const auto with = [&](const Polyhedron& other) { return together(cube, other); };
  // Overlapping corners; a bar through; one cube's vertex in the middle of the other's facet, of
  // its edge; an edge along the middle of a facet; facets that overlap, wholly or in part; an edge
  // that lies on a part of a longer one.
  EXPECT_REFUSED(make_mesh(with(box_polyhedron(1, 1, 1, 3, 3, 3))), SelfIntersectingMesh);
  EXPECT_REFUSED(
      make_mesh(with(to_polyhedron(*make_box({{1, 2}, {1, 2}, -1}, {1, 1, 3}).polyhedron))),
      SelfIntersectingMesh);
  EXPECT_REFUSED(make_mesh(with(box_polyhedron(2, 0, 0, 3, 2, 2))), SelfIntersectingMesh);
  EXPECT_REFUSED(make_mesh(with(box_polyhedron(2, 1, 1, 3, 3, 3))), SelfIntersectingMesh);
  EXPECT_REFUSED(make_mesh(with(box_polyhedron(2, 2, 0, 3, 3, 1))), SelfIntersectingMesh);
  EXPECT_REFUSED(make_mesh(with(box_polyhedron(2, 2, 1, 3, 3, 3))), SelfIntersectingMesh);
  const auto tip = [](Point3 p) {  // a tetrahedron beyond x = 2 with its tip at p
    return Polyhedron{{std::move(p), {4, 0, 0}, {4, 1, 0}, {4, 0, 1}},
                      {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  };
  EXPECT_REFUSED(make_mesh(with(tip({2, 1, 1}))), SelfIntersectingMesh);
  EXPECT_REFUSED(make_mesh(with(tip({2, 1, 0}))), SelfIntersectingMesh);
  // At a common vertex, and one part in 10^30 away: both are fine; as much inside is not.
  EXPECT_NO_THROW(make_mesh(with(tip({2, 0, 0}))));
  const Rational tiny = parse_rational("1e-30").value();
  EXPECT_NO_THROW(make_mesh(with(tip({2 + tiny, 1, 1}))));
  EXPECT_REFUSED(make_mesh(with(tip({2 - tiny, 1, 1}))), SelfIntersectingMesh);
  // A sheet of no thickness: two tetrahedra glued to both sides of one triangle.
  EXPECT_REFUSED(make_mesh(together(tetrahedron(), {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}},
                                                    {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}})),
                 SelfIntersectingMesh);
}

// Facets that share a vertex and still cross.
TEST(MakeMesh, RefusesCrossingAtACommonVertex) {
  const Polyhedron a{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}},
                     {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  const Polyhedron b{{{0, 0, 0}, {1, 1, 1}, {-2, 1, 0}, {0, 1, -2}},
                     {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  const Polyhedron outward = six_volumes(b) > 0 ? b : reversed(b);
  EXPECT_REFUSED(make_mesh(together(a, outward)), SelfIntersectingMesh);
}

// A second, slower opinion: the crossing test against brute force in rationals on random pairs of
// triangles with small coordinates, where every degeneracy occurs.
class RandomPairs : public ::testing::Test {
 protected:
  std::uint64_t state_ = 20240229;
  int next(int count) {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<int>((state_ >> 33U) % static_cast<std::uint64_t>(count));
  }
};

// Is there a point in the two closed triangles that is not on a common vertex or edge? By linear
// programming in the plain sense: intersect the triangles by clipping the first one's polygon by
// the second one's plane (a segment) or, in one plane, by its sides.
std::vector<Point3> clip_closed(std::vector<Point3> polygon, const Vector3& normal,
                                const Point3& origin) {
  std::vector<Point3> inside;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Point3& p = polygon[k];
    const Point3& q = polygon[(k + 1) % polygon.size()];
    const Rational s = dot(normal, p - origin);
    const Rational t = dot(normal, q - origin);
    if (sgn(s) <= 0) inside.push_back(p);
    if (sgn(s) * sgn(t) < 0) inside.push_back(p + Rational(s / (s - t)) * (q - p));
  }
  return inside;
}

bool meets_improperly(const std::vector<Point3>& f, const std::vector<Point3>& g) {
  std::vector<Point3> common = f;
  const Vector3 n = cross(g[1] - g[0], g[2] - g[0]);
  common = clip_closed(common, n, g[0]);
  common = clip_closed(common, Rational(-1) * n, g[0]);
  for (std::size_t k = 0; k < g.size(); ++k) {
    common = clip_closed(common, cross(g[(k + 1) % g.size()] - g[k], n), g[k]);
  }
  std::vector<Point3> distinct;
  for (const Point3& p : common) {
    if (std::find(distinct.begin(), distinct.end(), p) == distinct.end()) distinct.push_back(p);
  }
  // Proper: nothing, one common vertex, or a common edge.
  const auto vertex_of = [](const std::vector<Point3>& t, const Point3& p) {
    return std::find(t.begin(), t.end(), p) != t.end();
  };
  const auto edge_of = [](const std::vector<Point3>& t, const Point3& p, const Point3& q) {
    for (std::size_t k = 0; k < t.size(); ++k) {
      const Point3& next = t[(k + 1) % t.size()];
      if ((t[k] == p && next == q) || (t[k] == q && next == p)) return true;
    }
    return false;
  };
  if (distinct.size() > 2) {
    // More than two points: collinear ones between two common vertices would be no vertex.
    return true;
  }
  if (distinct.size() == 2) {
    return !edge_of(f, distinct[0], distinct[1]) || !edge_of(g, distinct[0], distinct[1]);
  }
  return std::any_of(distinct.begin(), distinct.end(),
                     [&](const Point3& p) { return !vertex_of(f, p) || !vertex_of(g, p); });
}

TEST_F(RandomPairs, AgreeWithClippingInRationals) {
  int improper = 0;
  int proper = 0;
  for (int round = 0; round < 2400; ++round) {
    // Two thin doubled triangles are no mesh; so pad each to a tetrahedron and keep the pairs of
    // tetrahedra whose boundaries meet properly, by brute force over all pairs of facets. Of
    // parallelepipeds there are facets of four corners.
    const int grid = 2 + round % 4;
    const bool boxes = round % 8 >= 4;
    std::array<Polyhedron, 2> solids;
    for (Polyhedron& s : solids) {
      do {
        const auto point = [&] { return Point3{next(grid), next(grid), next(grid)}; };
        s = tetrahedron();
        for (Point3& p : s.vertices) p = point();
        if (!boxes) continue;
        const std::vector<Point3> corners = s.vertices;
        s = box_polyhedron(0, 0, 0, 1, 1, 1);
        for (std::size_t i = 0; i < s.vertices.size(); ++i) {
          Point3 p = corners[0];
          for (std::size_t axis = 0; axis < 3; ++axis) {
            if ((i >> axis & 1U) != 0) p = p + (corners[axis + 1] - corners[0]);
          }
          s.vertices[i] = p;
        }
      } while (six_volumes(s) == 0);
      if (six_volumes(s) < 0) s = reversed(s);
    }
    bool expected = true;
    for (const Facet& f : solids[0].facets) {
      for (const Facet& g : solids[1].facets) {
        const auto corners = [](const Polyhedron& p, const Facet& x) {
          std::vector<Point3> points;
          for (const std::uint32_t v : x) points.push_back(p.vertices[v]);
          return points;
        };
        if (meets_improperly(corners(solids[0], f), corners(solids[1], g))) expected = false;
      }
    }
    bool accepted = true;
    try {
      make_mesh(together(solids[0], solids[1]));
    } catch (const Error& e) {
      // One tetrahedron inside of the other does not cross, but winds twice.
      accepted = e.id() == ErrorId::InvertedMesh;
      EXPECT_TRUE(e.id() == ErrorId::InvertedMesh || e.id() == ErrorId::SelfIntersectingMesh)
          << e.what();
    }
    EXPECT_EQ(accepted, expected) << "round " << round;
    ++(expected ? proper : improper);
  }
  EXPECT_GT(proper, 60);
  EXPECT_GT(improper, 200);
}

// What a single thread says of a mesh with several faults is what is to be said of it.
TEST(MakeMesh, DoesNotDependOnTheNumberOfThreads) {
  const auto told_of = [](const Polyhedron& polyhedron, unsigned threads) -> std::string {
    try {
      const PolyhedralMesh mesh = make_mesh(polyhedron, threads);
      const PolyhedralMesh expected = make_mesh(polyhedron);
      EXPECT_TRUE(mesh.polyhedron->facets == expected.polyhedron->facets);
      EXPECT_TRUE(mesh.polyhedron->vertices == expected.polyhedron->vertices);
      return "";
    } catch (const Error& error) {
      return error.what();
    }
  };
  const Polyhedron sphere = double_sphere(80);  // 12 640 triangles
  Polyhedron folded = sphere;                   // facets that come to a vertex twice
  for (const std::size_t f : {9001U, 3001U, 6001U}) folded.facets[f][2] = folded.facets[f][1];
  Polyhedron crossed = sphere;  // vertices pulled through the opposite side
  for (const std::size_t v : {5000U, 700U, 2900U}) {
    Point3& p = crossed.vertices[v];
    p = {Rational(-2 * p.x), Rational(-2 * p.y), Rational(-2 * p.z)};
  }
  for (const Polyhedron* polyhedron : {&sphere, &std::as_const(folded), &std::as_const(crossed)}) {
    const std::string expected = told_of(*polyhedron, 1);
    EXPECT_EQ(expected.empty(), polyhedron == &sphere) << expected;
    for (const unsigned threads : {2U, 0U}) EXPECT_EQ(told_of(*polyhedron, threads), expected);
  }
  // The first facet that is degenerate is named.
  EXPECT_NE(told_of(folded, 2).find("facet 3001"), std::string::npos) << told_of(folded, 2);
}

TEST(MakeMesh, LargeMeshIsFast) {
  const Polyhedron sphere = double_sphere(160);  // 50 880 triangles
  const auto start = std::chrono::steady_clock::now();
  EXPECT_NO_THROW(make_mesh(sphere));
  const auto seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start);
  // Loose: an order of magnitude above what it takes, far below anything quadratic.
  EXPECT_LT(seconds.count(), 20 * test::sanitizer_slowdown);
}

AffineMap scaling(const Rational& x, const Rational& y, const Rational& z) {
  AffineMap map = AffineMap::identity();
  map.m[0][0] = x;
  map.m[1][1] = y;
  map.m[2][2] = z;
  return map;
}

TEST(ApplyMap, MultipliesVolumesByTheDeterminant) {
  AffineMap shear = scaling(2, {1, 3}, 5);
  shear.m[0][1] = Rational(7, 2);
  shear.m[2][3] = -4;
  const Primitive mesh{make_mesh(tetrahedron()), "part.csg:1:2"};
  const Primitive image = apply(shear, mesh);
  EXPECT_EQ(image.origin, "part.csg:1:2");
  EXPECT_EQ(six_volumes(to_polyhedron(*std::get<PolyhedralMesh>(image.shape).polyhedron)),
            Rational(10, 3));
}

TEST(ApplyMap, TurnsFacetsRoundIfItMirrors) {
  const Primitive box{make_box({0, 0, 0}, {1, 2, 3})};
  const Primitive image = apply(scaling(-1, 1, 1), box);
  const ConvexPolytope& polytope = std::get<ConvexPolytope>(image.shape);
  EXPECT_EQ(six_volumes(to_polyhedron(*polytope.polyhedron)), 36);
  EXPECT_NO_THROW(make_convex_polytope(to_polyhedron(*polytope.polyhedron)));
}

TEST(ApplyMap, MapsHalfSpaces) {
  // x <= 1 mirrored and doubled: x >= -2.
  const Primitive image = apply(scaling(-2, 1, 1), {make_half_space(1, 0, 0, -1)});
  EXPECT_EQ(std::get<HalfSpace>(image.shape).plane, (Plane{-1, 0, 0, -2}));
}

TEST(ApplyMap, IdentityKeepsTheHandleAndSingularMapsAreRefused) {
  const Primitive box{make_box({0, 0, 0}, {1, 1, 1})};
  const Primitive same = apply(AffineMap::identity(), box);
  EXPECT_EQ(std::get<ConvexPolytope>(same.shape).polyhedron,
            std::get<ConvexPolytope>(box.shape).polyhedron);
  EXPECT_REFUSED(apply(scaling(1, 0, 1), box), SingularMap);
  EXPECT_REFUSED(apply(scaling(0, 1, 1), {make_half_space(1, 0, 0, -1)}), SingularMap);
}

}  // namespace
}  // namespace exactcsg
