// SPDX-License-Identifier: CC0-1.0
// A cube of 20 with one corner of 10 cut out: the smallest difference there is.
difference() {
    cube(20);
    translate([10, 10, 10]) cube(10);
}
