// SPDX-License-Identifier: CC0-1.0
// Three quarters of a torus and a full one that goes through it.
rotate_extrude(angle = 270, $fn = 36) translate([20, 0]) circle(r = 5, $fn = 18);
translate([20, 0, 0]) rotate([90, 0, 0]) rotate_extrude($fn = 36) translate([12, 0]) circle(r = 3, $fn = 18);
