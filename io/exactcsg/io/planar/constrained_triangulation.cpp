// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/planar/constrained_triangulation.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <utility>

#include "exactcsg/io/planar/exact_kernel.hpp"

namespace exactcsg::io {

namespace {

// Which of two diagonals is taken is a matter of taste, and on a polygon inscribed in a circle an
// exact answer is expensive: a diagonal is flipped only if interval arithmetic is certain that it
// gains. Every flip then is one that the exact test makes too, so the flips come to an end.
struct NearlyInCircle {
  CGAL::Oriented_side operator()(const ExactPoint2& p, const ExactPoint2& q, const ExactPoint2& r,
                                 const ExactPoint2& s) const {
    const CGAL::Protect_FPU_rounding<true> rounding;
    const auto side = CGAL::side_of_oriented_circle(CGAL::approx(p), CGAL::approx(q),
                                                    CGAL::approx(r), CGAL::approx(s));
    return side.is_certain() ? side.make_certain() : CGAL::ON_ORIENTED_BOUNDARY;
  }
};
struct Traits : ExactKernel {
  using Side_of_oriented_circle_2 = NearlyInCircle;
  Side_of_oriented_circle_2 side_of_oriented_circle_2_object() const { return {}; }
};

enum class Place : unsigned char { Unknown, Outside, Inside };
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Traits>;
using FaceBase =
    CGAL::Triangulation_face_base_with_info_2<Place, Traits,
                                              CGAL::Constrained_triangulation_face_base_2<Traits>>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<Traits, Structure>;

}  // namespace

std::vector<TriangleIndices> triangulate_loops(const std::vector<std::vector<std::uint32_t>>& loops,
                                               const std::vector<Point2>& points) {
  std::vector<std::pair<ExactPoint2, std::uint32_t>> used;
  std::vector<bool> seen(points.size());
  for (const auto& loop : loops) {
    for (const std::uint32_t v : loop) {
      if (!seen[v]) used.emplace_back(exact_point(points[v]), v);
      seen[v] = true;
    }
  }
  Triangulation triangulation;
  triangulation.insert(used.begin(), used.end());
  std::vector<Triangulation::Vertex_handle> vertex(points.size());
  for (auto v : triangulation.finite_vertex_handles()) vertex[v->info()] = v;
  for (const auto& loop : loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      triangulation.insert_constraint(vertex[loop[i]], vertex[loop[(i + 1) % loop.size()]]);
    }
  }

  for (auto face : triangulation.all_face_handles()) face->info() = Place::Unknown;
  std::vector<Triangulation::Face_handle> pending{triangulation.infinite_face()};
  pending.back()->info() = Place::Outside;
  while (!pending.empty()) {
    const auto face = pending.back();
    pending.pop_back();
    for (int i = 0; i < 3; ++i) {
      const auto beyond = face->neighbor(i);
      if (beyond->info() != Place::Unknown) continue;
      const bool outside = face->info() == Place::Outside;
      beyond->info() = outside != face->is_constrained(i) ? Place::Outside : Place::Inside;
      pending.push_back(beyond);
    }
  }

  std::vector<TriangleIndices> triangles;
  for (auto face : triangulation.finite_face_handles()) {
    if (face->info() != Place::Inside) continue;
    triangles.push_back(
        {face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
  }
  return triangles;
}

}  // namespace exactcsg::io
