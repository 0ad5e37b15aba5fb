// SPDX-License-Identifier: CC0-1.0
// A house with a valley in its roof: one non-convex polyhedron, and a chimney that meets it.
translate([0, 0, 0]) polyhedron(
    points = [
        [0, 0, 0], [40, 0, 0], [40, 30, 0], [0, 30, 0],
        [0, 0, 20], [40, 0, 20], [40, 30, 20], [0, 30, 20],
        [10, 0, 32], [20, 0, 24], [30, 0, 32],
        [10, 30, 32], [20, 30, 24], [30, 30, 32]
    ],
    faces = [
        [0, 1, 2, 3],
        [0, 4, 8, 9, 10, 5, 1],
        [3, 2, 6, 13, 12, 11, 7],
        [0, 3, 7, 4], [1, 5, 6, 2],
        [4, 7, 11, 8], [8, 11, 12, 9], [9, 12, 13, 10], [10, 13, 6, 5]
    ]);
translate([6, 20, 20]) cube([4, 4, 16]);
