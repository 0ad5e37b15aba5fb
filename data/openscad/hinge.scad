// SPDX-License-Identifier: CC0-1.0
// A hinge of two leaves with five knuckles and a pin with play round it.
$fn = 30;
width = 50;
module leaf(knuckles) {
    difference() {
        union() {
            translate([5, 0, -2]) cube([30, width, 4]);
            for (i = knuckles) translate([0, i * 10 + 0.2, 0]) {
                rotate([-90, 0, 0]) cylinder(r = 5, h = 9.6);
                translate([0, 0, -2]) cube([6, 9.6, 4]);
            }
        }
        translate([0, -1, 0]) rotate([-90, 0, 0]) cylinder(r = 2.5, h = width + 2);
        for (y = [10, 25, 40]) translate([24, y, -3]) {
            cylinder(d = 4, h = 6);
            translate([0, 0, 3]) cylinder(d1 = 4, d2 = 8, h = 2.001);
        }
    }
}
leaf([0, 2, 4]);
rotate([0, 180, 0]) mirror([0, 0, 1]) leaf([1, 3]);
translate([0, 0, 0]) rotate([-90, 0, 0]) cylinder(r = 2.2, h = width);
