// SPDX-License-Identifier: CC0-1.0
// A corner bracket imported as OFF, a wedge imported as STL, cut by one another and by a hole.

difference() {
  union() {
    import("parts/corner.off");
    translate([0, 12, 0]) rotate([0, 0, 30]) import("parts/wedge.stl");
  }
  translate([3, 3, -1]) cylinder(h = 20, r = 1.2, $fn = 14);
}
