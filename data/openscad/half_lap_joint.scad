// SPDX-License-Identifier: CC0-1.0
// Two beams joined half and half: their common faces must disappear, their union is one solid.
length = 60;
section = 12;

module beam() {
    difference() {
        cube([length, section, section]);
        translate([length / 2 - section / 2, 0, section / 2]) cube([section, section, section / 2]);
    }
}

beam();
translate([length / 2 - section / 2, -(length - section) / 2, 0])
    translate([section, 0, section]) rotate([0, 0, 90]) mirror([0, 0, 1]) beam();
