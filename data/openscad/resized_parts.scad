// SPDX-License-Identifier: CC0-1.0
// Parts brought to given sizes: alone, by their largest side, after a Boolean, in the plane.

resize([20, 12, 8]) sphere(r = 5, $fn = 20);
translate([30, 0, 0]) resize([0, 0, 12], auto = true) difference() {
  cube([10, 6, 4], center = true);
  cylinder(h = 9, r = 2, center = true, $fn = 16);
}
translate([0, 30, 0]) linear_extrude(height = 3) resize([18, 0], auto = [false, true])
  difference() {
    circle(r = 7, $fn = 18);
    translate([2, 0]) square(4);
  }
translate([30, 30, 0]) resize([15, 0, 0]) rotate([0, 30, 0]) cube([4, 5, 6], center = true);
