// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactcsg/io/planar/constrained_triangulation.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <utility>

#include "exactcsg/io/planar/exact_kernel.hpp"

namespace exactcsg::io {

namespace {

enum class Place : unsigned char { Unknown, Outside, Inside };
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, ExactKernel>;
using FaceBase = CGAL::Triangulation_face_base_with_info_2<
    Place, ExactKernel, CGAL::Constrained_triangulation_face_base_2<ExactKernel>>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<ExactKernel, Structure>;

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
