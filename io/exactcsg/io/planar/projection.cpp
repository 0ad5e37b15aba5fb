// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/planar/projection.hpp"

#include <utility>
#include <variant>

#include "exactcsg/io/planar/substitute.hpp"
#include "exactcsg/io/planar/unions.hpp"
#include "exactcsg/solid/evaluate.hpp"
#include "exactcsg/solid/face_planes.hpp"

namespace exactcsg::io {

namespace {

Point2 flattened(const Point3& p) { return {p.x, p.y}; }

// A convex polytope's shadow is the hull of its vertices'.
PlanarTree shadow_of_polytope(const StoredPolyhedron& polyhedron) {
  PlanarFigure figure;
  auto& path = figure.paths.emplace_back();
  for (const Point3& p : polyhedron.vertices) path.push_back(flattened(p));
  path = planar_hull(path);
  if (path.size() < 3) return PlanarTree::empty();
  return PlanarTree::primitive(std::move(figure));
}

// Faces that look upward cover the shadow.
std::vector<PlanarTree> shadows_of_facets(const StoredPolyhedron& polyhedron) {
  const std::vector<Point3> vertices = to_vector(polyhedron.vertices);
  std::vector<PlanarTree> figures;
  for (const auto facet : polyhedron.facets) {
    PlanarFigure figure;
    auto& path = figure.paths.emplace_back();
    Rational twice_area{0};
    for (std::size_t i = 0; i < facet.size(); ++i) {
      const Point3& p = vertices[facet[i]];
      const Point3& q = vertices[facet[(i + 1) % facet.size()]];
      twice_area += p.x * q.y - p.y * q.x;
      path.push_back(flattened(p));
    }
    if (twice_area > 0) figures.push_back(PlanarTree::primitive(std::move(figure)));
  }
  return figures;
}

PlanarFigure figure_of(const Boundary& boundary, const BoundaryFace& face) {
  PlanarFigure figure;
  for (const auto& loop : face.loops) {
    auto& path = figure.paths.emplace_back();
    for (const std::uint32_t v : loop) path.push_back(flattened(boundary.vertices[v]));
  }
  return figure;
}

// The part of the solid on one side of z = 0 ends in faces in that plane, where the solid is.
void add_section(const Solid& solid, int side, std::vector<PlanarTree>& figures) {
  const Primitive half{make_half_space(0, 0, side, 0)};
  const Boundary boundary =
      evaluate(Solid::compose(csg::BooleanOperator::Intersection, {solid, Solid::primitive(half)}));
  for (const BoundaryFace& face : boundary.faces) {
    const Plane plane = exact_plane(boundary, face);
    if (plane.a != 0 || plane.b != 0 || plane.d != 0 || sgn(plane.c) != side) continue;
    figures.push_back(PlanarTree::primitive(figure_of(boundary, face)));
  }
}

}  // namespace

PlanarTree shadow(const Solid& solid) {
  std::vector<PlanarTree> figures;
  const auto append = [&](std::vector<PlanarTree> more) {
    for (PlanarTree& figure : more) figures.push_back(std::move(figure));
  };
  if (only_unites(solid) && is_bounded(solid)) {
    csg::for_each_primitive(solid, [&](const Primitive& primitive) {
      const StoredPolyhedron& polyhedron = *polyhedron_of(primitive);
      if (std::holds_alternative<ConvexPolytope>(primitive.shape)) {
        figures.push_back(shadow_of_polytope(polyhedron));
      } else {
        append(shadows_of_facets(polyhedron));
      }
    });
  } else {
    const Boundary boundary = evaluate(solid);
    for (const BoundaryFace& face : boundary.faces) {
      if (exact_plane(boundary, face).c > 0) {
        figures.push_back(PlanarTree::primitive(figure_of(boundary, face)));
      }
    }
  }
  return unite_all(std::move(figures));
}

PlanarTree section(const Solid& solid) {
  std::vector<PlanarTree> figures;
  add_section(solid, 1, figures);
  add_section(solid, -1, figures);
  return unite_all(std::move(figures));
}

}  // namespace exactcsg::io
