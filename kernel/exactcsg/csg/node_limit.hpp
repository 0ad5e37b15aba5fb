// SPDX-License-Identifier: Apache-2.0
#pragma once

// How many nodes of a tree are visited where every occurrence counts: a tree with shared subtrees
// may stand for exponentially many. [Exact]

#include <cstdint>
#include <string>

#include "exactcsg/support/error.hpp"

namespace exactcsg::csg {

constexpr std::uint64_t default_node_limit = 50'000'000;

// THROWS Error(TooLarge) if node_count > limit.
inline void require_node_limit(std::uint64_t node_count, std::uint64_t limit) {
  if (node_count <= limit) return;
  throw Error(ErrorId::TooLarge, {"a CSG tree of " + std::to_string(node_count) + " nodes",
                                  "at most " + std::to_string(limit)});
}

}  // namespace exactcsg::csg
