// SPDX-License-Identifier: Apache-2.0
#pragma once

// Oriented planes that are no walls, as facets lie in them, in four bytes. Internal to the
// evaluator. [Exact]

#include <compare>
#include <cstdint>

#include "exactcsg/number/geometry.hpp"

namespace exactcsg {

// LAW oriented_table_plane.1  it converts to the plane that it was made of. LAW
// oriented_table_plane.2  the order is that of these.
class OrientedTablePlane {
 public:
  constexpr OrientedTablePlane() = default;
  // REQUIRES no wall, an index below 2^31, and a sense of 1 or -1
  constexpr OrientedTablePlane(const OrientedPlaneRef& oriented)
      : bits_(oriented.plane.table_index() << 1U | (oriented.sense > 0 ? 1U : 0U)) {}

  constexpr std::uint32_t table_index() const { return bits_ >> 1U; }
  constexpr PlaneRef plane() const { return PlaneRef::of_table(table_index()); }
  constexpr signed char sense() const { return (bits_ & 1U) != 0 ? 1 : -1; }
  constexpr operator OrientedPlaneRef() const { return {plane(), sense()}; }
  friend constexpr auto operator<=>(const OrientedTablePlane&, const OrientedTablePlane&) = default;

 private:
  std::uint32_t bits_ = 1;
};

}  // namespace exactcsg
