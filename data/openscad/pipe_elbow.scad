// SPDX-License-Identifier: CC0-1.0
// A pipe bend of 90 degrees with flanges: rotate_extrude over part of a turn, with a hole.
$fn = 48;
module section() { translate([30, 0]) difference() { circle(r = 10); circle(r = 8); } }
module flange() {
    difference() {
        cylinder(r = 17, h = 4);
        translate([0, 0, -1]) cylinder(r = 8, h = 6);
        for (i = [0 : 3]) rotate([0, 0, 45 + 90 * i]) translate([13.5, 0, -1])
            cylinder(d = 4, h = 6, $fn = 16);
    }
}
rotate_extrude(angle = 90) section();
translate([30, 0, 0]) rotate([90, 0, 0]) flange();
translate([0, 30, 0]) rotate([0, -90, 0]) flange();
