// SPDX-License-Identifier: CC0-1.0
// A spring of 96 hulls of neighbouring discs, with ground ends.
turns = 4;
per_turn = 24;
module disc(i) {
    rotate([0, 0, i * 360 / per_turn]) translate([15, 0, i * 7 / per_turn]) rotate([90, 0, 0])
        cylinder(r = 2, h = 0.1, $fn = 12);
}
intersection() {
    for (i = [0 : turns * per_turn - 1]) hull() { disc(i); disc(i + 1); }
    cylinder(r = 30, h = turns * 7);
}
