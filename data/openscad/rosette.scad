// SPDX-License-Identifier: CC0-1.0
// Intersection and difference of circles in the plane, scaled while extruded.
linear_extrude(height = 12, scale = [0.5, 0.75]) difference() {
    union() for (i = [0 : 5]) rotate(60 * i) intersection() {
        translate([12, 6]) circle(r = 14, $fn = 40);
        translate([12, -6]) circle(r = 14, $fn = 40);
    }
    circle(r = 4, $fn = 30);
}
