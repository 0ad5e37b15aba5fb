// SPDX-License-Identifier: CC0-1.0
// The intersection of a unit cube with its turn by the 7-24-25 angle: volume 25/28.
turn = [[0.96, -0.28, 0, 0], [0.28, 0.96, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]];
intersection() {
    cube(1, center = true);
    multmatrix(turn) cube(1, center = true);
}
