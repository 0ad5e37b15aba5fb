// SPDX-License-Identifier: CC0-1.0
// An octet-like lattice of struts: hulls of small cubes between the nodes of a grid, cut to a block.
n = 3;
step = 10;
module node(p) { translate(p * step) cube(1.6, center = true); }
module strut(p, q) { hull() { node(p); node(q); } }
intersection() {
    union() for (x = [0 : n - 1], y = [0 : n - 1], z = [0 : n - 1]) {
        o = [x, y, z];
        strut(o, o + [1, 0, 0]);
        strut(o, o + [0, 1, 0]);
        strut(o, o + [0, 0, 1]);
        strut(o, o + [1, 1, 0]);
        strut(o, o + [0, 1, 1]);
        strut(o, o + [1, 0, 1]);
    }
    translate([-0.5, -0.5, -0.5]) cube(n * step);
}
