// SPDX-License-Identifier: CC0-1.0
// A building block of 4 x 2 studs, hollow, with tubes inside.
$fn = 28;
pitch = 8;
nx = 4;
ny = 2;
difference() {
    cube([nx * pitch, ny * pitch, 9.6]);
    translate([1.5, 1.5, 0]) cube([nx * pitch - 3, ny * pitch - 3, 8.6]);
}
for (i = [0 : nx - 1], j = [0 : ny - 1]) translate([(i + 0.5) * pitch, (j + 0.5) * pitch, 9.6]) cylinder(d = 4.8, h = 1.8);
for (i = [1 : nx - 1]) translate([i * pitch, pitch, 0]) difference() {
    cylinder(d = 6.5, h = 8.6);
    cylinder(d = 4.8, h = 8.6);
}
