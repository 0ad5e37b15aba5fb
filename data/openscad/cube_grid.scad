// SPDX-License-Identifier: CC0-1.0
// A stepped heap of unit cubes: volume is their number, area the number of exposed faces.
height = [[5, 4, 3, 2, 1], [4, 4, 3, 2, 1], [3, 3, 3, 2, 1], [2, 2, 2, 2, 1], [1, 1, 1, 1, 1]];
for (x = [0 : 4], y = [0 : 4]) for (z = [0 : height[x][y] - 1]) translate([x, y, z]) cube(1);
