// SPDX-License-Identifier: Apache-2.0
#pragma once

// What a Geometry owns. Private to number/.

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "exactcsg/number/geometry.hpp"
#include "exactcsg/number/homogeneous.hpp"
#include "exactcsg/number/lazy_table.hpp"
#include "exactcsg/number/plane_table.hpp"
#include "exactcsg/number/point_table.hpp"

namespace exactcsg {

// Rows of ascending numbers: row i is values[begin[i] ... begin[i + 1]).
struct SparseTable {
  std::vector<std::uint32_t> begin{0};
  std::vector<std::uint32_t> values;

  std::span<const std::uint32_t> row(std::size_t i) const {
    return std::span(values).subspan(begin[i], begin[i + 1] - begin[i]);
  }
};

struct Geometry::Data {
  std::vector<std::shared_ptr<const void>> owners;  // of points
  PointTable points;
  PlaneTable planes;
  std::vector<OrientedPlaneRef> of_added;
  SparseTable planes_of_points;  // the planes known to contain each point
  SparseTable points_of_planes;  // the same, the other way round
  LazyTable<Homogeneous<Integer>> homogeneous_points;

  std::span<const std::uint32_t> planes_through(PointId id) const {
    return planes_of_points.row(static_cast<std::size_t>(id));
  }
  const Plane& exact(std::uint32_t plane) const {
    return planes.exact(
        [this](PointId id) -> const auto& { return homogeneous(id); }, plane);
  }
  const Homogeneous<Integer>& homogeneous(PointId id) const {
    return homogeneous_points.get(static_cast<std::size_t>(id),
                                  [&] { return homogeneous_of(point_of(points.exact(id))); });
  }
  const PlaneForm& form(std::uint32_t plane) const { return planes.form(points, plane); }
  PlaneOperand operand(PlaneRef plane) const {
    return plane.is_wall() ? operand_of_wall(plane.wall_axis(), plane.wall_position())
                           : operand_of(exact(plane.table_index()));
  }
  std::array<PlaneOperand, 3> operands(const Vertex& v) const {
    return {operand(v.planes[0]), operand(v.planes[1]), operand(v.planes[2])};
  }
};

struct PointPair {
  PointId first;
  PointId second;
};

// Two input points on both planes, if that is known: the ends of an edge that facets share.
std::optional<PointPair> common_points(const Geometry::Data& data, PlaneRef p, PlaneRef q);

}  // namespace exactcsg
