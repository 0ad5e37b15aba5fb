// SPDX-License-Identifier: CC0-1.0
// A knob whose grip is knurled by helical cuts in both directions.
difference() {
    union() {
        cylinder(r = 15, h = 14, $fn = 60);
        translate([0, 0, 14]) cylinder(r1 = 15, r2 = 12, h = 3, $fn = 60);
        translate([0, 0, -10]) cylinder(r = 8, h = 10, $fn = 40);
    }
    for (i = [0 : 29]) for (side = [-1, 1]) rotate([0, 0, i * 12])
        translate([15, 0, 7]) rotate([side * 35, 0, 0]) rotate([0, 0, 45])
            cube([1.4, 1.4, 30], center = true);
    translate([0, 0, -11]) cylinder(d = 6, h = 20, $fn = 30);
    translate([0, 0, -11]) intersection() {
        cylinder(d = 6.5, h = 20, $fn = 30);
        translate([0, 5, 10]) cube([10, 6, 20], center = true);
    }
}
