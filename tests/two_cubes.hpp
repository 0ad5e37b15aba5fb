// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace exactcsg::test {

// An OFF file of two cubes of side 2 that share a unit cube: 15 in all, 14 in one alone.
inline constexpr const char* two_cubes =
    "OFF\n16 12 0\n"
    "0 0 0\n2 0 0\n0 2 0\n2 2 0\n0 0 2\n2 0 2\n0 2 2\n2 2 2\n"
    "1 1 1\n3 1 1\n1 3 1\n3 3 1\n1 1 3\n3 1 3\n1 3 3\n3 3 3\n"
    "4 0 4 6 2\n4 1 3 7 5\n4 0 1 5 4\n4 2 6 7 3\n4 0 2 3 1\n4 4 5 7 6\n"
    "4 8 12 14 10\n4 9 11 15 13\n4 8 9 13 12\n4 10 14 15 11\n4 8 10 11 9\n4 12 13 15 14\n";

}  // namespace exactcsg::test
