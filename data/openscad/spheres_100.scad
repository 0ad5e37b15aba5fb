// SPDX-License-Identifier: CC0-1.0
// The union of 100 spheres at seeded places, each of which meets about three others.
count = 100;
radius = 1;
// A sphere of radius 2 r round each centre holds three others: side^3 = count * 4/3 pi (2 r)^3 / 3.
side = radius * pow(count * 4 / 3 * PI * 8 / 3, 1 / 3);
place = rands(0, side, 3 * count, 20251122);
for (i = [0 : count - 1])
    translate([place[3 * i], place[3 * i + 1], place[3 * i + 2]]) sphere(r = radius, $fn = 32);
