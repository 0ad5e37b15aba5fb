// SPDX-License-Identifier: CC0-1.0
// A unit cube and its turn by the 3-4-5 angle, intersected: volume 5/6, area 5.
turn = [[0.6, -0.8, 0, 0], [0.8, 0.6, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]];
intersection() {
    cube(1, center = true);
    multmatrix(turn) cube(1, center = true);
}
