// SPDX-License-Identifier: CC0-1.0
// A belt pulley: turned profile with groove, spokes cut by hulls, a set screw.
$fn = 56;
difference() {
    rotate_extrude() polygon([[5, 0], [12, 0], [12, 4], [34, 4], [34, 0], [40, 0], [40, 3], [35, 8], [40, 13], [40, 16], [34, 16],
                              [34, 12], [12, 12], [12, 20], [5, 20]]);
    for (i = [0 : 4]) rotate([0, 0, 72 * i]) hull() {
        translate([18, 0, -1]) cylinder(r = 3, h = 20, $fn = 20);
        translate([27, 6, -1]) cylinder(r = 4, h = 20, $fn = 20);
        translate([27, -6, -1]) cylinder(r = 4, h = 20, $fn = 20);
    }
    translate([0, 0, 17]) rotate([0, 90, 0]) cylinder(d = 3, h = 20, $fn = 16);
}
