// SPDX-License-Identifier: CC0-1.0
// A castle of four round towers with battlements, walls, a gate and windows.
module battlements(r, n) {
    for (i = [0 : n - 1]) rotate([0, 0, i * 360 / n]) translate([r - 1, 0, 0]) translate([-1, -1.2, 0]) cube([2, 2.4, 3]);
}
module tower(height) {
    difference() {
        union() {
            cylinder(r = 8, h = height, $fn = 32);
            translate([0, 0, height]) cylinder(r1 = 8, r2 = 10, h = 3, $fn = 32);
            translate([0, 0, height + 3]) cylinder(r = 10, h = 2, $fn = 32);
            translate([0, 0, height + 5]) battlements(9.5, 10);
        }
        translate([0, 0, 3]) cylinder(r = 6, h = height + 10, $fn = 32);
        for (i = [0 : 3]) rotate([0, 0, 45 + 90 * i]) translate([5, -0.75, height - 12]) cube([6, 1.5, 6]);
    }
}
module wall() {
    difference() {
        union() {
            translate([0, -2, 0]) cube([60, 4, 22]);
            for (i = [0 : 9]) translate([7.5 + i * 5, -2, 22]) cube([2.5, 1.5, 3]);
        }
        translate([0, 0, -1]) cylinder(r = 7, h = 40, $fn = 32);
        translate([60, 0, -1]) cylinder(r = 7, h = 40, $fn = 32);
    }
}
module gate() {
    translate([30, 0, 0]) rotate([90, 0, 0]) translate([0, 0, -5]) linear_extrude(height = 10) {
        translate([-5, 0]) square([10, 8]);
        translate([0, 8]) circle(r = 5, $fn = 24);
    }
}
for (i = [0 : 3]) translate([30, 30, 0]) rotate([0, 0, 90 * i]) translate([-30, -30, 0]) {
    tower(i == 2 ? 40 : 30);
    if (i == 0) difference() { wall(); gate(); } else wall();
}
