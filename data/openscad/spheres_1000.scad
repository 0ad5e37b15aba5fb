// SPDX-License-Identifier: CC0-1.0
// The union of 1000 spheres at seeded places, each of which meets about three others.
count = 1000;
radius = 1;
side = radius * pow(count * 4 / 3 * PI * 8 / 3, 1 / 3);
place = rands(0, side, 3 * count, 20251123);
for (i = [0 : count - 1])
    translate([place[3 * i], place[3 * i + 1], place[3 * i + 2]]) sphere(r = radius, $fn = 32);
