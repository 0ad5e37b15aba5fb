// SPDX-License-Identifier: CC0-1.0
// A unit cube with its corners cut by the octahedron |x| + |y| + |z| <= 1: volume 5/6.
intersection() {
    cube(1, center = true);
    union() {
        cylinder(r1 = 1, r2 = 0, h = 1, $fn = 4);
        mirror([0, 0, 1]) cylinder(r1 = 1, r2 = 0, h = 1, $fn = 4);
    }
}
