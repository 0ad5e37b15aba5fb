// SPDX-License-Identifier: CC0-1.0
// The shadow of a die and of a tilted frame, as plates.

linear_extrude(height = 2) projection() rotate([35, 45, 0]) cube(10, center = true);
translate([30, 0, 0]) linear_extrude(height = 2) projection() rotate([25, 0, 0]) difference() {
  cube([20, 20, 4], center = true);
  cube([12, 12, 9], center = true);
}
