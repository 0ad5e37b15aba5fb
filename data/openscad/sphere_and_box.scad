// SPDX-License-Identifier: CC0-1.0
// A ball that bulges through the six faces of a box, cut out of it, and the ball less the box.
$fn = 40;
difference() { cube(16, center = true); sphere(r = 10); }
translate([30, 0, 0]) difference() { sphere(r = 10); cube(16, center = true); }
translate([60, 0, 0]) intersection() { sphere(r = 10); cube(16, center = true); }
