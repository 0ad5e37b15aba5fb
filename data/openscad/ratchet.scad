// SPDX-License-Identifier: CC0-1.0
// A ratchet wheel with saw teeth and its pawl, tip to tooth.
teeth = 16;
linear_extrude(height = 5) difference() {
    union() {
        circle(r = 20, $fn = 64);
        for (i = [0 : teeth - 1]) rotate(i * 360 / teeth) polygon([[18, 0], [24, 0], [19.5, 8]]);
    }
    circle(r = 4, $fn = 24);
    for (i = [0 : 4]) rotate(72 * i) translate([12, 0]) circle(r = 3, $fn = 20);
}
linear_extrude(height = 5) difference() {
    hull() { translate([21, -0.4]) circle(r = 0.4, $fn = 8); translate([40, -14]) circle(r = 5, $fn = 24); }
    translate([40, -14]) circle(r = 2, $fn = 16);
    circle(r = 20, $fn = 64);
}
