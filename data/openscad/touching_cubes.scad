// SPDX-License-Identifier: CC0-1.0
// Cubes that share a face, an edge or only a corner: a boundary that touches itself.
cube(10);
translate([10, 0, 0]) cube(10);
translate([10, 10, 10]) cube(10);
translate([0, 10, -10]) cube(10);
translate([-10, -10, 10]) cube(10);
