// SPDX-License-Identifier: Apache-2.0
#pragma once

// The sides of a boundary's faces in an order that does not depend on how faces, loops and planes
// are listed. Internal to digests and symmetries. [Exact]

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "exactcsg/solid/boundary.hpp"

namespace exactcsg {

// A plane's number, and one edge as a face in that plane has it: the face on the left.
using NumberedSide = std::array<std::uint32_t, 3>;

enum class SideDirection { Kept, Reversed };

// Vertices are renamed to rename[vertex], and sides turned round if asked for. Each oriented plane
// has the sorted list of its sides (from, to); planes are numbered in the lexicographic order of
// these lists. Sorted by plane, from, to.
// LAW sides.1  boundaries with the same faces, up to the order of planes, faces and loops and to
// how the loops of a plane are split, have the same list. COST: O(sides log sides) at worst,
// O(sides) if vertices have few sides.
std::vector<NumberedSide> numbered_sides(const Boundary& boundary,
                                         std::span<const std::uint32_t> rename,
                                         SideDirection direction = SideDirection::Kept);

}  // namespace exactcsg
