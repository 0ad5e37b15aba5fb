// SPDX-License-Identifier: CC0-1.0
// The symmetric difference of a unit cube and its 3-4-5 turn, and one difference beside it.
turn = [[0.6, -0.8, 0, 0], [0.8, 0.6, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]];
module a() { cube(1, center = true); }
module b() { multmatrix(turn) cube(1, center = true); }
difference() { a(); b(); }
difference() { b(); a(); }
translate([3, 0, 0]) difference() { a(); b(); }
