// SPDX-License-Identifier: CC0-1.0
// A T-slot profile: 2-D Booleans of squares, circles and polygons, extruded with holes.
module slot() {
    translate([10, 0]) {
        square([12, 6], center = true);
        translate([-2.5, 0]) square([5, 11], center = true);
    }
}
difference() {
    linear_extrude(height = 80) difference() {
        square(30, center = true);
        for (i = [0 : 3]) rotate(90 * i) translate([2, 0]) slot();
        circle(d = 5, $fn = 24);
        for (x = [-1, 1], y = [-1, 1]) translate([11.5 * x, 11.5 * y]) circle(d = 3, $fn = 12);
    }
    translate([0, 0, 40]) rotate([0, 90, 0]) cylinder(d = 8, h = 40, center = true, $fn = 20);
}
