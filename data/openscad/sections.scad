// SPDX-License-Identifier: CC0-1.0
// Sections and shadows of solids, extruded beside them.

module part() {
  difference() {
    rotate([20, 35, 10]) cube([10, 14, 18], center = true);
    cylinder(h = 40, r = 3, center = true, $fn = 20);
    translate([0, 0, 1.3]) rotate([90, 0, 0]) cylinder(h = 40, r = 2, center = true, $fn = 12);
  }
}

part();
translate([30, 0, 0]) linear_extrude(height = 2) projection(cut = true) part();
translate([30, 30, 0]) linear_extrude(height = 2) projection(cut = true) translate([0, 0, -4]) part();
// A section through faces that lie in the plane.
translate([0, 30, 0]) linear_extrude(height = 2) projection(cut = true) {
  cube([8, 8, 3]);
  translate([4, 4, -3]) cube([8, 8, 3]);
}
