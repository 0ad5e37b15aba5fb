// SPDX-License-Identifier: CC0-1.0
// A stellated octahedron of 24 triangles (non-convex) with a hole through its middle.
points = [
    [20, 20, 20], [20, 20, -20], [20, -20, 20], [20, -20, -20],
    [-20, 20, 20], [-20, 20, -20], [-20, -20, 20], [-20, -20, -20],
    [20, 0, 0], [-20, 0, 0], [0, 20, 0], [0, -20, 0], [0, 0, 20], [0, 0, -20]
];
// Over each face of the octahedron stands a pyramid; its three sides.
function spike(tip, a, b, c) = [[tip, b, a], [tip, c, b], [tip, a, c]];
faces = concat(
    spike(0, 8, 10, 12), spike(1, 8, 13, 10), spike(2, 8, 12, 11), spike(3, 8, 11, 13),
    spike(4, 9, 12, 10), spike(5, 9, 10, 13), spike(6, 9, 11, 12), spike(7, 9, 13, 11));
difference() {
    polyhedron(points = points, faces = faces);
    cube([8, 8, 60], center = true);
}
