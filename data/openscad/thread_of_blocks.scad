// SPDX-License-Identifier: CC0-1.0
// A screw thread of 480 turned blocks round a core: each overlaps its neighbours a little.
turns = 10;
per_turn = 48;
pitch = 3;
cylinder(r = 9, h = pitch * (turns + 1), $fn = 48);
for (i = [0 : turns * per_turn - 1])
    translate([0, 0, pitch / 2 + i * pitch / per_turn])
        rotate([0, 0, i * 360 / per_turn]) translate([9, 0, 0])
            rotate([atan(pitch / (2 * PI * 9)), 0, 0]) cube([3, 1.4, 1.2], center = true);
translate([0, 0, -8]) cylinder(r = 16, h = 8, $fn = 6);
