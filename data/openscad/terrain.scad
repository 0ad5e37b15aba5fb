// SPDX-License-Identifier: CC0-1.0
// A piece of land from a file of heights, cut round, with a tunnel.

difference() {
  intersection() {
    surface(file = "parts/terrain.dat", center = true);
    translate([0, 0, -2]) cylinder(h = 20, r = 4.2, $fn = 20);
  }
  rotate([90, 0, 20]) cylinder(h = 20, r = 0.8, center = true, $fn = 10);
}
