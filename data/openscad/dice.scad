// SPDX-License-Identifier: CC0-1.0
// A die: a cube rounded by a sphere, pips sunk as spheres in its six faces.
module pips(n) {
    if (n % 2 == 1) sphere(r = 1.4, $fn = 16);
    if (n > 1) for (s = [-1, 1]) translate([s * 4, s * 4, 0]) sphere(r = 1.4, $fn = 16);
    if (n > 3) for (s = [-1, 1]) translate([s * 4, -s * 4, 0]) sphere(r = 1.4, $fn = 16);
    if (n == 6) for (s = [-1, 1]) translate([s * 4, 0, 0]) sphere(r = 1.4, $fn = 16);
}
difference() {
    intersection() {
        cube(16, center = true);
        sphere(r = 11.5, $fn = 48);
    }
    translate([0, 0, 8]) pips(1);
    translate([0, 0, -8]) pips(6);
    rotate([90, 0, 0]) translate([0, 0, 8]) pips(2);
    rotate([-90, 0, 0]) translate([0, 0, 8]) pips(5);
    rotate([0, 90, 0]) translate([0, 0, 8]) pips(3);
    rotate([0, -90, 0]) translate([0, 0, 8]) pips(4);
}
