// SPDX-License-Identifier: CC0-1.0
// Blocks set flush against each other on every side: seams vanish, coplanar faces become one.
cube([30, 30, 5]);
translate([0, 0, 5]) cube([30, 5, 10]);
translate([0, 25, 5]) cube([30, 5, 10]);
translate([0, 5, 5]) cube([5, 20, 10]);
translate([25, 5, 5]) cube([5, 20, 10]);
difference() {
    translate([5, 5, 5]) cube([20, 20, 10]);
    translate([10, 10, 5]) cube([10, 10, 10]);
}
