// SPDX-License-Identifier: GPL-3.0-or-later

// Quickhull after Barber, Dobkin and Huhdanpaa (1996) in CGAL, on exact numbers. Its triangles are
// merged to polygons here: a facet of a convex polytope is a whole face.

#include <CGAL/convex_hull_2.h>
#include <CGAL/convex_hull_3.h>

#include <algorithm>
#include <numeric>
#include <unordered_map>

#include "exactcsg/io/planar/exact_kernel.hpp"
#include "exactcsg/io/planar/outline.hpp"
#include "exactcsg/solid/evaluate.hpp"

namespace exactcsg::io {

namespace {

constexpr std::uint32_t none = ~std::uint32_t{0};

template <class Points, class Extends>
bool find_next(const Points& points, Extends&& extends) {
  return std::any_of(points.begin(), points.end(), extends);
}

// Four of the points are not in one plane.
bool spans_space(const std::vector<ExactPoint3>& points) {
  if (points.empty()) return false;
  const ExactPoint3& a = points[0];
  const ExactPoint3* b = nullptr;
  const ExactPoint3* c = nullptr;
  return find_next(points, [&](const ExactPoint3& p) { return b = &p, p != a; }) &&
         find_next(points,
                   [&](const ExactPoint3& p) { return c = &p, !CGAL::collinear(a, *b, p); }) &&
         find_next(points, [&](const ExactPoint3& p) { return !CGAL::coplanar(a, *b, *c, p); });
}

using Triangle = std::array<std::size_t, 3>;

class Merger {
 public:
  Merger(const std::vector<ExactPoint3>& vertices, const std::vector<Triangle>& triangles)
      : vertices_(vertices), triangles_(triangles), neighbours_(triangles.size()) {
    std::unordered_map<std::uint64_t, std::uint32_t> open;
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      for (std::size_t i = 0; i < 3; ++i) open.emplace(key(from(t, i), to(t, i)), t);
    }
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      for (std::size_t i = 0; i < 3; ++i) neighbours_[t][i] = open.at(key(to(t, i), from(t, i)));
    }
  }

  // Loops of vertices, counter-clockwise from outside, straight-on vertices dropped.
  std::vector<std::vector<std::size_t>> faces() {
    std::vector<std::vector<std::size_t>> result;
    face_.assign(triangles_.size(), none);
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      if (face_[t] == none) result.push_back(face_of(t, static_cast<std::uint32_t>(result.size())));
    }
    return result;
  }

 private:
  static std::uint64_t key(std::size_t a, std::size_t b) {
    return (static_cast<std::uint64_t>(a) << 32U) | b;
  }
  std::size_t from(std::uint32_t t, std::size_t i) const { return triangles_[t][i]; }
  std::size_t to(std::uint32_t t, std::size_t i) const { return triangles_[t][(i + 1) % 3]; }

  bool in_plane(std::uint32_t t, std::uint32_t other) const {
    const auto& [a, b, c] = triangles_[t];
    for (const std::size_t v : triangles_[other]) {
      if (v != a && v != b && v != c &&
          !CGAL::coplanar(vertices_[a], vertices_[b], vertices_[c], vertices_[v])) {
        return false;
      }
    }
    return true;
  }

  std::vector<std::size_t> face_of(std::uint32_t start, std::uint32_t number) {
    std::vector<std::uint32_t> members{start};
    face_[start] = number;
    for (std::size_t i = 0; i < members.size(); ++i) {
      for (const std::uint32_t beyond : neighbours_[members[i]]) {
        if (face_[beyond] != none || !in_plane(start, beyond)) continue;
        face_[beyond] = number;
        members.push_back(beyond);
      }
    }
    std::unordered_map<std::size_t, std::size_t> next;
    for (const std::uint32_t t : members) {
      for (std::size_t i = 0; i < 3; ++i) {
        if (face_[neighbours_[t][i]] != number) next.emplace(from(t, i), to(t, i));
      }
    }
    std::vector<std::size_t> loop;
    std::size_t v = next.begin()->first;
    do {
      loop.push_back(v);
      v = next.at(v);
    } while (v != loop[0]);
    std::vector<std::size_t> corners;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      if (!CGAL::collinear(vertices_[loop[(i + loop.size() - 1) % loop.size()]], vertices_[loop[i]],
                           vertices_[loop[(i + 1) % loop.size()]])) {
        corners.push_back(loop[i]);
      }
    }
    return corners;
  }

  const std::vector<ExactPoint3>& vertices_;
  const std::vector<Triangle>& triangles_;
  std::vector<std::array<std::uint32_t, 3>> neighbours_;
  std::vector<std::uint32_t> face_;  // that a triangle belongs to
};

Polyhedron polyhedron_of(const std::vector<ExactPoint3>& vertices,
                         const std::vector<std::vector<std::size_t>>& faces) {
  Polyhedron polyhedron;
  std::vector<std::uint32_t> number(vertices.size(), none);
  for (const auto& face : faces) {
    Facet& facet = polyhedron.facets.emplace_back();
    for (const std::size_t v : face) {
      if (number[v] == none) {
        number[v] = static_cast<std::uint32_t>(polyhedron.vertices.size());
        const ExactPoint3& p = vertices[v];
        polyhedron.vertices.push_back({rational_of(p.x()), rational_of(p.y()), rational_of(p.z())});
      }
      facet.push_back(number[v]);
    }
  }
  return polyhedron;
}

// Of four points CGAL makes a tetrahedron turned as the points happen to lie.
void turn_outwards(const std::vector<ExactPoint3>& vertices, std::vector<Triangle>& triangles) {
  const Triangle& first = triangles.front();
  for (const ExactPoint3& vertex : vertices) {
    switch (CGAL::orientation(vertices[first[0]], vertices[first[1]], vertices[first[2]], vertex)) {
      case CGAL::COPLANAR:
        continue;
      case CGAL::NEGATIVE:
        return;
      case CGAL::POSITIVE:
        for (Triangle& triangle : triangles) std::swap(triangle[1], triangle[2]);
        return;
    }
  }
}

Solid hull_of(std::vector<ExactPoint3> points) {
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (!spans_space(points)) return Solid::empty();
  std::vector<ExactPoint3> vertices;
  std::vector<Triangle> triangles;
  CGAL::convex_hull_3(points.begin(), points.end(), vertices, triangles);
  turn_outwards(vertices, triangles);
  Polyhedron polyhedron = polyhedron_of(vertices, Merger(vertices, triangles).faces());
  return Solid::primitive({make_convex_polytope_unchecked(std::move(polyhedron))});
}

template <class Tree>
bool only_unites(const Tree& tree) {
  bool unions = true;
  csg::walk(
      tree.root(),
      [&](auto node) {
        unions = unions && (node.operation() == csg::BooleanOperator::Union ||
                            node.tree().children().size() == 1);
        return unions;
      },
      [&](auto node) { unions = unions && node.kind() != csg::NodeKind::Full; }, [](auto) {});
  return unions;
}

bool is_bounded(const Solid& solid) {
  bool bounded = true;
  csg::for_each_primitive(solid, [&](const Primitive& primitive) {
    bounded = bounded && !std::holds_alternative<HalfSpace>(primitive.shape);
  });
  return bounded;
}

const Polyhedron& polyhedron_of(const Primitive& primitive) {
  if (const auto* polytope = std::get_if<ConvexPolytope>(&primitive.shape)) {
    return *polytope->polyhedron;
  }
  return *std::get<PolyhedralMesh>(primitive.shape).polyhedron;
}

void add_outline_points(const PlanarTree& tree, std::vector<ExactPoint2>& points) {
  for (const Point2& p : outline_of(tree).points) points.push_back(exact_point(p));
}

}  // namespace

Solid hull(std::span<const Point3> points) {
  std::vector<ExactPoint3> exact;
  exact.reserve(points.size());
  for (const Point3& p : points) exact.push_back(exact_point(p));
  return hull_of(std::move(exact));
}

Solid hull(const Solid& solid) {
  std::vector<ExactPoint3> points;
  const auto add = [&](const std::vector<Point3>& vertices) {
    for (const Point3& p : vertices) points.push_back(exact_point(p));
  };
  if (only_unites(solid) && is_bounded(solid)) {
    csg::for_each_primitive(
        solid, [&](const Primitive& primitive) { add(polyhedron_of(primitive).vertices); });
  } else {
    add(evaluate(solid).vertices);
  }
  return hull_of(std::move(points));
}

std::vector<Point2> hull(const PlanarTree& tree) {
  std::vector<ExactPoint2> points;
  if (only_unites(tree)) {
    // Figure by figure: lines and other parts without area must not count.
    csg::for_each_primitive(tree, [&](const PlanarFigure& figure) {
      add_outline_points(PlanarTree::primitive(figure), points);
    });
  } else {
    add_outline_points(tree, points);
  }
  std::vector<ExactPoint2> corners;
  CGAL::convex_hull_2(points.begin(), points.end(), std::back_inserter(corners));
  std::vector<Point2> result;
  for (const ExactPoint2& p : corners) result.push_back(point_of(p));
  return result;
}

}  // namespace exactcsg::io
