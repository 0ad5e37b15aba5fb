// SPDX-License-Identifier: CC0-1.0
// A mounting plate whose holes and slots are drilled at odd angles through its faces.
difference() {
    union() {
        cube([80, 30, 8], center = true);
        translate([0, 0, 10]) cube([20, 30, 20], center = true);
    }
    for (i = [-3, -2, 2, 3]) translate([i * 11, 0, 0])
        rotate([i * 7, i * 5, 0]) cylinder(d = 6, h = 40, center = true, $fn = 20);
    for (a = [0 : 36 : 179]) translate([0, 0, 12]) rotate([0, 0, a]) rotate([90, 0, 0])
        cylinder(d = 3, h = 60, center = true, $fn = 16);
    translate([0, 0, 12]) rotate([0, 13, 0]) cylinder(d = 9, h = 60, center = true, $fn = 30);
}
