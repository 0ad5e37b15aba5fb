// SPDX-License-Identifier: CC0-1.0
// A left and a right hand clamp: the right one is the mirror image, both meet in the plane x = 0.
module clamp() {
    difference() {
        union() {
            cube([20, 12, 10]);
            translate([20, 6, 0]) cylinder(r = 6, h = 10, $fn = 28);
        }
        translate([20, 6, -1]) cylinder(r = 3, h = 12, $fn = 28);
        translate([20, 5, -1]) cube([10, 2, 12]);
        translate([8, -1, 5]) rotate([-90, 0, 0]) cylinder(r = 2, h = 14, $fn = 18);
    }
}
clamp();
mirror([1, 0, 0]) clamp();
translate([0, 30, 0]) mirror([1, 1, 0]) clamp();
