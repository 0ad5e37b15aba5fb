// SPDX-License-Identifier: CC0-1.0
// A pipe flange with raised face, twelve bolt holes and a welding neck.
$fn = 64;
bolts = 12;
difference() {
    union() {
        cylinder(r = 60, h = 14);
        translate([0, 0, 14]) cylinder(r1 = 36, r2 = 27, h = 22);
        translate([0, 0, 36]) cylinder(r = 27, h = 12);
        translate([0, 0, -2]) cylinder(r = 44, h = 2);
    }
    translate([0, 0, -3]) cylinder(r = 22, h = 60);
    for (i = [0 : bolts - 1]) rotate([0, 0, i * 360 / bolts]) translate([51, 0, -1]) cylinder(r = 4.5, h = 20, $fn = 24);
}
