// SPDX-License-Identifier: CC0-1.0
// A gasket of offsets: round, sharp and chamfered corners, outward and inward, in one another.

module outline() {
  difference() {
    union() {
      square([40, 12]);
      square([12, 30]);
      translate([34, 6]) circle(r = 8, $fn = 12);
    }
    translate([6, 22]) circle(d = 5, $fn = 8);
  }
}

// The wall between the outline and what is left of it.
linear_extrude(height = 3) difference() {
  offset(r = 2, $fn = 12) outline();
  offset(r = -1.5, $fn = 12) outline();
}
// A sharp rim below, a chamfered one above.
translate([0, 0, -2]) linear_extrude(height = 2) difference() {
  offset(delta = 3) outline();
  offset(delta = 1) outline();
}
translate([0, 0, 3]) linear_extrude(height = 1) difference() {
  offset(delta = 2.5, chamfer = true) outline();
  offset(delta = -1, chamfer = true) outline();
}
// Corners rounded from within: shrunk and grown again.
translate([60, 0, 0]) linear_extrude(height = 4)
  offset(r = 3, $fn = 16) offset(delta = -3) polygon([[0, 0], [30, 4], [26, 30], [8, 26], [12, 14]]);
