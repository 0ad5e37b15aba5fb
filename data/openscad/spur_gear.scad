// SPDX-License-Identifier: CC0-1.0
// A spur gear: teeth as polygons united in the plane, then extruded; hub, bore and keyway.
teeth = 18;
modul = 2;
pitch_radius = teeth * modul / 2;
outer = pitch_radius + modul;
root = pitch_radius - 1.25 * modul;

module tooth() {
    w = 360 / teeth / 4;
    polygon([
        [root * cos(-w * 1.5) - 0.5, root * sin(-w * 1.5)],
        [pitch_radius * cos(-w), pitch_radius * sin(-w)],
        [outer * cos(-w * 0.5), outer * sin(-w * 0.5)],
        [outer * cos(w * 0.5), outer * sin(w * 0.5)],
        [pitch_radius * cos(w), pitch_radius * sin(w)],
        [root * cos(w * 1.5) - 0.5, root * sin(w * 1.5)]
    ]);
}

difference() {
    union() {
        linear_extrude(height = 8) {
            circle(r = root, $fn = 72);
            for (i = [0 : teeth - 1]) rotate(i * 360 / teeth) tooth();
        }
        cylinder(r = 8, h = 14, $fn = 36);
    }
    translate([0, 0, -1]) cylinder(d = 6, h = 16, $fn = 24);
    translate([0, -1, -1]) cube([5, 2, 16]);
}
