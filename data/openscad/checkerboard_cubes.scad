// SPDX-License-Identifier: CC0-1.0
// A 6 x 6 x 6 block of which every second unit cube is there: edges and corners touch everywhere.
n = 6;
for (x = [0 : n - 1], y = [0 : n - 1], z = [0 : n - 1])
    if ((x + y + z) % 2 == 0) translate([x, y, z]) cube(1);
