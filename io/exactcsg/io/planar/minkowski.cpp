// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/planar/minkowski.hpp"

#include <numeric>
#include <string>
#include <utility>

#include "exactcsg/io/planar/substitute.hpp"
#include "exactcsg/io/planar/unions.hpp"
#include "exactcsg/solid/evaluate.hpp"
#include "exactcsg/solid/face_planes.hpp"
#include "exactcsg/support/error.hpp"

namespace exactcsg::io {

namespace {

class PointBudget {
 public:
  void spend(std::size_t a, std::size_t b) {
    if (b != 0 && a > (minkowski_point_limit - spent_) / b) {
      throw Error(ErrorId::TooLarge, {"a Minkowski sum of more than " +
                                          std::to_string(minkowski_point_limit) + " sums of points",
                                      ""});
    }
    spent_ += a * b;
  }

 private:
  std::size_t spent_ = 0;
};

// A convex set by its corners: a polytope, or a piece of a face.
using Corners = std::vector<Point3>;

// A member of a union: a polytope, or any other solid with its surface in convex pieces.
struct Part {
  bool convex = false;
  Corners corners;              // of the polytope
  Solid solid;                  // that is not convex
  std::vector<Corners> faces;   // its surface
  std::vector<Point3> anchors;  // at least one on each connected part of the surface
};

Point3 sum(const Point3& p, const Point3& q) { return {p.x + q.x, p.y + q.y, p.z + q.z}; }

// A polygon with holes in a plane, cut into convex pieces in the coordinate plane that it leans
// against least, and lifted again.
void add_pieces(const Boundary& boundary, const BoundaryFace& face, std::vector<Corners>& pieces) {
  const Plane plane = exact_plane(boundary, face);
  const std::array<const Integer*, 3> normal{&plane.a, &plane.b, &plane.c};
  std::size_t up = 2;
  if (*normal[up] == 0) up = *normal[1] != 0 ? 1 : 0;
  const std::size_t u = (up + 1) % 3;
  const std::size_t v = (up + 2) % 3;
  PlanarFigure figure;
  for (const auto& loop : face.loops) {
    auto& path = figure.paths.emplace_back();
    for (const std::uint32_t vertex : loop) {
      const Point3& p = boundary.vertices[vertex];
      path.push_back({coordinate(p, u), coordinate(p, v)});
    }
  }
  for (const auto& part : convex_parts(figure)) {
    Corners& piece = pieces.emplace_back();
    for (const Point2& p : part) {
      std::array<Rational, 3> lifted;
      lifted[u] = p.x;
      lifted[v] = p.y;
      lifted[up] = -(*normal[u] * p.x + *normal[v] * p.y + plane.d) / *normal[up];
      piece.push_back({lifted[0], lifted[1], lifted[2]});
    }
  }
}

// One vertex of each connected part of the surface.
std::vector<Point3> anchors_of(const Boundary& boundary) {
  std::vector<std::uint32_t> parent(boundary.vertices.size());
  std::iota(parent.begin(), parent.end(), 0U);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const BoundaryFace& face : boundary.faces) {
    for (const auto& loop : face.loops) {
      for (const std::uint32_t v : loop) parent[root(v)] = root(face.loops[0][0]);
    }
  }
  std::vector<Point3> anchors;
  for (std::uint32_t v = 0; v < parent.size(); ++v) {
    if (root(v) == v) anchors.push_back(boundary.vertices[v]);
  }
  return anchors;
}

Part part_of(const Solid& solid) {
  Part part;
  if (solid.is_primitive()) {
    if (const auto* polytope = std::get_if<ConvexPolytope>(&solid.primitive().shape)) {
      part.convex = true;
      part.corners = to_vector(polytope->polyhedron->vertices);
      return part;
    }
  }
  const Boundary boundary = evaluate(solid);
  part.solid = boundary.empty() ? Solid::empty() : solid;
  for (const BoundaryFace& face : boundary.faces) add_pieces(boundary, face, part.faces);
  part.anchors = anchors_of(boundary);
  return part;
}

// The members of the topmost unions.
std::vector<Part> parts_of(const Solid& solid) {
  std::vector<Part> parts;
  csg::walk(
      solid.root(),
      [&](auto node) {
        if (node.operation() == csg::BooleanOperator::Union || node.tree().children().size() == 1) {
          return true;
        }
        parts.push_back(part_of(node.tree()));
        return false;
      },
      [&](auto node) {
        if (node.kind() != csg::NodeKind::Empty) parts.push_back(part_of(node.tree()));
      },
      [](auto) {});
  return parts;
}

class Summation {
 public:
  void add(const Part& a, const Part& b) {
    if (a.convex && b.convex) {
      add_hull(a.corners, b.corners);
    } else if (a.convex) {
      add_moved(b, a.corners.front());
      for (const Corners& face : b.faces) add_hull(face, a.corners);
    } else if (b.convex) {
      add(b, a);
    } else {
      for (const Point3& anchor : b.anchors) add_moved(a, anchor);
      for (const Point3& anchor : a.anchors) add_moved(b, anchor);
      for (const Corners& face : a.faces) {
        for (const Corners& other : b.faces) add_hull(face, other);
      }
    }
  }

  Solid take() { return unite_all(std::move(members_)); }

 private:
  void add_hull(const Corners& a, const Corners& b) {
    budget_.spend(a.size(), b.size());
    std::vector<Point3> sums;
    sums.reserve(a.size() * b.size());
    for (const Point3& p : a) {
      for (const Point3& q : b) sums.push_back(sum(p, q));
    }
    // Empty if the pieces are parallel: what has no volume lies on the surface of the rest.
    Solid solid = hull(sums);
    if (!solid.is_empty()) members_.push_back(std::move(solid));
  }

  void add_moved(const Part& part, const Point3& by) {
    if (part.solid.is_empty()) return;
    AffineMap map = AffineMap::identity();
    map.m[0][3] = by.x;
    map.m[1][3] = by.y;
    map.m[2][3] = by.z;
    members_.push_back(apply(map, part.solid));
  }

  PointBudget budget_;
  std::vector<Solid> members_;
};

std::vector<std::vector<Point2>> planar_parts(const PlanarTree& tree) {
  return convex_parts(resolve(tree));
}

}  // namespace

PlanarTree minkowski_sum(const PlanarTree& a, const PlanarTree& b) {
  const auto parts = planar_parts(a);
  const auto others = planar_parts(b);
  PointBudget budget;
  std::vector<PlanarTree> members;
  for (const auto& part : parts) {
    for (const auto& other : others) {
      budget.spend(part.size(), other.size());
      std::vector<Point2> sums;
      for (const Point2& p : part) {
        for (const Point2& q : other) sums.push_back({p.x + q.x, p.y + q.y});
      }
      members.push_back(PlanarTree::primitive({{planar_hull(sums)}}));
    }
  }
  return unite_all(std::move(members));
}

Solid minkowski_sum(const Solid& a, const Solid& b) {
  const std::vector<Part> parts = parts_of(a);
  const std::vector<Part> others = parts_of(b);
  Summation summation;
  for (const Part& part : parts) {
    for (const Part& other : others) summation.add(part, other);
  }
  return summation.take();
}

}  // namespace exactcsg::io
