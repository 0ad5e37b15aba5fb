// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/number/plane_table.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "exactcsg/number/coincidence.hpp"
#include "exactcsg/support/in_parallel.hpp"

namespace exactcsg {

bool is_remote(const ApproximatePlane& plane) {
  constexpr double largest_offset = 0x1p450;
  return !(std::fabs(plane.d) + plane.offset_error < largest_offset);
}

std::uint32_t AddedPlanes::add(PreparedPlane plane, const PlanePoints& points) {
  const std::uint32_t index = add_unset(1, 1);
  set(index, std::move(plane), points);
  return index;
}

std::uint32_t AddedPlanes::add_unset(std::size_t count, unsigned threads) {
  const std::uint32_t first = size();
  reserve(count);
  resize(threads, approximate_, first + count);
  resize(threads, keys_, first + count);
  resize(threads, points_, first + count);
  return first;
}

void AddedPlanes::set(std::uint32_t i, PreparedPlane plane, const PlanePoints& points) {
  const bool remote = is_remote(plane.near);
  if (remote || plane.exact) {
    const std::scoped_lock lock(setting_);
    if (remote) remote_.push_back(i);
    if (plane.exact) exact_.emplace(i, std::move(plane.exact));
  }
  approximate_[i] = plane.near;
  keys_[i] = {plane.key, i};
  points_[i] = points;
}

void AddedPlanes::reserve(std::size_t more) {
  const std::size_t size = approximate_.size() + more;
  if (size <= approximate_.capacity()) return;
  const std::size_t room = std::max(size, approximate_.size() * 2);
  approximate_.reserve(room);
  keys_.reserve(room);
  points_.reserve(room);
}

const Plane& AddedPlanes::exact(const PointTable& points, std::uint32_t i) {
  std::unique_ptr<const Plane>& known = exact_[i];
  if (!known) {
    known = std::make_unique<const Plane>(points_[i].plane(
        [&points](PointId id) { return homogeneous_of(point_of(points.exact(id))); }));
  }
  return *known;
}

// Whether a plane is remote is decided on doubles that only depend on the exact plane, so that
// equal planes agree on it.
AddedPlanes::ByKey AddedPlanes::take_keys(const PointTable& points) {
  ByKey result{std::move(keys_), {}};
  std::sort(remote_.begin(), remote_.end());
  for (const std::uint32_t i : remote_) {
    approximate_[i] = exactcsg::approximate(exact(points, i));
    result.keyed[i].key = key_of(approximate_[i]);
    if (is_remote(approximate_[i])) result.remote.push_back(i);
  }
  if (!result.remote.empty()) {
    std::erase_if(result.keyed, [&](const KeyedPlane& keyed) {
      return std::binary_search(result.remote.begin(), result.remote.end(), keyed.plane);
    });
  }
  return result;
}

PlaneTable::PlaneTable(AddedPlanes&& added, const std::vector<std::uint32_t>& members)
    : exact_(members.size()), forms_(members.size()) {
  for (auto& [index, plane] : added.exact_) {
    const auto place = std::lower_bound(members.begin(), members.end(), index);
    if (place == members.end() || *place != index) continue;
    exact_.set(static_cast<std::size_t>(place - members.begin()), std::move(plane));
  }
  approximate_ = std::move(added.approximate_);
  points_ = std::move(added.points_);
  if (members.size() == approximate_.size()) return;
  // Moved to the front in place.
  for (std::size_t i = 0; i < members.size(); ++i) {
    approximate_[i] = approximate_[members[i]];
    points_[i] = points_[members[i]];
  }
  approximate_.resize(members.size());
  points_.resize(members.size());
}

PlaneForm PlanePoints::form(const PointTable& points) const {
  const PointView p = points.exact(first_);
  const PointView q = points.exact(second_);
  if (third_ < first_axis) return plane_form_through(p, q, points.exact(PointId{third_}));
  const std::uint32_t axis = third_ - first_axis;
  const Rational coordinate_above = rational_of(p[axis]) + 1;
  PointView above = p;
  above[axis] = view_of(coordinate_above);
  return plane_form_through(p, q, above);
}

const PlaneForm& PlaneTable::form(const PointTable& points, std::uint32_t i) const {
  return forms_.get(i, [&] {
    if (const Plane* plane = exact_.known(i)) return plane_form_of(*plane);
    return points_[i].form(points);
  });
}

}  // namespace exactcsg
