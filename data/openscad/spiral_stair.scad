// SPDX-License-Identifier: CC0-1.0
// A spiral stair of 36 wedges round a column: each step lies flush on the one below.
steps = 36;
rise = 3;
cylinder(r = 5, h = steps * rise, $fn = 36);
for (i = [0 : steps - 1]) rotate([0, 0, 20 * i]) translate([0, 0, i * rise])
    linear_extrude(height = rise) polygon([[0, 0], [40 * cos(-2), 40 * sin(-2)], [40 * cos(22), 40 * sin(22)]]);
