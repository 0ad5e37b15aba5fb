// SPDX-License-Identifier: CC0-1.0
// The two tetrahedra inscribed in a unit cube (stella octangula): union 1/2.
module first() {
    polyhedron(points = [[0, 0, 0], [1, 1, 0], [1, 0, 1], [0, 1, 1]],
               faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]);
}
module second() { translate([1, 0, 0]) mirror([1, 0, 0]) first(); }
first();
second();
