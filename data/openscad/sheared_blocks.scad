// SPDX-License-Identifier: CC0-1.0
// Blocks under shears and uneven scales, some mirrored by the matrix, cut by one another.
difference() {
    multmatrix([[1, 0.25, 0, 0], [0, 1, 0.5, 0], [0, 0, 1, 0]]) cube([20, 20, 20]);
    multmatrix([[0, 1, 0, 4], [1, 0, 0, 2], [0, 0, 1.5, -5]]) cube([10, 8, 20]);
    multmatrix([[1, 0, 0.5, 0], [0, -1, 0, 30], [0.125, 0, 1, 5]]) cube([30, 10, 5]);
}
translate([40, 0, 0]) scale([2, 0.5, 1]) rotate([0, 0, 45]) cube(10);
