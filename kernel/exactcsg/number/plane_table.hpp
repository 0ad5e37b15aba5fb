// SPDX-License-Identifier: Apache-2.0
#pragma once

// Planes with certified doubles, and exact coefficients that are computed when asked for. Private
// to number/. [Exact]

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "exactcsg/number/approximate_plane.hpp"
#include "exactcsg/number/homogeneous.hpp"
#include "exactcsg/number/lazy_table.hpp"
#include "exactcsg/number/point_table.hpp"

namespace exactcsg {

// What a plane is made from: three points, or coefficients.
struct PlaneSource {
  std::array<PointId, 3> points{};
  std::unique_ptr<const Plane> exact;  // given, or computed already; may be null
  bool has_points = false;
};

// The planes in the order in which they were added, each as often as it was. For one thread.
class AddedPlanes {
 public:
  // THROWS Error(DegenerateFacet)
  std::uint32_t add(const PointTable& points, const std::array<PointId, 3>& through);
  std::uint32_t add(const Plane& plane);

  std::uint32_t size() const { return static_cast<std::uint32_t>(approximate_.size()); }
  const ApproximatePlane& approximate(std::uint32_t i) const { return approximate_[i]; }
  const PlaneSource& source(std::uint32_t i) const { return sources_[i]; }
  PlaneSource take_source(std::uint32_t i) { return std::move(sources_[i]); }
  // Computes it if it is not known yet.
  const Plane& exact(const PointTable& points, std::uint32_t i);
  // Replaces the certified doubles by those of the exact coefficients.
  void sharpen(const PointTable& points, std::uint32_t i);

 private:
  std::vector<ApproximatePlane> approximate_;
  std::vector<PlaneSource> sources_;
};

// Distinct planes, immutable but for the cache of exact coefficients. For any number of threads.
class PlaneTable {
 public:
  PlaneTable() = default;
  // The planes `members` of `added`, in that order.
  PlaneTable(AddedPlanes& added, const std::vector<std::uint32_t>& members);

  std::uint32_t size() const { return static_cast<std::uint32_t>(approximate_.size()); }
  const ApproximatePlane* approximate() const { return approximate_.data(); }
  // `homogeneous(PointId)`: the coordinates of a point.
  template <class HomogeneousOfPoint>
  const Plane& exact(const HomogeneousOfPoint& homogeneous, std::uint32_t i) const {
    return exact_.get(i, [&] {
      const auto& [p, q, r] = points_[i];
      return plane_through(homogeneous(p), homogeneous(q), homogeneous(r));
    });
  }

 private:
  std::vector<ApproximatePlane> approximate_;
  std::vector<std::array<PointId, 3>> points_;  // that a plane is made from; any, if it was given
  LazyTable<Plane> exact_;
};

}  // namespace exactcsg
