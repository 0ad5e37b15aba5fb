// SPDX-License-Identifier: Apache-2.0
#pragma once

// Planes with certified doubles, and exact coefficients that are computed when asked for. Private
// to number/. [Exact]

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "exactcsg/number/approximate_plane.hpp"
#include "exactcsg/number/homogeneous.hpp"
#include "exactcsg/number/lazy_table.hpp"
#include "exactcsg/number/line_meeting.hpp"
#include "exactcsg/number/point_table.hpp"
#include "exactcsg/number/prepared_plane.hpp"

namespace exactcsg {

// What a plane is made from: three points, two points and the axis that it contains, or, where
// there are none, its coefficients.
class PlanePoints {
 public:
  PlanePoints() = default;
  PlanePoints(PointId p, PointId q, PointId r)
      : first_(p), second_(q), third_(static_cast<std::uint32_t>(r)) {}
  PlanePoints(PointId p, PointId q, Axis axis)
      : first_(p), second_(q), third_(first_axis + static_cast<std::uint32_t>(axis)) {}

  bool empty() const { return third_ == nothing; }
  // The homogeneous coordinates of the three points. `homogeneous(PointId)` gives those of a point.
  template <class HomogeneousOfPoint>
  std::array<Homogeneous<Integer>, 3> homogeneous(const HomogeneousOfPoint& of_point) const {
    const Homogeneous<Integer>& first = of_point(first_);
    if (third_ >= first_axis) {
      return {first, of_point(second_),
              moved_along_axis(first, static_cast<Axis>(third_ - first_axis))};
    }
    return {first, of_point(second_), of_point(PointId{third_})};
  }
  // The coprime coefficients.
  template <class HomogeneousOfPoint>
  Plane plane(const HomogeneousOfPoint& of_point) const {
    if (third_ < first_axis) {
      return plane_through(of_point(first_), of_point(second_), of_point(PointId{third_}));
    }
    const auto [p, q, r] = homogeneous(of_point);
    return plane_through(p, q, r);
  }
  // Likewise, of any length.
  PlaneForm form(const PointTable& points) const;

 private:
  static constexpr std::uint32_t nothing = ~std::uint32_t{0};
  static constexpr std::uint32_t first_axis = nothing - 3;  // beyond the ids of points

  PointId first_{};
  PointId second_{};
  std::uint32_t third_ = nothing;
};

// Whether offsets like the plane's are kept out of the arithmetic of keys.
bool is_remote(const ApproximatePlane& plane);

struct KeyedPlane {
  PlaneKey key;
  std::uint32_t plane;
};

// The planes in the order in which they were added, each as often as it was. For one thread, but
// for set().
class AddedPlanes {
 public:
  std::uint32_t add(PreparedPlane plane, const PlanePoints& points);
  // Room for so many, each to be set, by any thread, before it is asked for. Returns the first one.
  std::uint32_t add_unset(std::size_t count, unsigned threads);
  void set(std::uint32_t i, PreparedPlane plane, const PlanePoints& points);
  void reserve(std::size_t more);

  std::uint32_t size() const { return static_cast<std::uint32_t>(approximate_.size()); }
  const ApproximatePlane& approximate(std::uint32_t i) const { return approximate_[i]; }
  // The planes that are not remote with their keys, and then the remote ones. Both ascend.
  struct ByKey {
    std::vector<KeyedPlane> keyed;
    std::vector<std::uint32_t> remote;
  };
  // REQUIRES that it was not asked for yet, and that no plane is added any more
  ByKey take_keys(const PointTable& points);
  const PlanePoints& points(std::uint32_t i) const { return points_[i]; }
  bool knows_exact(std::uint32_t i) const { return exact_.contains(i); }
  // Computes it if it is not known yet.
  const Plane& exact(const PointTable& points, std::uint32_t i);

 private:
  friend class PlaneTable;

  std::vector<ApproximatePlane> approximate_;
  std::vector<KeyedPlane> keys_;
  std::vector<std::uint32_t> remote_;  // by the doubles that were added, in any order
  std::vector<PlanePoints> points_;
  std::unordered_map<std::uint32_t, std::unique_ptr<const Plane>> exact_;
  std::mutex setting_;  // of remote_ and exact_
};

// Distinct planes, immutable but for the cache of exact coefficients. For any number of threads.
class PlaneTable {
 public:
  PlaneTable() = default;
  // The planes `members` of `added`, in that order. REQUIRES that they ascend
  PlaneTable(AddedPlanes&& added, const std::vector<std::uint32_t>& members);

  std::uint32_t size() const { return static_cast<std::uint32_t>(approximate_.size()); }
  const ApproximatePlane* approximate() const { return approximate_.data(); }
  // `homogeneous(PointId)`: the coordinates of a point.
  template <class HomogeneousOfPoint>
  const Plane& exact(const HomogeneousOfPoint& homogeneous, std::uint32_t i) const {
    return exact_.get(i, [&] { return points_[i].plane(homogeneous); });
  }
  // What lines are met with: takes less than the exact coefficients, if those are not known.
  const PlaneForm& form(const PointTable& points, std::uint32_t i) const;

 private:
  std::vector<ApproximatePlane> approximate_;
  std::vector<PlanePoints> points_;  // that a plane is made from; none, if it was given
  LazyTable<Plane> exact_;
  LazyTable<PlaneForm> forms_;
};

}  // namespace exactcsg
