// SPDX-License-Identifier: CC0-1.0
// What must not change a solid: colour, render, nested groups, a background part.
color("red") render() difference() {
    cube([30, 20, 10]);
    #translate([5, 5, -1]) cube([5, 5, 12]);
    *translate([15, 5, -1]) cube([5, 5, 12]);
}
%translate([0, 0, 20]) sphere(r = 10, $fn = 12);
color([0.2, 0.4, 0.6, 0.5]) group() group() translate([30, 0, 0]) cube([5, 20, 10]);
