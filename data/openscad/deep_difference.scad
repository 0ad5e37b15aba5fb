// SPDX-License-Identifier: CC0-1.0
// A chain of 200 nested differences: box 200 taken from box 199, and so on down to box 1.
module peel(i, last) {
    s = 2 * (last - i) + 2;
    difference() {
        cube(s, center = true);
        if (i < last) peel(i + 1, last);
    }
}
peel(0, 200);
