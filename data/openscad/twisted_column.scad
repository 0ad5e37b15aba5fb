// SPDX-License-Identifier: CC0-1.0
// A column by linear_extrude with twist and scale on a stepped base.
translate([0, 0, 6]) linear_extrude(height = 60, twist = 120, slices = 24, scale = 0.6) difference() {
    square(20, center = true);
    circle(r = 5, $fn = 16);
}
translate([0, 0, 3]) cube([30, 30, 6], center = true);
translate([0, 0, 68]) cube([18, 18, 4], center = true);
