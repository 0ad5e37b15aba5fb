// SPDX-License-Identifier: Apache-2.0
// Equality of solids, with a witness where they differ.
#include "exactcsg/solid/classify.hpp"
#include "exactcsg/solid/face_planes.hpp"

namespace exactcsg {

namespace {

bool same_boundary(const Boundary& a, const Boundary& b) {
  const auto same_face = [](const BoundaryFace& p, const BoundaryFace& q) {
    return p.plane == q.plane && p.loops == q.loops;
  };
  return a.vertices == b.vertices && a.edges == b.edges &&
         std::equal(a.faces.begin(), a.faces.end(), b.faces.begin(), b.faces.end(), same_face);
}

// The same point with short coordinates if that is still in the solid: easier to read and paste.
Point3 shortened(const Solid& solid, const Point3& point) {
  const Point3 near{rational_of(nearest_double(point.x)), rational_of(nearest_double(point.y)),
                    rational_of(nearest_double(point.z))};
  return classify(solid, near) == PointClass::In ? near : point;
}

// Behind a face, close to a convex corner of it (a face's smallest vertex is one), points are in
// the solid if they are close enough.
std::optional<Point3> point_behind(const Solid& solid, const Boundary& boundary,
                                   const BoundaryFace& face) {
  const auto& loop = face.loops.front();
  const Point3& corner = boundary.vertices[loop[0]];
  const Vector3 along = boundary.vertices[loop[1]] - corner;
  const Vector3 back = boundary.vertices[loop.back()] - corner;
  const Plane plane = exact_plane(boundary, face);
  const Vector3 normal{plane.a, plane.b, plane.c};
  const Rational reach = dot(along, along) + dot(back, back);
  const Rational unit = reach / (1 + dot(normal, normal));
  Rational near(1, 3);
  for (int i = 0; i < 24; ++i, near /= 4) {
    const Point3 on_face = corner + near * along + near * back;
    Rational depth = near;
    for (int j = 0; j < 24; ++j, depth /= 16) {
      // About depth times the corner's size below the face; the normal's length matters little.
      const Point3 inner = on_face + Rational(-depth * unit) * normal;
      if (classify(solid, inner) == PointClass::In) return shortened(solid, inner);
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<Point3> interior_point(const Solid& solid, const EvaluateOptions& options) {
  return interior_point(solid, evaluate(solid, options));
}

std::optional<Point3> interior_point(const Solid& solid, const Boundary& boundary) {
  for (const BoundaryFace& face : boundary.faces) {
    if (auto point = point_behind(solid, boundary, face)) return point;
  }
  if (boundary.empty()) return std::nullopt;
  throw Error(ErrorId::InternalError, {"no point behind any face", ""});
}

std::optional<Difference> find_difference(const Solid& first, const Solid& second,
                                          const EvaluateOptions& options) {
  if (same_boundary(evaluate(first, options), evaluate(second, options))) return std::nullopt;
  if (auto point = interior_point(csg::subtract(first, second), options)) {
    return Difference{std::move(*point), true};
  }
  if (auto point = interior_point(csg::subtract(second, first), options)) {
    return Difference{std::move(*point), false};
  }
  throw Error(ErrorId::InternalError, {"two boundaries of one solid", ""});
}

}  // namespace exactcsg
