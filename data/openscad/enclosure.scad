// SPDX-License-Identifier: CC0-1.0
// An enclosure with ribs, screw posts, vents and a lid with a lip beside it.
size = [90, 60, 30];
wall = 2;
module rounded_rect(s, r) {
    hull() for (x = [r, s.x - r], y = [r, s.y - r]) translate([x, y]) circle(r = r, $fn = 24);
}
module post(x, y) {
    translate([x, y, wall]) difference() {
        cylinder(d = 7, h = size.z - 6, $fn = 24);
        translate([0, 0, 4]) cylinder(d = 2.5, h = size.z, $fn = 16);
    }
}
module box() {
    difference() {
        linear_extrude(height = size.z) rounded_rect(size, 5);
        translate([wall, wall, wall]) linear_extrude(height = size.z) rounded_rect(size - 2 * [wall, wall, 0], 3);
        for (i = [0 : 9]) translate([15 + 6 * i, -1, 8]) cube([3, wall + 2, 14]);
        translate([-1, 20, 12]) cube([wall + 2, 14, 9]);
    }
    for (x = [8, size.x - 8], y = [8, size.y - 8]) post(x, y);
    for (x = [30, 60]) translate([x, wall, wall]) cube([1.5, size.y - 2 * wall, 4]);
}
module lid() {
    difference() {
        union() {
            linear_extrude(height = 3) rounded_rect(size, 5);
            translate([wall + 0.2, wall + 0.2, 3]) linear_extrude(height = 3)
                rounded_rect(size - 2 * [wall + 0.2, wall + 0.2, 0], 2.8);
        }
        translate([2 * wall, 2 * wall, 3]) linear_extrude(height = 4) rounded_rect(size - 4 * [wall, wall, 0], 1.5);
        for (x = [8, size.x - 8], y = [8, size.y - 8]) translate([x, y, -1]) {
            cylinder(d = 3, h = 10, $fn = 16);
            cylinder(d1 = 7, d2 = 3, h = 3, $fn = 16);
        }
    }
}
box();
translate([0, size.y + 10, 0]) lid();
