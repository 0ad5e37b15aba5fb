// SPDX-License-Identifier: CC0-1.0
// The shadows of a die seen corner on, and of a tilted drum and its axle, as plates with a hole.

linear_extrude(height = 2) projection() rotate([35, 45, 0]) cube(10, center = true);
translate([30, 0, 0]) linear_extrude(height = 2) difference() {
  projection() {
    rotate([50, 20, 0]) cylinder(h = 8, r = 9, center = true, $fn = 24);
    rotate([50, 20, 0]) cylinder(h = 30, r = 2, center = true, $fn = 12);
  }
  circle(r = 1.5, $fn = 12);
}
