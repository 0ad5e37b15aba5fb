// SPDX-License-Identifier: GPL-3.0-or-later
// What primitives keep of the polyhedra that they are made of.

#include <gtest/gtest.h>

#include <algorithm>

#include "exactcsg/solid/boundary.hpp"
#include "exactcsg/solid/evaluate.hpp"
#include "exactcsg/solid/primitive.hpp"
#include "exactcsg/support/error.hpp"
#include "solid/polyhedra.hpp"

namespace exactcsg {
namespace {

const StoredPolyhedron& stored(const Primitive& primitive) { return *polyhedron_of(primitive); }

AffineMap scaling(const Rational& factor) {
  AffineMap map = AffineMap::identity();
  for (std::size_t i = 0; i < 3; ++i) map.m[i][i] = factor;
  return map;
}

TEST(FlatFacets, AreTheFacetsGiven) {
  const std::vector<Facet> given{{4, 1, 2}, {0, 3, 2, 1}, {7, 8, 9, 1, 0}};
  const FlatFacets facets(given);
  ASSERT_EQ(facets.size(), given.size());
  std::size_t f = 0;
  for (const auto facet : facets) {
    EXPECT_TRUE(std::ranges::equal(facet, given[f]));
    EXPECT_TRUE(std::ranges::equal(facets[f], given[f]));
    ++f;
  }
  EXPECT_EQ(f, given.size());
  EXPECT_EQ(facets.corners().size(), 12U);
  EXPECT_TRUE(facets == FlatFacets(given));
  // The same corners, divided otherwise.
  EXPECT_FALSE(facets == FlatFacets(std::vector<Facet>{{4, 1, 2, 0}, {3, 2, 1}, {7, 8, 9, 1, 0}}));
  EXPECT_EQ(FlatFacets().size(), 0U);
}

TEST(StoredPolyhedron, GivesBackWhatItWasMadeOf) {
  const Polyhedron box = test::box_polyhedron(-1, 0, 2, 3, 5, 7);
  const Polyhedron again = to_polyhedron(*make_convex_polytope_unchecked(box).polyhedron);
  EXPECT_EQ(again.vertices, box.vertices);
  EXPECT_EQ(again.facets, box.facets);
}

TEST(StoredPolyhedron, ImagesShareFacetsUnlessTheyMirror) {
  const Primitive box{make_box({0, 0, 0}, {1, 2, 3})};
  const Primitive mesh{make_mesh(test::triangulated(test::box_polyhedron(0, 0, 0, 1, 2, 3)))};
  for (const Primitive& primitive : {box, mesh}) {
    const Primitive moved = apply(test::translation(1, Rational(1, 3), 0), primitive);
    EXPECT_EQ(stored(moved).facets.corners().data(), stored(primitive).facets.corners().data());
    const Primitive mirrored = apply(scaling(-1), primitive);
    const FlatFacets& facets = stored(primitive).facets;
    ASSERT_EQ(stored(mirrored).facets.size(), facets.size());
    for (std::size_t f = 0; f < facets.size(); ++f) {
      std::vector<std::uint32_t> turned(facets[f].begin(), facets[f].end());
      std::ranges::reverse(turned);
      EXPECT_TRUE(std::ranges::equal(stored(mirrored).facets[f], turned));
    }
  }
}

// Far from the origin a polyhedron can be made and mapped, and evaluated where it comes back.
TEST(StoredPolyhedron, IsEvaluatedWithinTheRangeOfDoublesOnly) {
  Integer power;
  mpz_ui_pow_ui(power.get_mpz_t(), 10, 300);
  const Rational far(power);
  const Primitive box{make_box({0, 0, 0}, {1, 1, 1})};
  const Primitive mesh{make_mesh(test::triangulated(test::box_polyhedron(0, 0, 0, 1, 1, 1)))};
  for (const Primitive& primitive : {box, mesh}) {
    const Primitive large = apply(scaling(far), primitive);
    for (std::size_t v = 0; v < stored(primitive).vertices.size(); ++v) {
      const Point3 p = stored(primitive).vertices[v];
      EXPECT_TRUE(stored(large).vertices[v] == (Point3{p.x * far, p.y * far, p.z * far}));
    }
    try {
      evaluate(Solid::primitive(large));
      ADD_FAILURE() << "evaluated";
    } catch (const Error& error) {
      EXPECT_EQ(error.id(), ErrorId::NumberOutOfRange);
    }
    const Primitive back = apply(scaling(Rational(1 / far)), large);
    EXPECT_EQ(digest(evaluate(Solid::primitive(back))),
              digest(evaluate(Solid::primitive(primitive))));
  }
}

TEST(StoredPolyhedron, FacetsOfPolytopesCloseUp) {
  Polyhedron open = test::box_polyhedron(0, 0, 0, 1, 1, 1);
  open.facets.pop_back();
  EXPECT_THROW(ConvexFacets{open}, Error);
  EXPECT_THROW(make_convex_polytope_unchecked(open), Error);
}

// Shapes with the facets of one of them, in other proportions: a triple of corners that spans the
// first one's facet best need not span another's.
TEST(StoredPolyhedron, PolytopesWithTheSameFacetsAreThoseMadeSingly) {
  const Polyhedron box = test::box_polyhedron(0, 0, 0, 1, 1, 1);
  const ConvexFacets facets(box);
  for (const Rational& width : {Rational(1), Rational(1, 1000000007), Rational(7, 3)}) {
    AffineMap map = AffineMap::identity();
    map.m[0] = {width, Rational(1, 3), 0, 5};
    map.m[1] = {0, Rational(1 / width), 0, Rational(1, 7)};
    Polyhedron image = box;
    for (Point3& p : image.vertices) p = apply(map, p);
    const Primitive shared{make_convex_polytope_unchecked(image.vertices, facets)};
    const Primitive single{make_convex_polytope(image)};
    EXPECT_EQ(digest(evaluate(Solid::primitive(shared))),
              digest(evaluate(Solid::primitive(single))));
  }
}

}  // namespace
}  // namespace exactcsg
