// SPDX-License-Identifier: CC0-1.0
// An angle bracket with a rib and four bolt holes.
thickness = 4;
width = 40;
leg = 50;

module hole(x, y) { translate([x, y, -1]) cylinder(d = 5.2, h = thickness + 2, $fn = 24); }

module plate() {
    difference() {
        cube([leg, width, thickness]);
        hole(leg - 12, 10);
        hole(leg - 12, width - 10);
    }
}

plate();
translate([thickness, 0, 0]) rotate([0, -90, 0]) plate();
translate([thickness, width / 2 - 2, thickness]) rotate([90, 0, 0]) mirror([0, 0, 1])
    linear_extrude(height = 4) polygon([[0, 0], [24, 0], [0, 24]]);
