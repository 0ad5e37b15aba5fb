// SPDX-License-Identifier: CC0-1.0
// Minkowski sums: a case rounded by a sphere, a frame thickened by a cylinder, plates in the plane.

minkowski() {
  cube([20, 14, 6]);
  sphere(r = 2, $fn = 12);
}
// Not convex: the window shrinks by the cylinder.
translate([35, 0, 0]) minkowski() {
  difference() {
    cube([16, 14, 4]);
    translate([4, 4, -1]) cube([8, 6, 9]);
  }
  cylinder(h = 1, r = 1, $fn = 8);
}
translate([0, 30, 0]) linear_extrude(height = 3) minkowski() {
  difference() {
    square([20, 16]);
    translate([6, 5]) square([8, 6]);
  }
  circle(r = 1.5, $fn = 16);
}
