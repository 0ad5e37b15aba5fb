// SPDX-License-Identifier: CC0-1.0
// Five hollow boxes, each inside the cavity of the next: ten shells, five components.
module shell(side, wall) {
    difference() {
        cube(side, center = true);
        cube(side - 2 * wall, center = true);
    }
}
for (i = [1 : 5]) shell(10 * i, 2);
