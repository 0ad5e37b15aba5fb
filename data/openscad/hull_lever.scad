// SPDX-License-Identifier: CC0-1.0
// A lever of three hulls of cylinders with bores at their ends.
$fn = 32;
module eye(r, h) { cylinder(r = r, h = h); }
difference() {
    union() {
        hull() { eye(10, 8); translate([50, 0, 0]) eye(6, 8); }
        hull() { eye(10, 8); translate([-15, 30, 0]) eye(5, 8); }
        hull() { translate([50, 0, 0]) eye(6, 8); translate([60, 20, 4]) sphere(r = 3); }
    }
    translate([0, 0, -1]) eye(5, 10);
    translate([50, 0, -1]) eye(3, 10);
    translate([-15, 30, -1]) eye(2.5, 10);
}
