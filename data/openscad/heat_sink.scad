// SPDX-License-Identifier: CC0-1.0
// A heat sink of fins cut crosswise into pins on a base with mounting holes.
fins = 16;
difference() {
    union() {
        cube([fins * 4 - 2, 60, 5]);
        for (i = [0 : fins - 1]) translate([i * 4, 0, 5]) cube([2, 60, 20]);
    }
    for (j = [1 : 9]) translate([-1, j * 6 - 1, 8]) cube([fins * 4, 2, 20]);
    for (x = [7, 55], y = [7, 53]) translate([x, y, -1]) cylinder(d = 3.2, h = 40, $fn = 16);
}
