// SPDX-License-Identifier: CC0-1.0
// A dovetail joint pushed together without play: tails and pins have their faces in common.
tails = 4;
module tails_2d(play) {
    for (i = [0 : tails - 1]) translate([i * 16, 0])
        polygon([[4 - play, 0], [12 + play, 0], [14 + play, 12], [2 - play, 12]]);
}
module tail_board() {
    translate([0, -40, 0]) cube([tails * 16, 40, 10]);
    linear_extrude(height = 10) tails_2d(0);
}
module pin_board() {
    difference() {
        cube([tails * 16, 12, 50]);
        linear_extrude(height = 10) tails_2d(0);
    }
}
tail_board();
pin_board();
