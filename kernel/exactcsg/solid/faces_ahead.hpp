// SPDX-License-Identifier: Apache-2.0
#pragma once

// Asks for the memory of faces before a pass over them reads it: the loops of each face and the
// vertices of each loop lie anywhere. Internal to figures and digests.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "exactcsg/solid/boundary.hpp"

namespace exactcsg {

// To be called for each face in turn, from the first to the last. ask_for_vertex(vertex) is called
// for vertices that will be read soon: those of a face's first loop, if they are few, as most
// faces have no more.
template <class AskForVertex>
void ask_for_faces_after(std::span<const BoundaryFace> faces, std::size_t face,
                         AskForVertex ask_for_vertex) {
  constexpr std::size_t distance = 6;
  constexpr std::size_t most_vertices = 16;
  if (face + 3 * distance >= faces.size()) return;
  __builtin_prefetch(faces[face + 3 * distance].loops.data());
  if (const auto& loops = faces[face + 2 * distance].loops; !loops.empty()) {
    __builtin_prefetch(loops.front().data());
  }
  if (const auto& loops = faces[face + distance].loops; !loops.empty()) {
    const std::span<const std::uint32_t> loop = loops.front();
    for (const std::uint32_t vertex : loop.first(std::min(loop.size(), most_vertices))) {
      ask_for_vertex(vertex);
    }
  }
}

}  // namespace exactcsg
