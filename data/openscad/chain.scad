// SPDX-License-Identifier: CC0-1.0
// Twelve chain links that hang in each other without touching: as many components, each of genus 1.
module link() {
    for (s = [-1, 1]) {
        translate([0, s * 5, 0]) rotate([0, 90, 0]) cylinder(r = 2, h = 10, center = true, $fn = 16);
        translate([s * 5, 0, 0]) rotate([0, 0, s * -90]) rotate_extrude(angle = 180, $fn = 32)
            translate([5, 0]) circle(r = 2, $fn = 16);
    }
}
for (i = [0 : 11]) translate([i * 14.5, 0, 0]) rotate([90 * (i % 2) + 45, 0, 0]) link();
