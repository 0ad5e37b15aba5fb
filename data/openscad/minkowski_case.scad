// SPDX-License-Identifier: CC0-1.0
// Minkowski sums: a case rounded by a sphere, a box bevelled by a cone, plates in the plane.

minkowski() {
  cube([20, 14, 6]);
  sphere(r = 2, $fn = 12);
}
translate([35, 0, 0]) difference() {
  minkowski() {
    rotate([0, 0, 30]) cube([12, 10, 4]);
    cylinder(h = 3, r1 = 2, r2 = 0.5, $fn = 8);
  }
  translate([0, 8, -1]) cylinder(h = 20, r = 2.5, $fn = 10);
}
translate([0, 30, 0]) linear_extrude(height = 3) minkowski() {
  difference() {
    square([20, 16]);
    translate([6, 5]) square([8, 6]);
  }
  circle(r = 1.5, $fn = 16);
}
