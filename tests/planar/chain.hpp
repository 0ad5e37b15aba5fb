// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// A tree as deep as it has figures.

#include "io/planar_support.hpp"

namespace exactcsg::test {

// Rectangles in a row, each two of which overlap by half, taken away and added in turn. What is
// added stays but for the half that the next takes away: for even n, n / 2 unit squares.
inline PlanarTree chain_of_rectangles(int n) {
  PlanarTree chain = io::test::box(0, 0, 2, 1);
  for (int i = 1; i < n; ++i) {
    PlanarTree next = io::test::box(i, 0, i + 2, 1);
    chain = i % 2 == 1 ? csg::subtract(std::move(chain), std::move(next))
                       : csg::unite(std::move(chain), std::move(next));
  }
  return chain;
}

}  // namespace exactcsg::test
