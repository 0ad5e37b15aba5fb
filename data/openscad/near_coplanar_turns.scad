// SPDX-License-Identifier: CC0-1.0
// Blocks turned by 1e-3, 1e-4 and 1e-5 degrees against one another: faces that almost coincide.
for (i = [0 : 2]) translate([40 * i, 0, 0]) {
    angle = pow(10, -3 - i);
    union() {
        cube([20, 20, 10], center = true);
        rotate([0, 0, angle]) cube([20, 20, 10], center = true);
        rotate([angle, 0, 0]) cube([20, 20, 10], center = true);
    }
}
