// SPDX-License-Identifier: CC0-1.0
// Six expressions of boxes m1, m2, m4 of volumes 1, 2, 4: which boxes survive shows in the volume.
module m1() { cube([1, 1, 1]); }
module m2() { translate([1, 0, 0]) cube([2, 1, 1]); }
module m4() { translate([3, 0, 0]) cube([4, 1, 1]); }
module m3() { m1(); m2(); }
module m7() { m1(); m2(); m4(); }

translate([0, 0, 0]) union() { m1(); m2(); m4(); }                                    // 7
translate([0, 3, 0]) difference() { union() { m1(); m2(); } m4(); }                   // 3
translate([0, 6, 0]) union() { m1(); intersection() { m2(); m4(); } }                 // 1
translate([0, 9, 0]) intersection() { m7(); m3(); m1(); }                             // 1
translate([0, 12, 0]) difference() { m7(); difference() { m7(); m1(); } }             // 1
translate([0, 15, 0]) difference() { m7(); union() { m1(); m2(); } }                  // 4
