// SPDX-License-Identifier: GPL-3.0-or-later
// What a scene says of facets, checked in rational arithmetic against the polyhedra it was made of.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "exactcsg/solid/prepared_polyhedron.hpp"
#include "exactcsg/solid/primitive_in_parallel.hpp"
#include "exactcsg/solid/scene.hpp"
#include "exactcsg/support/error.hpp"
#include "solid/polyhedra.hpp"

namespace exactcsg {
namespace {

Solid united(const std::vector<Primitive>& primitives) {
  std::vector<Solid> leaves;
  for (const Primitive& primitive : primitives) leaves.push_back(Solid::primitive(primitive));
  return Solid::compose(csg::BooleanOperator::Union, std::move(leaves));
}

// A pyramid over a convex polygon of so many corners on a parabola.
Polyhedron pyramid(int corners) {
  Polyhedron result;
  Facet base;
  for (int i = 0; i < corners; ++i) {
    result.vertices.push_back({i, i * (corners - 1 - i), 0});
    base.push_back(static_cast<std::uint32_t>(i));
  }
  result.vertices.push_back({Rational(corners, 3), 1, 5});
  const auto apex = static_cast<std::uint32_t>(corners);
  // The parabola opens downwards: the corners go round clockwise seen from above.
  for (std::uint32_t i = 0; i < apex; ++i) result.facets.push_back({(i + 1) % apex, i, apex});
  result.facets.push_back(base);
  return result;
}

// Boxes side by side that share corners but no facet.
Polyhedron two_boxes_at_an_edge() {
  return test::together(test::box_polyhedron(0, 0, 0, 1, 1, 1),
                        test::box_polyhedron(1, 1, 0, 2, 2, 1));
}

Primitive mesh(Polyhedron polyhedron) { return {make_mesh(std::move(polyhedron))}; }
Primitive polytope(const Polyhedron& polyhedron) {
  return {make_convex_polytope_unchecked(polyhedron)};
}

// Both senses of sides, coplanar neighbours, corners with many sides, copies that are and are not
// translated by a double, copies of other proportions, and a half-space between them.
std::vector<Primitive> primitives() {
  const Primitive box = polytope(test::box_polyhedron(0, 0, 0, 3, 2, 1));
  const Primitive triangles = mesh(test::triangulated(test::box_polyhedron(0, 0, 0, 3, 2, 1)));
  const Primitive flat = mesh(test::triangulated(pyramid(40)));
  AffineMap squeezed = AffineMap::identity();
  squeezed.m[0][0] = Rational(1, 1000000);
  squeezed.m[1] = {Rational(1, 3), 1000, 0, 7};
  return {box,
          apply(test::translation(1, 2, Rational(1, 2)), box),
          apply(squeezed, box),
          triangles,
          apply(test::translation(5, 0, Rational(1, 4)), triangles),
          {make_half_space(1, 2, 3, -4)},
          apply(test::translation(Rational(1, 3), 0, 0), triangles),
          flat,
          apply(test::translation(0, 64, 0), flat),
          apply(squeezed, flat),
          polytope(pyramid(50)),
          apply(test::translation(Rational(1, 3), 0, 8), polytope(pyramid(50))),
          mesh(two_boxes_at_an_edge())};
}

const StoredPolyhedron& polyhedron(const Primitive& primitive) { return *polyhedron_of(primitive); }

TEST(Scene, FacetsHaveTheCornersAndThePlanesOfThePolyhedra) {
  const std::vector<Primitive> given = primitives();
  const Scene scene = make_scene(united(given));
  ASSERT_EQ(scene.primitives.size(), given.size());
  for (PrimitiveIndex p = 0; p < given.size(); ++p) {
    const ScenePrimitive& primitive = scene.primitives[p];
    if (polyhedron_of(given[p]) == nullptr) {
      const SceneFacet& facet = scene.facets[primitive.first_facet];
      EXPECT_TRUE(facet.is_half_space);
      EXPECT_EQ(scene.geometry.exact_plane(facet.plane.plane), (Plane{1, 2, 3, -4}));
      continue;
    }
    const FlatFacets& facets = polyhedron(given[p]).facets;
    ASSERT_EQ(primitive.facet_count, facets.size());
    for (FacetIndex f = 0; f < facets.size(); ++f) {
      const SceneFacet& facet = scene.facets[primitive.first_facet + f];
      const CornerView corners = scene.corners_of(facet);
      EXPECT_EQ(facet.primitive, p);
      ASSERT_EQ(corners.size(), facets[f].size());
      Plane outward = scene.geometry.exact_plane(facet.plane.plane);
      if (facet.plane.sense < 0) outward = opposite(outward);
      bool has_turn = false;
      for (std::size_t i = 0; i < corners.size(); ++i) {
        const Point3 from = scene.geometry.exact_point(corners.vertex(i));
        const Point3 to = scene.geometry.exact_point(corners.vertex((i + 1) % corners.size()));
        const Point3 last = scene.geometry.exact_point(corners.vertex((i + 2) % corners.size()));
        EXPECT_EQ(from, polyhedron(given[p]).vertices[facets[f][i]]);
        EXPECT_EQ(side(outward, from), Sign::Zero);
        // Counter-clockwise seen from outside, or straight on.
        const Vector3 normal = cross(to - from, last - to);
        const Vector3 own{outward.a, outward.b, outward.c};
        EXPECT_GE(dot(normal, own), 0);
        has_turn = has_turn || dot(normal, own) > 0;
        const Plane across = scene.geometry.exact_plane(corners.side_plane(i));
        EXPECT_NE(corners.side_plane(i), facet.plane.plane);
        EXPECT_EQ(side(across, from), Sign::Zero);
        EXPECT_EQ(side(across, to), Sign::Zero);
      }
      EXPECT_TRUE(has_turn);
    }
  }
}

// A triangulated box has six planes, and its translated copies have planes of their own.
TEST(Scene, CoplanarNeighboursShareAPlane) {
  const Primitive box = mesh(test::triangulated(test::box_polyhedron(0, 0, 0, 3, 2, 1)));
  for (const Rational& by : {Rational(10), Rational(31, 3)}) {
    const Scene scene = make_scene(united({box, apply(test::translation(by, by, by), box)}));
    ASSERT_EQ(scene.facets.size(), 24U);
    for (std::size_t first : {0U, 12U}) {
      std::vector<OrientedPlaneRef> planes;
      for (std::size_t f = 0; f < 12; ++f) planes.push_back(scene.facets[first + f].plane);
      std::ranges::sort(planes);
      planes.erase(std::ranges::unique(planes).begin(), planes.end());
      EXPECT_EQ(planes.size(), 6U);
    }
  }
}

// Nor do primitives: large ones are prepared by several threads.
TEST(Scene, DoesNotDependOnThreads) {
  const Polyhedron large = test::triangulated(pyramid(4000));
  const auto united_copies = [&](unsigned threads) {
    const Primitive first{PolyhedralMesh{store_mesh(large, threads)}};
    return united({first, apply(test::translation(0, 0, 64), first, threads),
                   apply(test::translation(0, 0, Rational(1, 3)), first, threads)});
  };
  const std::array<std::array<Solid, 2>, 2> solids{
      {{united(primitives()), united(primitives())}, {united_copies(1), united_copies(3)}}};
  for (const auto& [by_one, by_several] : solids) {
    const Scene scene = make_scene(by_one, 1);
    const Scene other = make_scene(by_several, 3);
    EXPECT_EQ(scene.corners, other.corners);
    EXPECT_EQ(scene.root.lower, other.root.lower);
    EXPECT_EQ(scene.root.upper, other.root.upper);
    ASSERT_EQ(scene.facets.size(), other.facets.size());
    for (std::size_t f = 0; f < scene.facets.size(); ++f) {
      EXPECT_EQ(scene.facets[f].plane, other.facets[f].plane);
      EXPECT_EQ(scene.facets[f].first_corner, other.facets[f].first_corner);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(scene.bounds.facets[axis][f].lower, other.bounds.facets[axis][f].lower);
        EXPECT_EQ(scene.bounds.facets[axis][f].upper, other.bounds.facets[axis][f].upper);
      }
    }
  }
}

// LAW of SceneBounds, and the points in the root cell.
TEST(Scene, BoundsHoldTheCorners) {
  const std::vector<Primitive> given = primitives();
  const Scene scene = make_scene(united(given));
  for (const SceneFacet& facet : scene.facets) {
    if (facet.is_half_space) continue;
    const auto f = static_cast<std::size_t>(&facet - scene.facets.data());
    const CornerView corners = scene.corners_of(facet);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Point3 point = scene.geometry.exact_point(corners.vertex(i));
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const Range& bounds :
             {scene.bounds.facets[axis][f], scene.bounds.primitives[axis][facet.primitive]}) {
          EXPECT_LE(rational_of(bounds.lower), coordinate(point, axis));
          EXPECT_GE(rational_of(bounds.upper), coordinate(point, axis));
        }
        EXPECT_LT(rational_of(scene.root.lower[axis]), coordinate(point, axis));
        EXPECT_GT(rational_of(scene.root.upper[axis]), coordinate(point, axis));
      }
    }
  }
}

TEST(Scene, RefusesCoordinatesThatDoublesCannotHold) {
  const Rational far(Integer(1) << 1100);
  const Solid solid = Solid::primitive({make_box({0, 0, 0}, {1, 1, far})});
  for (const unsigned threads : {1U, 2U}) {
    try {
      make_scene(solid, threads);
      FAIL();
    } catch (const Error& error) {
      EXPECT_EQ(error.id(), ErrorId::NumberOutOfRange);
    }
  }
}

}  // namespace
}  // namespace exactcsg
