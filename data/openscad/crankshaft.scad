// SPDX-License-Identifier: CC0-1.0
// A crankshaft of discs, pins and webs in line, each web turned by 120 degrees.
$fn = 32;
module throw(angle) {
    rotate([0, 0, angle]) {
        hull() { cylinder(r = 12, h = 5); translate([14, 0, 0]) cylinder(r = 8, h = 5); }
        translate([14, 0, 5]) cylinder(r = 6, h = 12);
        translate([0, 0, 17]) hull() { cylinder(r = 12, h = 5); translate([14, 0, 0]) cylinder(r = 8, h = 5); }
    }
}
for (i = [0 : 2]) translate([0, 0, i * 32]) {
    throw(120 * i);
    translate([0, 0, 22]) cylinder(r = 8, h = 10);
}
translate([0, 0, -14]) cylinder(r = 8, h = 14);
