// SPDX-License-Identifier: Apache-2.0
#pragma once

// Exact points, each once, with their certified doubles. Private to number/. [Exact]

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "exactcsg/number/exact_points.hpp"
#include "exactcsg/number/geometry.hpp"
#include "exactcsg/number/point.hpp"

namespace exactcsg {

class PointTable {
 public:
  // The id of the point of this value, a new one if there is none. COST: amortised O(1)
  PointId intern(const Point3& point);
  // The same of many without copies. REQUIRES that the points last as long as the table, and as
  // many hashes and ids, which are written, as points
  void intern_lasting(const ExactPoints& points, std::span<const HashedPoint> hashed,
                      std::span<PointId> ids);

  // Room for so many more.
  void reserve(std::size_t more);
  // Gives up what new points are sought with. REQUIRES that none is added any more.
  void close();

  std::size_t size() const { return points_.size(); }
  PointRecord record(PointId id) const { return points_[static_cast<std::size_t>(id)]; }
  void ask_for(PointId id) const { __builtin_prefetch(&points_[static_cast<std::size_t>(id)]); }
  PointView exact(PointId id) const { return record(id).view(); }
  const ApproximatePoint& approximate(PointId id) const {
    return approximate_[static_cast<std::size_t>(id)];
  }
  const ApproximatePoint* approximate() const { return approximate_.data(); }  // by id

 private:
  // Returns the id, and whether it is a new one, whose point is still to be set. equals(record): of
  // the point that is sought.
  template <class Equals>
  std::pair<PointId, bool> find_or_add(const HashedPoint& hashed, const Equals& equals);
  void enlarge_slots(std::size_t least);

  std::vector<PointRecord> points_;
  ExactPoints copies_;
  std::vector<ApproximatePoint> approximate_;
  std::vector<std::uint64_t> hashes_;
  std::vector<std::uint32_t> slots_;  // open addressing: 0 free, else id + 1
};

}  // namespace exactcsg
