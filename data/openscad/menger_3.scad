// SPDX-License-Identifier: CC0-1.0
// Menger sponge of level 3 with side 27: volume 8000.
module menger(level) {
    side = pow(3, level);
    difference() {
        cube(side);
        for (k = [1 : level]) holes(side, pow(3, level - k), 0, 0, k);
    }
}
// The holes of the k-th level that lie in no hole of a level before.
module holes(side, width, x, y, k, step = 1) {
    block = side / pow(3, step);
    for (i = [0 : 2], j = [0 : 2]) {
        if (step < k) { if (i != 1 || j != 1) holes(side, width, x + i * block, y + j * block, k, step + 1); }
        else if (i == 1 && j == 1) {
            translate([x + block, y + block, 0]) cube([width, width, side]);
            translate([x + block, 0, y + block]) cube([width, side, width]);
            translate([0, x + block, y + block]) cube([side, width, width]);
        }
    }
}
menger(3);
