// SPDX-License-Identifier: CC0-1.0
// A box with rounded edges as the hull of eight spheres, hollowed by a smaller one.
module rounded(size, radius) {
    hull() for (x = [0, 1], y = [0, 1], z = [0, 1])
        translate([x * size.x, y * size.y, z * size.z]) sphere(r = radius, $fn = 20);
}
difference() {
    rounded([40, 25, 12], 4);
    translate([2, 2, 2]) rounded([36, 21, 30], 3);
}
