// SPDX-License-Identifier: CC0-1.0
// A square ring as one polyhedron of genus 1, crossed by a second one. Its faces are triangles: those
// of four corners would not be planar any more once OpenSCAD has cut the turned one to its grid.
module frame(outer, inner, height) {
    o = outer / 2;
    i = inner / 2;
    ring = [[-o, -o], [o, -o], [o, o], [-o, o], [-i, -i], [i, -i], [i, i], [-i, i]];
    points = concat([for (p = ring) [p.x, p.y, 0]], [for (p = ring) [p.x, p.y, height]]);
    next = [1, 2, 3, 0];
    quadrilaterals = concat(
        [for (k = [0 : 3]) [k, next[k], 4 + next[k], 4 + k]],
        [for (k = [0 : 3]) [8 + k, 12 + k, 12 + next[k], 8 + next[k]]],
        [for (k = [0 : 3]) [k, 8 + k, 8 + next[k], next[k]]],
        [for (k = [0 : 3]) [4 + k, 4 + next[k], 12 + next[k], 12 + k]]);
    faces = [for (q = quadrilaterals, t = [[0, 1, 2], [0, 2, 3]]) [for (i = t) q[i]]];
    polyhedron(points = points, faces = faces);
}
frame(40, 28, 6);
translate([20, 0, 3]) rotate([90, 0, 30]) translate([0, 0, -3]) frame(30, 20, 6);
