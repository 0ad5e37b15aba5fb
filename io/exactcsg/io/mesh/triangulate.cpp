// SPDX-License-Identifier: GPL-3.0-or-later

// A face is projected along the axis its normal is longest in, which keeps the order of points on
// every line; most faces are triangles or convex and need no triangulation.

#include <algorithm>
#include <cmath>
#include <limits>

#include "exactcsg/io/mesh/mesh_file.hpp"
#include "exactcsg/io/planar/constrained_triangulation.hpp"
#include "exactcsg/solid/face_planes.hpp"

namespace exactcsg::io {

namespace {

// Two coordinates in an order that keeps counter-clockwise loops counter-clockwise.
struct Projection {
  std::size_t first;
  std::size_t second;
};

Projection projection_of(const Plane& plane) {
  std::size_t axis = 0;
  const Integer* longest = &plane.a;
  if (mpz_cmpabs(plane.b.get_mpz_t(), longest->get_mpz_t()) > 0) {
    axis = 1;
    longest = &plane.b;
  }
  if (mpz_cmpabs(plane.c.get_mpz_t(), longest->get_mpz_t()) > 0) {
    axis = 2;
    longest = &plane.c;
  }
  const Projection positive{(axis + 1) % 3, (axis + 2) % 3};
  return sgn(*longest) > 0 ? positive : Projection{positive.second, positive.first};
}

class FaceTriangulator {
 public:
  FaceTriangulator(const Boundary& boundary, std::vector<TriangleIndices>& triangles)
      : boundary_(boundary), triangles_(triangles) {}

  void add(const BoundaryFace& face) {
    projection_ = projection_of(exact_plane(boundary_, face));
    if (face.loops.size() == 1 && is_strictly_convex(face.loops[0])) {
      const auto& loop = face.loops[0];
      for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
        triangles_.push_back({loop[0], loop[i], loop[i + 1]});
      }
      return;
    }
    // The triangulation numbers vertices by itself: a face has few of the boundary's many.
    std::vector<std::uint32_t> used;
    for (const auto& loop : face.loops) used.insert(used.end(), loop.begin(), loop.end());
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    auto loops = face.loops;
    for (auto& loop : loops) {
      for (std::uint32_t& v : loop) {
        const auto at = std::lower_bound(used.begin(), used.end(), v);
        v = static_cast<std::uint32_t>(at - used.begin());
      }
    }
    std::vector<Point2> points;
    for (const std::uint32_t v : used) {
      const Point3& p = boundary_.vertices[v];
      points.push_back({coordinate(p, projection_.first), coordinate(p, projection_.second)});
    }
    for (const TriangleIndices& triangle : triangulate_loops(loops, points)) {
      triangles_.push_back({used[triangle[0]], used[triangle[1]], used[triangle[2]]});
    }
  }

 private:
  // All turns to the left; a boundary's loop goes round once (it is a simple polygon, unless it
  // touches itself, and then it turns to the right somewhere).
  bool is_strictly_convex(const std::vector<std::uint32_t>& loop) const {
    const std::size_t n = loop.size();
    if (n == 3) return true;
    for (std::size_t i = 0; i < n; ++i) {
      if (!left_turn(loop[i], loop[(i + 1) % n], loop[(i + 2) % n])) return false;
    }
    return true;
  }

  bool left_turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    const auto& [first, second] = projection_;
    const auto& p = boundary_.approximate[a];
    const auto& q = boundary_.approximate[b];
    const auto& r = boundary_.approximate[c];
    const auto i = static_cast<std::size_t>(first);
    const auto j = static_cast<std::size_t>(second);
    const double x1 = q[i] - p[i];
    const double y1 = q[j] - p[j];
    const double x2 = r[i] - q[i];
    const double y2 = r[j] - q[j];
    const double determinant = x1 * y2 - y1 * x2;
    // With u = 2^-53 and M the largest coordinate: every coordinate is off by u M, so every
    // difference by d = 3 u M and its own rounding u 2 M, at most 5 u M; a product of differences
    // x y by d (|x| + |y|) + d^2 + u |x y|. Ten times u covers both products, the last subtraction
    // and the rounding of this bound.
    constexpr double unit = std::numeric_limits<double>::epsilon() / 2;
    double largest = 0;
    for (const auto* point : {&p, &q, &r}) {
      largest = std::max({largest, std::abs((*point)[i]), std::abs((*point)[j])});
    }
    const double difference_error = 6 * unit * largest;
    const double bound =
        2 * difference_error *
            (std::abs(x1) + std::abs(y1) + std::abs(x2) + std::abs(y2) + difference_error) +
        10 * unit * (std::abs(x1 * y2) + std::abs(y1 * x2)) + 1e-290;
    if (std::abs(determinant) > bound) return determinant > 0;
    const auto exact = [&](std::uint32_t v, std::size_t axis) {
      return coordinate(boundary_.vertices[v], axis);
    };
    const Rational left =
        (exact(b, first) - exact(a, first)) * (exact(c, second) - exact(b, second));
    const Rational right =
        (exact(b, second) - exact(a, second)) * (exact(c, first) - exact(b, first));
    return left > right;
  }

  const Boundary& boundary_;
  std::vector<TriangleIndices>& triangles_;
  Projection projection_{};
};

}  // namespace

std::vector<std::array<std::uint32_t, 3>> triangulate(const Boundary& boundary) {
  std::vector<TriangleIndices> triangles;
  FaceTriangulator triangulator(boundary, triangles);
  for (const BoundaryFace& face : boundary.faces) triangulator.add(face);
  return triangles;
}

}  // namespace exactcsg::io
