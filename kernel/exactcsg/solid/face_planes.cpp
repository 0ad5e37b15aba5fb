// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/solid/face_planes.hpp"

namespace exactcsg {

Plane exact_plane(const Boundary& boundary, const BoundaryFace& face) {
  // A region's lexicographically smallest point is a convex corner of it.
  const std::vector<std::uint32_t>* loop = nullptr;
  std::size_t place = 0;
  for (const std::vector<std::uint32_t>& candidate : face.loops) {
    for (std::size_t i = 0; i < candidate.size(); ++i) {
      if (loop != nullptr && compare(boundary.vertices.view(candidate[i]),
                                     boundary.vertices.view((*loop)[place])) >= 0) {
        continue;
      }
      loop = &candidate;
      place = i;
    }
  }
  if (loop == nullptr) return {};
  const std::size_t size = loop->size();
  const Point3& before = boundary.vertices[(*loop)[(place + size - 1) % size]];
  const Point3& corner = boundary.vertices[(*loop)[place]];
  const Point3& after = boundary.vertices[(*loop)[(place + 1) % size]];
  if (cross(corner - before, after - corner) == Vector3{}) return {};
  return plane_through(before, corner, after);
}

std::vector<Plane> exact_planes(const Boundary& boundary) {
  std::vector<Plane> planes(boundary.plane_count);
  std::vector<bool> known(boundary.plane_count, false);
  for (const BoundaryFace& face : boundary.faces) {
    if (known[face.plane]) continue;
    known[face.plane] = true;
    planes[face.plane] = exact_plane(boundary, face);
  }
  return planes;
}

}  // namespace exactcsg
