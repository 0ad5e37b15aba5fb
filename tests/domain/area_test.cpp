// SPDX-License-Identifier: GPL-3.0-or-later
// The area of planar solids by quadtree, sections 3.4 and 5.3 of the source: exact for polygons
// whatever the depth, enclosed for discs.
#include <gtest/gtest.h>

#include <array>
#include <span>
#include <vector>

#include "exactcsg/csg/prune.hpp"
#include "exactcsg/csg/tree.hpp"
#include "exactcsg/domain/classify.hpp"
#include "exactcsg/domain/half_spaces.hpp"
#include "exactcsg/gdt/cell.hpp"
#include "exactcsg/gdt/create.hpp"
#include "exactcsg/gdt/traverse.hpp"
#include "exactcsg/skeleton/divacon.hpp"

namespace exactcsg {
namespace {

using Point = domain::Point<2>;
using Cell = gdt::Cell<Rational, 2>;
using Solid = csg::Tree<domain::HalfSpace<2>, csg::BooleanOperator>;
using Polygon = std::vector<Point>;

struct Local {
  Cell cell;
  Solid solid;
  int depth = 0;
};

bool is_decided(const Local& local) { return local.solid.is_empty() || local.solid.is_full(); }

std::vector<Local> quadrants(const Local& local) {
  std::vector<Local> parts;
  for (std::size_t i = 0; i < 4; ++i) {
    const Cell cell = gdt::Orthants()(local.cell, gdt::NoLabel(), i);
    const domain::Box<2> box(cell.lower, cell.upper);
    const auto solid = csg::prune(local.solid, [&](const auto& h) { return classify(h, box); });
    parts.push_back({cell, solid, local.depth + 1});
  }
  return parts;
}

Rational cross_of(const Point& o, const Point& p, const Point& q) {
  return (p[0] - o[0]) * (q[1] - o[1]) - (p[1] - o[1]) * (q[0] - o[0]);
}

Rational shoelace(const Polygon& polygon) {
  Rational twice = 0;
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    twice += cross_of(polygon[0], polygon[i - 1], polygon[i]);
  }
  return twice / 2;
}

// A triangle, counter-clockwise, and its three half-planes.
struct Triangle {
  std::array<Point, 3> corners;

  Solid solid() const {
    Solid result = Solid::full();
    for (std::size_t i = 0; i < 3; ++i) {
      const auto side = domain::make_line(corners[i], corners[(i + 1) % 3]);
      result = csg::intersect(result, Solid::primitive(side));
    }
    return result;
  }
  Rational area() const { return shoelace({corners.begin(), corners.end()}); }
};

// The part of a convex polygon on the left of the line from p to q, or on the right.
Polygon part(const Polygon& polygon, const Point& p, const Point& q, int side) {
  Polygon result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point& a = polygon[i];
    const Point& b = polygon[(i + 1) % polygon.size()];
    const Rational at_a = side * cross_of(p, q, a);
    const Rational at_b = side * cross_of(p, q, b);
    if (at_a >= 0) result.push_back(a);
    if (sgn(at_a) * sgn(at_b) < 0) {
      const Rational t = at_a / (at_a - at_b);
      result.push_back({Rational(a[0] + t * (b[0] - a[0])), Rational(a[1] + t * (b[1] - a[1]))});
    }
  }
  return result;
}

// The area of the solid in a convex polygon, by cutting that along one line of the triangles after
// the other: no line runs through a piece that is left, so that any inner point tells.
Rational area_in(const Polygon& polygon, const Solid& solid, std::span<const Triangle> triangles,
                 std::size_t line = 0) {
  if (polygon.size() < 3) return 0;
  if (line == 3 * triangles.size()) {
    const auto mean = [&](std::size_t axis) {
      Rational sum = 0;
      for (const Point& p : polygon) sum += p[axis];
      return Rational(sum / static_cast<long>(polygon.size()));
    };
    const bool inside = domain::classify(solid, Point{mean(0), mean(1)}) == PointClass::In;
    return inside ? shoelace(polygon) : Rational(0);
  }
  const auto& corners = triangles[line / 3].corners;
  const Point& p = corners[line % 3];
  const Point& q = corners[(line + 1) % 3];
  return area_in(part(polygon, p, q, 1), solid, triangles, line + 1) +
         area_in(part(polygon, p, q, -1), solid, triangles, line + 1);
}

// Two triangles that are each other's images in a point make a hexagram: together 4/3 of one. Less
// a small one in the middle, which is 1/49 of one.
TEST(PlanarArea, OfPolygonsIsTheEqualRationalAtEveryDepth) {
  const auto at = [](const Rational& x, const Rational& y) {
    return Point{Rational(x / 5 + Rational(1, 3)), Rational(y / 5 + Rational(1, 3))};
  };
  const auto small = [&](long x, long y) {
    return at(1 + Rational(x - 1, 7), 1 + Rational(y - 1, 7));
  };
  const std::vector<Triangle> triangles{{{at(0, 0), at(3, 0), at(0, 3)}},
                                        {{at(2, 2), at(-1, 2), at(2, -1)}},
                                        {{small(0, 0), small(3, 0), small(0, 3)}}};
  const Solid solid =
      csg::subtract(csg::unite(triangles[0].solid(), triangles[1].solid()), triangles[2].solid());
  const Rational one = Rational(9, 2) / 25;
  ASSERT_EQ(triangles[0].area(), one);
  const Rational expected = one * Rational(4, 3) - one / 49;
  const Local universe{{{0, 0}, {1, 1}}, solid};
  const auto area = [&](const Local& local) -> Rational {
    if (local.solid.is_empty()) return 0;
    const auto& [lower, upper] = local.cell;
    const Polygon cell{lower, {upper[0], lower[1]}, upper, {lower[0], upper[1]}};
    if (local.solid.is_full()) return shoelace(cell);
    return area_in(cell, local.solid, triangles);
  };
  const auto sum = [](std::span<Rational> parts) {
    Rational total = 0;
    for (const Rational& each : parts) total += each;
    return total;
  };
  for (const std::size_t depth : {0, 1, 2, 3, 4, 5, 6}) {
    const auto tree = gdt::create(
        universe, is_decided, quadrants, [](const Local& local) { return local; }, depth);
    EXPECT_EQ(gdt::traverse(tree, area, sum), expected) << depth;
    const auto leaf = [&](const Local& local) {
      return is_decided(local) || local.depth == static_cast<int>(depth);
    };
    EXPECT_EQ(skeleton::divacon(universe, leaf, quadrants, area, sum), expected) << depth;
  }
}

// pi / 16 lies between 3.14159265 / 16 and 3.14159266 / 16. A circle crosses at most
// 8 r 2^depth + 4 cells of the side 2^-depth.
TEST(PlanarArea, OfADiscIsEnclosed) {
  const Solid disc = Solid::primitive(domain::make_disc({Rational(1, 2), Rational(1, 2)}, {1, 16}));
  const Rational low = Rational(314159265, 100000000) / 16;
  const Rational high = Rational(314159266, 100000000) / 16;
  using Enclosed = std::array<Rational, 2>;
  for (const int depth : {1, 2, 3, 4, 5, 6, 7}) {
    const auto leaf = [&](const Local& local) { return is_decided(local) || local.depth == depth; };
    const auto area = [](const Local& local) -> Enclosed {
      if (local.solid.is_empty()) return {0, 0};
      const auto& [lower, upper] = local.cell;
      const Rational size = (upper[0] - lower[0]) * (upper[1] - lower[1]);
      return {local.solid.is_full() ? size : Rational(0), size};
    };
    const auto sum = [](std::span<Enclosed> parts) {
      Enclosed total{0, 0};
      for (const Enclosed& each : parts) {
        for (std::size_t i = 0; i < 2; ++i) total[i] += each[i];
      }
      return total;
    };
    const Enclosed found =
        skeleton::divacon(Local{{{0, 0}, {1, 1}}, disc}, leaf, quadrants, area, sum);
    EXPECT_LE(found[0], low);
    EXPECT_GE(found[1], high);
    const Rational side(1, 1L << depth);
    EXPECT_LE(found[1] - found[0], side * side * (2 * (1L << depth) + 4)) << depth;
  }
}

}  // namespace
}  // namespace exactcsg
