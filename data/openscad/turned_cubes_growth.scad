// SPDX-License-Identifier: CC0-1.0
// A unit cube intersected with its turns by 1 .. 6 times the 3-4-5 angle: rationals that grow.
turn = [[0.6, -0.8, 0, 0], [0.8, 0.6, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]];

module turned(n) {
    if (n == 0) cube(1, center = true);
    else multmatrix(turn) turned(n - 1);
}

module section(n) {
    intersection_for (k = [0 : n]) turned(k);
}

for (n = [1 : 6]) translate([2 * n, 0, 0]) section(n);
