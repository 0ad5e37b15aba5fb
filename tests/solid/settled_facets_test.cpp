// SPDX-License-Identifier: GPL-3.0-or-later
// Facets and edges that bypass merging against the same solids written so that none does: each body
// in parts, whose facets share planes. LAW boundary.1. On a small grid every way of touching
// occurs.
#include <gtest/gtest.h>

#include <random>

#include "exactcsg/solid/evaluate.hpp"
#include "exactcsg/solid/primitive.hpp"

namespace exactcsg {
namespace {

using Body = std::array<Point3, 4>;

Rational volume_of(const Body& t) { return dot(cross(t[1] - t[0], t[2] - t[0]), t[3] - t[0]); }

Body random_body(std::mt19937& random, int size) {
  std::uniform_int_distribution<int> coordinate(0, size);
  Body body;
  do {
    for (Point3& p : body) p = {coordinate(random), coordinate(random), coordinate(random)};
  } while (volume_of(body) == 0);
  if (volume_of(body) < 0) std::swap(body[2], body[3]);
  return body;
}

Polyhedron tetrahedron_of(const Body& body) {
  return {{body.begin(), body.end()}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

// As a polytope, or as a mesh.
Solid whole(const Body& body, bool as_mesh) {
  if (as_mesh) return Solid::primitive({make_mesh(tetrahedron_of(body))});
  return Solid::primitive({make_convex_polytope(tetrahedron_of(body))});
}

// On either side of the plane through an edge and the middle of the opposite one.
Solid in_halves(const Body& body) {
  const Point3 middle{(body[2].x + body[3].x) / 2, (body[2].y + body[3].y) / 2,
                      (body[2].z + body[3].z) / 2};
  return csg::unite(whole({body[0], body[1], body[2], middle}, false),
                    whole({body[0], body[1], middle, body[3]}, false));
}

// Covered twice, so that every plane of the body has several facets.
Solid in_parts(const Body& body) {
  return csg::unite(in_halves(body), in_halves({body[2], body[3], body[0], body[1]}));
}

class SettledFacetsOnAGrid : public ::testing::TestWithParam<int> {};

TEST_P(SettledFacetsOnAGrid, AreTheBoundaryThatMergingFinds) {
  std::mt19937 random(2026);
  std::uniform_int_distribution<int> choice(0, 3);
  for (int round = 0; round < 300; ++round) {
    Solid direct;
    Solid merged;
    for (int i = 0; i < 4; ++i) {
      const Body body = random_body(random, GetParam());
      const bool as_mesh = choice(random) == 0;
      if (i > 0 && choice(random) == 0) {
        direct = csg::subtract(direct, whole(body, as_mesh));
        merged = csg::subtract(merged, in_parts(body));
      } else {
        direct = csg::unite(direct, whole(body, as_mesh));
        merged = csg::unite(merged, in_parts(body));
      }
    }
    // Small cells, so that some hold facets of one body only.
    EvaluateOptions options;
    options.facets_per_cell = static_cast<std::size_t>(3 + round % 12);
    const Boundary a = evaluate(direct, options);
    const Boundary b = evaluate(merged);
    ASSERT_EQ(a.vertices, b.vertices) << round;
    ASSERT_EQ(a.edges, b.edges) << round;
    ASSERT_EQ(digest(a), digest(b)) << round;
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, SettledFacetsOnAGrid, ::testing::Values(2, 3, 4, 8));

}  // namespace
}  // namespace exactcsg
