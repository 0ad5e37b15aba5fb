// SPDX-License-Identifier: CC0-1.0
// A wall of bricks laid flush in stretcher bond with an opening: 190 boxes without a gap.
rows = 16;
columns = 12;
difference() {
    for (r = [0 : rows - 1], c = [0 : columns - 1])
        translate([c * 24 - (r % 2) * 12, 0, r * 7]) cube([24, 11, 7]);
    translate([100, 0, 28]) cube([60, 11, 42]);
    translate([-12, 0, 0]) cube([12, 11, rows * 7]);
    translate([(columns - 0.5) * 24, 0, 0]) cube([12, 11, rows * 7]);
}
