// SPDX-License-Identifier: GPL-3.0-or-later

// Quickhull after Barber, Dobkin and Huhdanpaa (1996) in CGAL, with exact predicates. Its triangles
// are merged to polygons here: a facet of a convex polytope is a whole face.

#include <CGAL/convex_hull_2.h>
#include <CGAL/convex_hull_3.h>

#include <algorithm>
#include <numeric>
#include <unordered_map>

#include "exactcsg/io/planar/exact_kernel.hpp"
#include "exactcsg/io/planar/hull_traits.hpp"
#include "exactcsg/io/planar/outline.hpp"
#include "exactcsg/io/planar/unions.hpp"
#include "exactcsg/solid/evaluate.hpp"

namespace exactcsg::io {

namespace {

constexpr std::uint32_t none = ~std::uint32_t{0};

// Four of the points are not in one plane.
bool spans_space(const PolyhedronSigns& signs, std::uint32_t count) {
  std::uint32_t c = 2;
  while (c < count && signs.collinear(0, 1, c)) ++c;
  std::uint32_t d = c + 1;
  while (d < count && signs.orientation(0, 1, c, d) == Sign::Zero) ++d;
  return d < count;
}

using Triangle = std::array<std::size_t, 3>;

class Merger {
 public:
  Merger(const std::vector<HullPoint>& vertices, const std::vector<Triangle>& triangles)
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
    const Triangle& own = triangles_[t];
    return std::all_of(triangles_[other].begin(), triangles_[other].end(), [&](std::size_t v) {
      return std::find(own.begin(), own.end(), v) != own.end() ||
             HullTraits::Coplanar_3()(vertices_[own[0]], vertices_[own[1]], vertices_[own[2]],
                                      vertices_[v]);
    });
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
      const HullPoint before = vertices_[loop[(i + loop.size() - 1) % loop.size()]];
      const HullPoint after = vertices_[loop[(i + 1) % loop.size()]];
      if (!HullTraits::Collinear_3()(before, vertices_[loop[i]], after)) corners.push_back(loop[i]);
    }
    return corners;
  }

  const std::vector<HullPoint>& vertices_;
  const std::vector<Triangle>& triangles_;
  std::vector<std::array<std::uint32_t, 3>> neighbours_;
  std::vector<std::uint32_t> face_;  // that a triangle belongs to
};

Polyhedron polyhedron_with(const std::vector<Point3>& points,
                           const std::vector<HullPoint>& vertices,
                           const std::vector<std::vector<std::size_t>>& faces) {
  Polyhedron polyhedron;
  std::vector<std::uint32_t> number(vertices.size(), none);
  for (const auto& face : faces) {
    Facet& facet = polyhedron.facets.emplace_back();
    for (const std::size_t v : face) {
      if (number[v] == none) {
        number[v] = static_cast<std::uint32_t>(polyhedron.vertices.size());
        polyhedron.vertices.push_back(points[vertices[v].index]);
      }
      facet.push_back(number[v]);
    }
  }
  return polyhedron;
}

// Of four points CGAL makes a tetrahedron turned as the points happen to lie.
void turn_outwards(const PolyhedronSigns& signs, const std::vector<HullPoint>& vertices,
                   std::vector<Triangle>& triangles) {
  const auto& [a, b, c] = triangles.front();
  for (const HullPoint& vertex : vertices) {
    const Sign side =
        signs.orientation(vertices[a].index, vertices[b].index, vertices[c].index, vertex.index);
    if (side == Sign::Zero) continue;
    if (side == Sign::Positive) {
      for (Triangle& triangle : triangles) std::swap(triangle[1], triangle[2]);
    }
    return;
  }
}

Solid hull_of(std::vector<Point3> points) {
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  const PolyhedronSigns signs(points);
  const auto count = static_cast<std::uint32_t>(points.size());
  if (!spans_space(signs, count)) return Solid::empty();
  std::vector<HullPoint> candidates;
  candidates.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) candidates.push_back({&signs, i});
  std::vector<HullPoint> vertices;
  std::vector<Triangle> triangles;
  CGAL::convex_hull_3(candidates.begin(), candidates.end(), vertices, triangles);
  turn_outwards(signs, vertices, triangles);
  const Polyhedron polyhedron =
      polyhedron_with(points, vertices, Merger(vertices, triangles).faces());
  return Solid::primitive({make_convex_polytope_unchecked(polyhedron)});
}

void add_outline_points(const PlanarTree& tree, std::vector<Point2>& points) {
  const Outline outline = outline_of(tree);
  points.insert(points.end(), outline.points.begin(), outline.points.end());
}

}  // namespace

Solid hull(std::span<const Point3> points) { return hull_of({points.begin(), points.end()}); }

Solid hull(const Solid& solid) {
  if (!only_unites(solid) || !is_bounded(solid))
    return hull_of(to_vector(evaluate(solid).vertices));
  std::vector<Point3> points;
  csg::for_each_primitive(solid, [&](const Primitive& primitive) {
    const ExactPoints& vertices = polyhedron_of(primitive)->vertices;
    points.insert(points.end(), vertices.begin(), vertices.end());
  });
  return hull_of(std::move(points));
}

std::vector<Point2> planar_hull(const std::vector<Point2>& points) {
  std::vector<ExactPoint2> exact;
  exact.reserve(points.size());
  for (const Point2& p : points) exact.push_back(exact_point(p));
  std::vector<ExactPoint2> corners;
  CGAL::convex_hull_2(exact.begin(), exact.end(), std::back_inserter(corners));
  std::vector<Point2> result;
  result.reserve(corners.size());
  for (const ExactPoint2& p : corners) result.push_back(point_of(p));
  return result;
}

std::vector<Point2> hull(const PlanarTree& tree) {
  std::vector<Point2> points;
  if (only_unites(tree)) {
    // Figure by figure: lines and other parts without area must not count.
    csg::for_each_primitive(tree, [&](const PlanarFigure& figure) {
      add_outline_points(PlanarTree::primitive(figure), points);
    });
  } else {
    add_outline_points(tree, points);
  }
  return planar_hull(points);
}

}  // namespace exactcsg::io
