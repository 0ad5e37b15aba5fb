// SPDX-License-Identifier: CC0-1.0
// A roof truss of hulls between joints, with bolts through them.
joints = [[0, 0], [40, 0], [80, 0], [120, 0], [20, 20], [60, 32], [100, 20]];
members = [[0, 1], [1, 2], [2, 3], [0, 4], [4, 5], [5, 6], [6, 3], [4, 1], [1, 5], [5, 2], [2, 6]];
module joint(i, r, h) { translate([joints[i].x, joints[i].y, 0]) cylinder(r = r, h = h, center = true, $fn = 20); }
difference() {
    union() {
        for (m = members) hull() { joint(m[0], 2.5, 4); joint(m[1], 2.5, 4); }
        for (i = [0 : 6]) joint(i, 4, 6);
    }
    for (i = [0 : 6]) joint(i, 1.5, 10);
}
