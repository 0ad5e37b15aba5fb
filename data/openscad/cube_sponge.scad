// SPDX-License-Identifier: CC0-1.0
// The sponge of level 2 the other way round: the union of the 400 unit cubes that remain.
function digit(x, k) = floor(x / pow(3, k)) % 3;
function ones(x, y, z, k) = (digit(x, k) == 1 ? 1 : 0) + (digit(y, k) == 1 ? 1 : 0) + (digit(z, k) == 1 ? 1 : 0);
function kept(x, y, z) = ones(x, y, z, 0) < 2 && ones(x, y, z, 1) < 2;
for (x = [0 : 8], y = [0 : 8], z = [0 : 8]) if (kept(x, y, z)) translate([x, y, z]) cube(1);
