// SPDX-License-Identifier: Apache-2.0
#pragma once

// The sides of a boundary's faces in an order that does not depend on how faces, loops and planes
// are listed. Internal to digests and symmetries. [Exact]

#include <compare>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "exactcsg/solid/boundary.hpp"

namespace exactcsg {

// One edge as a face has it, the face on the left: compared as the pair (from, to) is.
class Side {
 public:
  Side() = default;
  Side(std::uint32_t from, std::uint32_t to) : bits_(std::uint64_t{from} << 32U | to) {}

  std::uint32_t from() const { return static_cast<std::uint32_t>(bits_ >> 32U); }
  std::uint32_t to() const { return static_cast<std::uint32_t>(bits_); }
  friend auto operator<=>(const Side&, const Side&) = default;

 private:
  std::uint64_t bits_ = 0;
};

using SidesOfPlane = std::span<const Side>;

// The sorted sides of each oriented plane that has any, in the lexicographic order of these lists,
// which numbers the planes.
class NumberedSides {
 public:
  // REQUIRES spans of `sides`, all of which they hold together
  NumberedSides(std::vector<Side> sides, std::vector<SidesOfPlane> planes)
      : sides_(std::move(sides)), planes_(std::move(planes)) {}
  NumberedSides(NumberedSides&&) = default;
  NumberedSides(const NumberedSides&) = delete;
  NumberedSides& operator=(NumberedSides&&) = default;
  NumberedSides& operator=(const NumberedSides&) = delete;
  ~NumberedSides() = default;

  std::size_t count() const { return sides_.size(); }
  std::span<const SidesOfPlane> planes() const { return planes_; }
  friend bool operator==(const NumberedSides& a, const NumberedSides& b);

 private:
  std::vector<Side> sides_;
  std::vector<SidesOfPlane> planes_;
};

enum class SideDirection { Kept, Reversed };

// Vertices are renamed to rename[vertex], and sides turned round if asked for.
// LAW sides.1  boundaries with the same faces, up to the order of planes, faces and loops and to
// how the loops of a plane are split, have equal sides. COST: O(sides log sides) at worst,
// O(sides) if vertices have few sides.
NumberedSides numbered_sides(const Boundary& boundary, std::span<const std::uint32_t> rename,
                             SideDirection direction = SideDirection::Kept);

}  // namespace exactcsg
