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
    ASSERT_TRUE(a.vertices == b.vertices) << round;
    ASSERT_EQ(a.edges, b.edges) << round;
    ASSERT_EQ(digest(a), digest(b)) << round;
  }
}

// A piece of land: over every square of a grid four triangles around the square's middle, whose
// height is the mean. With heights of few values, planes of triangles that do not touch each other
// often have a line or a point in common with others.
class Land {
 public:
  // Askew: with planes that are not those of another one.
  Land(std::mt19937& random, bool askew) : askew_(askew) {
    std::uniform_int_distribution<int> height(1, 3);
    for (int x = 0; x <= size; ++x) {
      for (int y = 0; y <= size; ++y) {
        corners_.push_back({x, y, height(random)});
        feet_.push_back({x, y, 0});
      }
    }
  }

  static constexpr int size = 4;

  Polyhedron as_mesh() const {
    Polyhedron mesh{corners_, {}};
    mesh.vertices.insert(mesh.vertices.end(), feet_.begin(), feet_.end());
    const auto feet = static_cast<std::uint32_t>(corners_.size());
    for_each_square([&](const Square& around) {
      const auto middle = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.push_back(middle_of(around));
      mesh.facets.push_back(
          {feet + around[3], feet + around[2], feet + around[1], feet + around[0]});
      for (std::size_t k = 0; k < 4; ++k) {
        const std::uint32_t a = around[k];
        const std::uint32_t b = around[(k + 1) % 4];
        mesh.facets.push_back({a, b, middle});
        if (is_rim(a, b)) mesh.facets.push_back({feet + a, feet + b, b, a});
      }
    });
    return placed(mesh);
  }

  // As columns below the triangles, which share planes.
  Solid in_columns() const {
    Solid columns;
    for_each_square([&](const Square& around) {
      const Point3 middle = middle_of(around);
      for (std::size_t k = 0; k < 4; ++k) {
        const std::array<Point3, 3> top{corners_[around[k]], corners_[around[(k + 1) % 4]], middle};
        Polyhedron column;
        for (const Point3& p : top) column.vertices.push_back({p.x, p.y, 0});
        column.vertices.insert(column.vertices.end(), top.begin(), top.end());
        column.facets = {{2, 1, 0}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}};
        columns = csg::unite(columns, Solid::primitive({make_convex_polytope(placed(column))}));
      }
    });
    return columns;
  }

 private:
  using Square = std::array<std::uint32_t, 4>;

  // Counter-clockwise seen from above.
  template <class Take>
  static void for_each_square(const Take& take) {
    constexpr std::uint32_t row = size + 1;
    for (std::uint32_t x = 0; x < size; ++x) {
      for (std::uint32_t y = 0; y < size; ++y) {
        const std::uint32_t first = x * row + y;
        take(Square{first, first + row, first + row + 1, first + 1});
      }
    }
  }

  Polyhedron placed(Polyhedron body) const {
    if (!askew_) return body;
    for (Point3& p : body.vertices) {
      p = {p.x + p.y / 7 + Rational(1, 19), p.y - p.z / 11 + Rational(3, 23),
           p.z + p.x / 5 - Rational(8, 29)};
    }
    return body;
  }

  Point3 middle_of(const Square& around) const {
    Point3 sum{0, 0, 0};
    for (const std::uint32_t corner : around) {
      const Point3& p = corners_[corner];
      sum = {sum.x + p.x, sum.y + p.y, sum.z + p.z};
    }
    return {sum.x / 4, sum.y / 4, sum.z / 4};
  }

  bool is_rim(std::uint32_t a, std::uint32_t b) const {
    const auto both_at = [&](int at, auto coordinate) {
      return corners_[a].*coordinate == at && corners_[b].*coordinate == at;
    };
    return both_at(0, &Point3::x) || both_at(size, &Point3::x) || both_at(0, &Point3::y) ||
           both_at(size, &Point3::y);
  }

  bool askew_;
  std::vector<Point3> corners_;
  std::vector<Point3> feet_;
};

// No corner in a plane of the land: all that meets by chance are planes of the land.
Body random_body_across(std::mt19937& random) {
  constexpr int fine = 97;
  Body body = random_body(random, (Land::size + 1) * fine);
  for (Point3& p : body) p = {p.x / fine - 1, p.y / fine - 1, p.z / fine - 1};
  return body;
}

TEST(SettledFacetsOfLand, AreTheBoundaryThatMergingFinds) {
  std::mt19937 random(2026);
  for (int round = 0; round < 100; ++round) {
    const Land land(random, false);
    Solid direct = Solid::primitive({make_mesh(land.as_mesh())});
    Solid merged = land.in_columns();
    for (int i = 0; i < 3; ++i) {
      const Body body = random_body_across(random);
      direct = csg::subtract(direct, whole(body, false));
      merged = csg::subtract(merged, in_parts(body));
    }
    if (round % 2 == 0) {
      const Land other(random, true);
      direct = csg::subtract(direct, Solid::primitive({make_mesh(other.as_mesh())}));
      merged = csg::subtract(merged, other.in_columns());
    }
    EvaluateOptions options;
    options.facets_per_cell = static_cast<std::size_t>(4 + round % 20);
    const Boundary a = evaluate(direct, options);
    const Boundary b = evaluate(merged);
    ASSERT_TRUE(a.vertices == b.vertices) << round;
    ASSERT_EQ(a.edges, b.edges) << round;
    ASSERT_EQ(digest(a), digest(b)) << round;
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, SettledFacetsOnAGrid, ::testing::Values(2, 3, 4, 8));

}  // namespace
}  // namespace exactcsg
