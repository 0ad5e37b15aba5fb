// SPDX-License-Identifier: CC0-1.0
// A sandwich panel: two skins and a honeycomb core, of hexagonal prisms taken from a block.
cell = 6;
gap = 1;
difference() {
    cube([80, 60, 10]);
    for (i = [0 : 12], j = [0 : 10])
        translate([i * (cell + gap) * 0.866, (j + (i % 2) / 2) * (cell + gap), 1])
            cylinder(d = cell * 1.1547, h = 8, $fn = 6);
}
