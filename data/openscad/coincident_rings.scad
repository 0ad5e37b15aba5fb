// SPDX-License-Identifier: CC0-1.0
// Rings that share their inner, outer and end faces exactly, added and taken away again.
module ring(outer, inner, low, high) {
    translate([0, 0, low]) difference() {
        cylinder(r = outer, h = high - low, $fn = 36);
        cylinder(r = inner, h = high - low, $fn = 36);
    }
}
difference() {
    union() {
        ring(20, 15, 0, 10);
        ring(15, 10, 0, 10);
        ring(20, 10, 10, 14);
        ring(25, 20, 4, 10);
    }
    ring(15, 10, 4, 10);
    ring(25, 20, 8, 10);
}
