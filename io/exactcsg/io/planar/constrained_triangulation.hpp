// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The triangulation of a polygon with holes by a constrained Delaunay triangulation with exact
// predicates: no vertex is added. [Exact]
//
// LAW triangulation.1  every edge of the loops is an edge of the triangles, and the triangles,
// counter-clockwise, cover exactly the points with an odd number of loops round them.
// REQUIRES loops that meet in common vertices only; points of equal coordinates have equal indices.
// COST: O(n log n) expected.
//
// Not for headers that others include: CGAL is expensive to compile.

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "exactcsg/io/planar/exact_kernel.hpp"

namespace exactcsg::io {

using TriangleIndices = std::array<std::uint32_t, 3>;

// `point(index)` gives the ExactPoint2 of a vertex of `loops`.
template <class Loops, class PointOf>
std::vector<TriangleIndices> triangulate_loops(const Loops& loops, PointOf&& point) {
  enum class Place : unsigned char { Unknown, Outside, Inside };
  using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, ExactKernel>;
  using FaceBase = CGAL::Triangulation_face_base_with_info_2<
      Place, ExactKernel, CGAL::Constrained_triangulation_face_base_2<ExactKernel>>;
  using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
  using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<ExactKernel, Structure>;

  std::vector<std::pair<ExactPoint2, std::uint32_t>> points;
  std::uint32_t largest = 0;
  for (const auto& loop : loops) {
    for (const std::uint32_t v : loop) {
      points.emplace_back(point(v), v);
      largest = std::max(largest, v);
    }
  }
  Triangulation triangulation;
  triangulation.insert(points.begin(), points.end());
  std::vector<typename Triangulation::Vertex_handle> vertex(std::size_t{largest} + 1);
  for (auto v : triangulation.finite_vertex_handles()) vertex[v->info()] = v;
  for (const auto& loop : loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      triangulation.insert_constraint(vertex[loop[i]], vertex[loop[(i + 1) % loop.size()]]);
    }
  }

  for (auto face : triangulation.all_face_handles()) face->info() = Place::Unknown;
  std::vector<typename Triangulation::Face_handle> pending{triangulation.infinite_face()};
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
