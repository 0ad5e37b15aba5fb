// SPDX-License-Identifier: CC0-1.0
// A perforated plate with 50 x 50 round holes.
rows = 50;
step = 4;
difference() {
    cube([rows * step, rows * step, 3]);
    for (i = [0 : rows - 1], j = [0 : rows - 1])
        translate([step * (i + 0.5), step * (j + 0.5), -1]) cylinder(r = 1.5, h = 5, $fn = 12);
}
