// SPDX-License-Identifier: CC0-1.0
// Cylinders and cones that stand cap on cap, same radius and smaller ones, with a common bore.
$fn = 40;
difference() {
    union() {
        cylinder(r = 20, h = 5);
        translate([0, 0, 5]) cylinder(r1 = 20, r2 = 12, h = 8);
        translate([0, 0, 13]) cylinder(r = 12, h = 10);
        translate([0, 0, 23]) cylinder(r = 12, h = 4);
        translate([0, 0, 27]) cylinder(r1 = 12, r2 = 16, h = 3);
        translate([0, 0, 30]) cylinder(r = 16, h = 2);
    }
    cylinder(r = 6, h = 13);
    translate([0, 0, 13]) cylinder(r = 6, h = 19);
}
