// SPDX-License-Identifier: CC0-1.0
// A block cut by its own copies, turned by 1e-3 .. 1e-5 degrees: slivers are what is left.
for (i = [0 : 2]) translate([0, 40 * i, 0]) difference() {
    cube([30, 30, 10], center = true);
    rotate([0, 0, pow(10, -3 - i)]) cube([30, 30, 20], center = true);
}
for (i = [0 : 2]) translate([50, 40 * i, 0]) intersection() {
    cube([30, 30, 10], center = true);
    rotate([0, pow(10, -3 - i), 0]) cube([30, 30, 10], center = true);
    rotate([pow(10, -3 - i), 0, 0]) cube([30, 30, 10], center = true);
}
