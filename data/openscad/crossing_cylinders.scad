// SPDX-License-Identifier: CC0-1.0
// Two and three perpendicular cylinders of equal radius, intersected (Steinmetz).
module x() { rotate([0, 90, 0]) cylinder(r = 5, h = 14, center = true, $fn = 32); }
module y() { rotate([90, 0, 0]) cylinder(r = 5, h = 14, center = true, $fn = 32); }
module z() { cylinder(r = 5, h = 14, center = true, $fn = 32); }
intersection() { x(); y(); }
translate([16, 0, 0]) intersection() { x(); y(); z(); }
translate([40, 0, 0]) difference() { union() { x(); y(); z(); } sphere(r = 6, $fn = 24); }
