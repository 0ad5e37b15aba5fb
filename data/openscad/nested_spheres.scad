// SPDX-License-Identifier: CC0-1.0
// Hollow spheres in each other, cut open by an octant so that the shells show.
difference() {
    for (i = [1 : 4]) difference() {
        sphere(r = 5 * i, $fn = 24);
        sphere(r = 5 * i - 2, $fn = 24);
    }
    translate([0, -50, 0]) cube([50, 50, 50]);
}
